"""What may spoil a solution before a stage can notice: said as a step of the history."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from kinesphere import __version__
from kinesphere.data import Json, Motion, Recording, Skeleton, Step
from kinesphere.errors import BadRecording, KinesphereError
from kinesphere.pipeline.best_axes import Calibrated
from kinesphere.quality import Finding, check_at_size, check_at_zero, gathered
from kinesphere.skeleton.landmarks import BETWEEN, STEADY

IMPOSSIBLE = (0.1, 10.0)
"""m from feet to head: beyond, the unit is wrong and nothing else can be right."""
OTHER_PERSON = 0.05
"""Share by which limb lengths of one person differ between solutions, at most: 0.033 over nine
trials of one person, 0.049 between a still and a moving one; 0.032 and more between people."""
ENOUGH = 3
"""Limbs, of as many as both solutions have, whose length is measured: fewer do not tell people
apart."""


def with_checks(recording: Recording, unit: float | None = None) -> Recording:
    """Return the recording with what looks wrong in it among its warnings; gaps are no news.

    Parameters
    ----------
    recording
    unit
        How many times too large its lengths are, if known: jumps and copies are judged, and told,
        at the subject's true size.

    Raises
    ------
    BadRecording
        If the body has a size no body has, or a marker a place no marker has.
    """
    found = [f for f in check_at_size(recording, unit or 1.0) if f.severity != "note"]
    low, high = IMPOSSIBLE
    for finding in found:
        height = dict(finding.numbers).get("height_m", low)
        if finding.severity == "error" or not low <= height <= high:
            raise BadRecording(f"{finding.what}: {finding.remedy}")
    if not found:
        return recording
    step = Step(
        "checks",
        findings={"found": [f.as_json() for f in found], "missing": _missing(found)},
        warnings=tuple(f"{f.what}: {f.remedy}" for f in gathered(found)),
        version=__version__,
    )
    return replace(recording, history=(*recording.history, step))


def why_it_fails(recording: Recording, failed: KinesphereError) -> KinesphereError:
    """Return an error that names zeros first, where the recording has them; else the same one."""
    zeros = gathered(tuple(check_at_zero(recording)))
    if not zeros:
        return failed
    told = f"{zeros[0].what}: {zeros[0].remedy}; as it is, {failed}"
    return type(failed)(told)


def _missing(found: Sequence[Finding]) -> dict[str, Json]:
    """Return marker → how much of it is missing, for a table."""
    return {
        f.markers[0]: {**dict(f.numbers), "longest_from_frame": f.frame}
        for f in found
        if f.rule == "gap"
    }


def calibration_doubts(
    motion: Motion, calibration: tuple[float, float] | None, reused: Sequence[Calibrated]
) -> tuple[str, ...]:
    """Return what speaks against a calibration window, or against solutions to be reused."""
    doubts = []
    length = motion.n_frames / motion.rate
    if calibration is not None and (calibration[0] < 0 or calibration[1] > length):
        start, end = calibration
        doubts.append(
            f"the calibration window {start:g}:{end:g} s reaches beyond the recording, "
            f"which lasts {length:.2f} s; what there is of it was used"
        )
    for name, other in sorted(reused, key=lambda one: one.name):
        off = lengths_apart(motion.skeleton, other)
        if off is not None and off > OTHER_PERSON:
            which = f" ({name})" if len(reused) > 1 else ""
            doubts.append(
                f"limbs differ by {off:.0%} (median) from those of the solution to be reused"
                f"{which}: axes and rest positions hold for one person only"
            )
    return tuple(doubts)


def lengths_apart(skeleton: Skeleton, other: Skeleton) -> float | None:
    """Return the share by which limb lengths of two skeletons differ, the median.

    Limbs with an end that neither motion nor a landmark tells, in either, are left out: such a
    centre is put between the markers, from trial to trial elsewhere. None where too few are left.
    """
    unknown = _of_unknown_length(skeleton) | _of_unknown_length(other)
    lengths = {limb.name: limb.length for limb in other.limbs if limb.length > 0}
    ratios = {
        limb.name: limb.length / lengths[limb.name]
        for limb in skeleton.limbs
        if limb.length > 0 and limb.name in lengths
    }
    told = [ratio for name, ratio in ratios.items() if name not in unknown]
    if not told or len(told) < min(ENOUGH, len(ratios)):
        return None
    return float(np.median(np.abs(np.array(told) - 1)))


def _of_unknown_length(skeleton: Skeleton) -> set[str]:
    """Return the limbs at a joint whose centre is put between markers for want of anything else."""
    guessed = [
        joint
        for joint in skeleton.joints
        if joint.observability in ("undetermined", "hinge")
        and any(place in joint.note for place in (BETWEEN, STEADY))
    ]
    return {limb for joint in guessed for limb in (joint.parent, joint.child)}
