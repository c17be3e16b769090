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

    Either marker appears where the other one was, by a step unlike those around it. A change over
    a gap is not seen.
    """
    labelled = labelled_columns(recording)
    times: dict[tuple[int, int], list[int]] = {}
    for frame, columns in _sudden_steps(recording, labelled):
        there = [labelled[c] for c in columns]
        for a, b in _exchanges(
            recording.markers[frame - 1, there], recording.markers[frame, there]
        ):
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


def _exchanges(before: Array, after: Array) -> list[tuple[int, int]]:
    """Return the pairs of markers, (k, 3) m each, of which either is where the other was."""
    off = lengths(after[:, None] - before[None])
    there = off < EXCHANGED * off.diagonal()[:, None]
    return [(int(a), int(b)) for a, b in np.argwhere(there & there.T) if a < b]
