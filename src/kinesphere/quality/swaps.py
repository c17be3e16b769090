"""Labels that change places in the middle of a recording."""

from collections.abc import Iterator

import numpy as np

from kinesphere.data import Array, Recording
from kinesphere.geometry.vectors import lengths
from kinesphere.quality.body import labelled_columns
from kinesphere.quality.findings import Finding

SUDDEN = 3.0
"""Times the calmer of the steps before and after: moving markers change their step by less."""
FAR = 0.01
"""m; markers nearer to each other than this change places within their noise."""
BLOCK = 16384
"""Frames looked at at a time."""
EXCHANGED = 0.5
"""Share of its own step that a marker is off the other's last place, at most."""


def check_swaps(recording: Recording) -> Iterator[Finding]:
    """Find pairs of labels that change places from one frame to the next.

    Either marker appears where the other one was, by a step unlike those around it, as near as
    markers come to their last place in the frames around: two bad samples, one of which ends as
    the other begins, leave both farther off. A change over a gap is not seen.
    """
    labelled = labelled_columns(recording)
    times: dict[tuple[int, int], list[int]] = {}
    for frame, columns in _sudden_steps(recording, labelled):
        there = [labelled[c] for c in columns]
        for a, b in _exchanges(recording.markers[max(frame - 2, 0) : frame + 2, there], frame > 1):
            times.setdefault((columns[a], columns[b]), []).append(frame)
    for (a, b), frames in times.items():
        pair = recording.labels[labelled[a]], recording.labels[labelled[b]]
        first = recording.first_frame + frames[0]
        often = "" if len(frames) == 1 else f" {len(frames)} times, first"
        yield Finding(
            "swap",
            "warning",
            f"{pair[0]} and {pair[1]} change places{often} into frame {first}",
            "exchange the two labels from there on, or label the trial again",
            markers=pair,
            frame=first,
            numbers=(("swaps", len(frames)),),
        )


def _sudden_steps(recording: Recording, labelled: list[int]) -> Iterator[tuple[int, list[int]]]:
    """Return the frames into which two markers or more step suddenly, and which of them do."""
    for start in range(0, recording.n_frames - 1, BLOCK):
        first = max(start - 1, 0)  # blocks overlap: a step is seen with those around it
        points = recording.markers[first : start + BLOCK + 2]
        points = points if labelled == list(range(points.shape[1])) else points[:, labelled]
        steps = lengths(np.diff(points, axis=0))
        around = np.pad(steps, ((1, 1), (0, 0)), constant_values=np.nan)
        sudden = (steps > FAR) & (steps > SUDDEN * np.fmin(around[:-2], around[2:]))
        for step in np.flatnonzero(sudden.sum(axis=1) > 1):
            if start <= first + step < start + BLOCK:
                yield int(first + step) + 1, np.flatnonzero(sudden[step]).tolist()


def _exchanges(points: Array, second: bool) -> list[tuple[int, int]]:
    """Return the pairs of markers of which either is where the other was.

    Parameters
    ----------
    points : (n_frames, k, 3)
        m, from the frame before the step (with the one before that, if there is) to the frame
        after it.
    second
        Whether the step is the second one of them, not the first.
    """
    steps = lengths(np.diff(points, axis=0))
    at = int(second)
    unknown = np.full(points.shape[1], np.nan)
    earlier = steps[0] if second else unknown
    later = steps[at + 1] if at + 1 < len(steps) else unknown
    # [a, b]: of the body that is called b before and a after
    usual = np.fmax(earlier[None], later[:, None])
    off = lengths(points[at + 1][:, None] - points[at][None])
    there = (off < EXCHANGED * off.diagonal()[:, None]) & (off <= np.fmax(FAR, SUDDEN * usual))
    return [(int(a), int(b)) for a, b in np.argwhere(there & there.T) if a < b]
