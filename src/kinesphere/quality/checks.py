"""What is wrong with a recording, before anything is done with it."""

from collections.abc import Callable, Iterable, Iterator

from kinesphere.data import Recording
from kinesphere.quality.at_zero import check_at_zero, without_zeros
from kinesphere.quality.body import labelled_columns
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
from kinesphere.quality.unit import check_unit, sized

OF_THE_FILE = ("unit", "far")
"""Rules about the lengths as they were read, even where these are known to be wrong."""


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
        (check_unit, recording),
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


def check_at_size(recording: Recording, times: float) -> tuple[Finding, ...]:
    """Return `check_recording` of lengths that are known to be ``times`` too large.

    Jumps, copies and exchanges are judged, and told, at the subject's true size; what is told of
    the unit itself and of places is as it was read.
    """
    found = check_recording(recording)
    if times == 1:
        return found
    true = check_recording(sized(recording, times))
    return (
        *(f for f in found if f.rule in OF_THE_FILE),
        *(f for f in true if f.rule not in OF_THE_FILE),
    )


def _one_frame(recording: Recording) -> Iterator[Finding]:
    if recording.n_frames == 1:
        yield Finding(
            "one-frame",
            "warning",
            "the recording has a single frame: nothing moves in it",
            "a skeleton can only be measured from a recording with motion",
            frame=recording.first_frame,
        )


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
