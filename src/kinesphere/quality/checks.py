"""What is wrong with a recording, before anything is done with it."""

from collections.abc import Callable, Iterable, Iterator

import numpy as np

from kinesphere.data import Recording
from kinesphere.geometry.vectors import lengths
from kinesphere.quality.at_zero import check_at_zero, without_zeros
from kinesphere.quality.body import (
    ENOUGH_FRAMES,
    HEAD,
    HEELS,
    SHOULDERS,
    TOES,
    Body,
    find_bodies,
    labelled_columns,
    thinned,
)
from kinesphere.quality.findings import Finding
from kinesphere.quality.marker_checks import (
    check_coincident,
    check_constant,
    check_far,
    check_gaps,
    check_jumps,
    check_never_seen,
)
from kinesphere.quality.sides import check_sides
from kinesphere.quality.swaps import check_swaps

BODY_HEIGHT = (0.3, 2.5)
"""m between feet and head (or shoulders), from a crouching child to a giant on tiptoe."""
SCENE = (0.01, 50.0)
"""m across all markers of a frame, from a finger to a hall."""


def check_recording(recording: Recording) -> tuple[Finding, ...]:
    """Return everything that looks wrong, worst first; empty where nothing does.

    Positions are taken to be in metres. Unlabelled points come and go by nature: looked at are
    their zeros and, where nothing is labelled, gaps of those that live long. Frames are named in
    the file's own count.
    """
    if recording.n_frames == 0 or recording.n_markers == 0:
        kind = "frames" if recording.n_frames == 0 else "markers"
        return (
            Finding("empty", "error", f"the recording has no {kind}", "export it again with data"),
        )
    if not recording.seen.any():
        return (
            Finding(
                "nothing-seen",
                "error",
                f"no marker is seen in any of the {recording.n_frames} frames",
                "reconstruct the trial again, or export another one",
            ),
        )
    apart = without_zeros(recording)  # what a zero looks like besides is not told again
    rules: Iterable[tuple[Callable[[Recording], Iterator[Finding]], Recording]] = (
        (_one_frame, recording),
        (_unit, recording),
        (check_far, recording),
        (check_never_seen, recording),
        (check_at_zero, recording),
        (check_constant, recording),
        (check_coincident, apart),
        (check_jumps, apart),
        (check_swaps, apart),
        (check_sides, apart),
        (_empty_frames, recording),
        (check_gaps, recording),
    )
    found = [finding for rule, judged in rules for finding in rule(judged)]
    order = ("error", "warning", "note")
    return tuple(sorted(found, key=lambda finding: order.index(finding.severity)))


def _one_frame(recording: Recording) -> Iterator[Finding]:
    if recording.n_frames == 1:
        yield Finding(
            "one-frame",
            "warning",
            "the recording has a single frame: nothing moves in it",
            "a skeleton can only be measured from a recording with motion",
            frame=recording.first_frame,
        )


def _unit(recording: Recording) -> Iterator[Finding]:
    recording = thinned(recording, ENOUGH_FRAMES)
    heights = [h for body in find_bodies(recording) if np.isfinite(h := _height(body))]
    low, high = BODY_HEIGHT
    for height in heights:
        if not low <= height <= high:
            yield Finding(
                "unit",
                "warning",
                f"feet and head are {height:.3g} m apart, a person's are {low} to {high} m",
                "check the length unit of the file",
                numbers=(("height_m", round(height, 6)),),
            )
    if heights:
        return
    # marker by marker in memory: extremes of rows come in a tenth of the time
    points = np.moveaxis(recording.markers[recording.seen.any(axis=1)], 1, 0).copy()
    extent = np.fmax.reduce(points) - np.fmin.reduce(points)
    across = float(np.linalg.norm(np.median(extent, axis=0)))
    low, high = SCENE
    if recording.n_markers > 1 and not low <= across <= high:
        yield Finding(
            "unit",
            "warning",
            f"the markers of a frame are {across:.3g} m across, {low} to {high} m is likely",
            "check the length unit of the file",
            numbers=(("across_m", round(across, 6)),),
        )


def _height(body: Body) -> float:
    """Return the median distance between feet and head, in m; NaN where either is missing."""
    head, shoulders, feet = body.middle(*HEAD), body.middle(*SHOULDERS), body.middle(*TOES, *HEELS)
    upper = shoulders if head is None else head
    if upper is None or feet is None:
        return float("nan")
    found = lengths(upper - feet)
    found = found[np.isfinite(found)]
    return float(np.median(found)) if len(found) else np.nan


def _empty_frames(recording: Recording) -> Iterator[Finding]:
    labelled = labelled_columns(recording)
    seen = recording.seen[:, labelled] if labelled else recording.seen
    nobody, who = ~seen.any(axis=1), "labelled marker" if labelled else "marker"
    if nobody.any():
        frame = recording.first_frame + int(nobody.argmax())
        yield Finding(
            "empty-frames",
            "note",
            f"no {who} is seen in {nobody.mean():.1%} of the frames, first in {frame}",
            "cut the recording to where the person is in view",
            frame=frame,
            numbers=(("empty_share", round(float(nobody.mean()), 4)),),
        )
