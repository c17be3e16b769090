"""What is wrong with single markers: never seen, stuck, copied, jumping, missing."""

from collections.abc import Iterator

import numpy as np

from kinesphere.data import Array, Recording
from kinesphere.geometry.even_frames import even_frames
from kinesphere.geometry.vectors import is_seen, lengths
from kinesphere.quality.body import judged_columns, labelled_columns, lasting_columns, thinned
from kinesphere.quality.extent import usual_extent
from kinesphere.quality.findings import Finding
from kinesphere.quality.gaps import runs

LONG_GAP = 0.5
"""s; up to here a gap can be interpolated between its ends without much harm."""
MUCH_MISSING, HALF_MISSING = 0.05, 0.5
"""Shares of frames without a marker from which on that is worth a note and a warning."""
FASTEST = 20.0
"""m/s; a boxer's fist reaches 10 to 15, a thrower's hand 20."""
LONGEST_STEP = 1.0
"""s; over a longer gap a mean speed says nothing."""
SAME_PLACE = 1e-3
"""m, of people; two markers are 9 mm and more across."""
ALIKE = 0.005
"""The same as a share of the markers' extent, of what is smaller than a person."""
FARTHEST = 1e5
"""m; what lies farther out was never measured: 32-bit floats tell it to 8 mm at best."""
COINCIDENT = "coincident"
JUMP = "jump"
TOGETHER = 0.9
"""Share of the frames of the one seen less that show both, of a copy that nobody labelled."""
STILL = 1e-6
"""m; a real marker jitters by a hundred times as much."""
SAMPLED_FRAMES = 300
"""Frames, evenly spread, that a comparison of all pairs looks at."""


def check_never_seen(recording: Recording) -> Iterator[Finding]:
    """Find labels without a single position."""
    never = [c for c in labelled_columns(recording) if not recording.seen[:, c].any()]
    if never:
        labels = tuple(recording.labels[c] for c in never)
        yield Finding(
            "never-seen",
            "warning",
            f"never seen: {', '.join(labels)}",
            "label the trial again, or leave these markers out of the model",
            markers=labels,
        )


def check_far(recording: Recording) -> Iterator[Finding]:
    """Find positions that no camera ever saw."""
    markers = recording.markers
    farthest = np.fmax(np.fmax.reduce(markers), -np.fmin.reduce(markers)).max(axis=1)
    for c in np.flatnonzero(farthest > FARTHEST):
        frame = int((np.abs(markers[:, c]) > FARTHEST).any(axis=1).argmax())
        yield Finding(
            "far",
            "error",
            f"{recording.labels[c]} is {farthest[c]:.3g} m away in frame "
            f"{recording.first_frame + frame}: no position",
            "take such positions out, or check the length unit of the file",
            markers=(recording.labels[c],),
            frame=recording.first_frame + frame,
        )


def check_constant(recording: Recording) -> Iterator[Finding]:
    """Find markers that stand still for all their life while others move."""
    often = recording.seen.sum(axis=0) >= max(2.0, recording.rate)  # a second of it
    enough = [c for c in labelled_columns(recording) if often[c]]
    few = thinned(recording, SAMPLED_FRAMES)  # who moves in these is asked no more
    still = [c for c in enough if _stands(few.markers[:, c]) and _stands(recording.markers[:, c])]
    if len(still) == len(enough):
        return  # a statue: nothing to compare with
    # at zero a marker is missing, and told so
    still = [c for c in still if recording.markers[recording.seen[:, c], c].any()]
    if still:
        labels = tuple(recording.labels[c] for c in still)
        first = min(int(recording.seen[:, c].argmax()) for c in still)
        yield Finding(
            "constant",
            "warning",
            f"{', '.join(labels)} never move{'s' * (len(still) == 1)} while others do",
            "label the trial again, or leave out what does not belong to the person",
            markers=labels,
            frame=recording.first_frame + first,
        )


def _stands(points: Array) -> bool:
    """Return whether a marker stays where it is wherever it is seen, (n_frames, 3) m."""
    points = points[is_seen(points)]
    return len(points) == 0 or bool((np.ptp(points, axis=0) < STILL).all())


def check_coincident(recording: Recording) -> Iterator[Finding]:
    """Find pairs that share one place in half the frames that have both.

    Of two that nobody labelled, or one, only if they live long and side by side: else they are
    pieces of one marker, and neither is a copy.
    """
    seen, labelled = recording.seen, set(labelled_columns(recording))
    columns = sorted(labelled | set(lasting_columns(recording)))
    near = min(SAME_PLACE, ALIKE * usual_extent(recording.markers))
    frames = even_frames(recording.n_frames, SAMPLED_FRAMES)
    points = recording.markers[frames][:, columns]
    often = seen[frames][:, columns].sum(axis=0)
    for i, column in enumerate(columns[:-1]):
        distances = lengths(points[:, i + 1 :] - points[:, i : i + 1])
        together = np.isfinite(distances).sum(axis=0)
        same = (distances <= near).sum(axis=0)  # NaN compares as False
        side_by_side = together >= TOGETHER * np.minimum(often[i], often[i + 1 :])
        if column in labelled:
            side_by_side |= [other in labelled for other in columns[i + 1 :]]
        for j in np.flatnonzero((same > 0) & (2 * same >= together) & side_by_side):
            pair = (recording.labels[column], recording.labels[columns[i + 1 + j]])
            frame = recording.first_frame + int(frames[(distances[:, j] <= near).argmax()])
            yield Finding(
                COINCIDENT,
                "warning",
                f"{pair[0]} and {pair[1]} are at the same place from frame {frame} on",
                "one of them is a copy: leave it out",
                markers=pair,
                frame=frame,
            )


def check_jumps(recording: Recording) -> Iterator[Finding]:
    """Find steps from one sighting to the next that no body makes."""
    for c in labelled_columns(recording):
        at = np.flatnonzero(recording.seen[:, c])
        if len(at) < 2:
            continue
        lasts = np.diff(at) / recording.rate
        points = np.ascontiguousarray(recording.markers[:, c])
        steps = lengths(np.diff(points if len(at) == len(points) else points[at], axis=0))
        speeds: Array = np.where(lasts <= LONGEST_STEP, steps / lasts, 0.0)
        fast = np.flatnonzero(speeds > FASTEST)
        if len(fast) == 0:
            continue
        worst = int(speeds.argmax())
        first = recording.first_frame + int(at[fast[0] + 1])
        label = recording.labels[c]
        yield Finding(
            JUMP,
            "warning",
            f"{label} jumps {_times(len(fast))}, first into frame {first}; the fastest by "
            f"{steps[worst] * 1e3:.0f} mm into frame {recording.first_frame + int(at[worst + 1])} "
            f"({speeds[worst]:.0f} m/s)",
            "look for a swap with another marker, or a ghost, around these frames",
            markers=(label,),
            frame=first,
            numbers=(("jumps", len(fast)), ("fastest_m_per_s", round(float(speeds[worst]), 1))),
        )


def check_gaps(recording: Recording) -> Iterator[Finding]:
    """Find markers that are missing often or for long, while others are seen."""
    judged = judged_columns(recording)
    seen = recording.seen[:, judged]
    missing = ~seen & seen.any(axis=1, keepdims=True)  # frames without anybody are told once
    if not missing.any():
        return
    columns, starts, stops = runs(missing)
    shares = missing.mean(axis=0)
    for i in np.flatnonzero(shares):
        if not seen[:, i].any():
            continue  # told as never seen
        start, stop = starts[columns == i], stops[columns == i]
        at = int((stop - start).argmax())
        share, seconds = float(shares[i]), float((stop - start)[at] / recording.rate)
        if share < MUCH_MISSING and seconds <= LONG_GAP:
            continue
        label, frame = recording.labels[judged[i]], recording.first_frame + int(start[at])
        yield Finding(
            "gap",
            "warning" if share >= HALF_MISSING else "note",
            f"{label} is missing in {share:.1%} of the frames, longest from frame {frame} on for "
            f"{seconds:.2f} s",
            "fill it where the trial is reconstructed; meanwhile the limb's other markers must do",
            markers=(label,),
            frame=frame,
            numbers=(("missing_share", round(share, 4)), ("longest_s", round(seconds, 4))),
        )


def _times(n: int) -> str:
    return "once" if n == 1 else f"{n} times"
