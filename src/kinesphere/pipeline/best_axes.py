"""Of several recordings of one person: which one knows each axis of each joint best."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import permutations
from typing import NamedTuple

import numpy as np

from kinesphere.data import Joint, Json, Skeleton, Step
from kinesphere.parameterization import AxesSettings
from kinesphere.parameterization.anatomy import wanted_n_axes
from kinesphere.parameterization.joined import counterpart, doubted, joined, told_axes
from kinesphere.parameterization.joint_fit import JointFit
from kinesphere.parameterization.reused import reused_fit
from kinesphere.pipeline.frames_apart import Turn, turn_between

CONTRADICTION = np.deg2rad(10.0)
"""rad, angle between axes of two recordings that is worth telling where both are sure of more."""

DISTAL, PROXIMAL = 0, 1  # of two axes


class Calibrated(NamedTuple):
    """A solved recording whose axes are to be used again."""

    name: str
    skeleton: Skeleton


class _Told(NamedTuple):
    """What one recording, or two together, tell of a joint's axes."""

    fit: JointFit
    base: Calibrated
    """In whose normalized frames the axes are told."""
    again: bool
    """Whether that recording had them from yet another one."""


def with_best_axes(
    skeleton: Skeleton, sources: Sequence[Calibrated], settings: AxesSettings | None = None
) -> tuple[Skeleton, tuple[str, ...]]:
    """Return a skeleton whose joints bear the axes that some other knows best.

    Laboratories record a functional trial for each joint, or for each of its axes. Of all that is
    told of a joint, that serves which tells most of its axes, then what is doubted of fewest, then
    the one with the smallest largest uncertainty; that may be one axis of this recording and one
    of that, turned into the frames of the first by the markers on the parent. What twist that goes
    with a hinge's angle makes unsure does not count: it is the same in every recording, and a long
    movement only shows it. In which order recordings are given does not matter.

    Parameters
    ----------
    skeleton
        Of the motion to be solved.
    sources
        Parameterized skeletons of the same person, each with a name of its own.
    settings
        How close two axes may be.

    Returns
    -------
    skeleton
        Joints that nobody measured have no axes; others say where each is from
        (``axes_reused_from``). The last step of its history says what was found of them there.
    contradictions
        For each joint whose axes recordings put farther apart than they are uncertain, and than
        10°, a clause.
    """
    settings = settings or AxesSettings()
    sources = sorted(sources, key=lambda source: source.name)
    joints, said = [], []
    found: dict[str, Json] = {}
    for joint in skeleton.joints:
        told = [one for source in sources if (one := _told(joint.name, source)) is not None]
        if not told:
            joints.append(joint.without_axes)
            continue
        several = (*told, *_mixed(joint.name, told, settings))
        best = min(several, key=lambda one: _order(one, joint.name))
        joints.append(_bearing(joint, best))
        found[joint.name] = dict(best.fit.findings)
        if clauses := list(_contradictions(joint.name, best, told)):
            said.append(f"{joint.name} ({'; '.join(clauses)})")
    step = Step("parameterization", findings={"joints": found})
    history = (*skeleton.history, step)
    return replace(skeleton, joints=tuple(joints), history=history), tuple(said)


def _told(name: str, source: Calibrated) -> _Told | None:
    """Return what a recording tells of a joint's axes; None if nothing."""
    fit = reused_fit(name, source.skeleton)
    if fit is None:
        return None
    across = fit.assumed or (False,) * len(fit.axes)
    origins = tuple("" if put else source.name for put in across)
    again = source.skeleton.joint(name).axes_source == "reused"
    return _Told(replace(fit, reused_from=origins), source, again)


def _bearing(joint: Joint, best: _Told) -> Joint:
    fit, there = best.fit, best.base.skeleton.joint(joint.name)
    return replace(
        joint,
        axes=fit.axes,
        rest=fit.rest,
        axes_source=there.axes_source,
        axes_assumed=fit.assumed,
        axes_reused_from=fit.reused_from,
        axes_uncertainty=fit.uncertainty,
    )


def _mixed(name: str, told: Sequence[_Told], settings: AxesSettings) -> Iterator[_Told]:
    """Yield joints of two axes whose proximal one is another recording's.

    The distal one belongs to the rest orientation it was seen about, so both are of one recording.
    """
    closest = np.deg2rad(settings.smallest_angle)
    for one, other in permutations(told, 2):
        base, n_axes = one.fit, (len(one.fit.axes), wanted_n_axes(name))
        if n_axes != (2, 2) or DISTAL not in told_axes(base, name):
            continue
        if not np.isfinite(base.uncertainty[DISTAL]):
            continue  # what nobody knows would seem better than what is known
        for given in told_axes(other.fit, name):
            known = np.isfinite(other.fit.uncertainty[given])
            if known and counterpart(other.fit, given, base, name) == PROXIMAL:
                turn = _turn(name, one.base, other.base)
                both = joined(base, other.fit, PROXIMAL, given, closest, *turn)
                if both is not None:
                    yield _Told(both, one.base, one.again or other.again)


def _order(told: _Told, name: str) -> tuple[object, ...]:
    """Return what sorts the best first; names decide between equals."""
    fit = told.fit
    axes = told_axes(fit, name)
    known = np.array(fit.uncertainty)
    other = fit.findings.get("other_reading_deg")
    if isinstance(other, float):  # of a hinge, which is proximal to what was added to it
        known[-1] = np.sqrt(max(known[-1] ** 2 - np.deg2rad(other) ** 2, 0.0))
    known = known[np.isfinite(known)]
    largest, all_of_them = (known.max(), known.sum()) if len(known) else (np.inf, np.inf)
    doubts = sum(bool(doubted(fit, k)) for k in axes)
    origins = fit.reused_from
    mixed = len({origins[k] for k in axes})  # of equals rather one that one recording told
    return -len(axes), doubts, largest, all_of_them, mixed, told.again, told.base.name, origins


def _contradictions(name: str, best: _Told, told: Sequence[_Told]) -> Iterator[str]:
    """Yield how far others put an axis from where it is, where that is more than is uncertain."""
    fit = best.fit
    for k in told_axes(fit, name):
        source = fit.reused_from[k]
        for other in told:
            if other.base.name == source:
                continue
            turn, unsure = _turn(name, best.base, other.base)
            for j in told_axes(other.fit, name):
                if counterpart(other.fit, j, fit, name) != k:
                    continue
                apart = float(np.arccos(min(1.0, abs(fit.axes[k] @ turn @ other.fit.axes[j]))))
                known = np.nan_to_num([fit.uncertainty[k], other.fit.uncertainty[j], unsure])
                if apart > max(CONTRADICTION, float(np.linalg.norm(known))):
                    which = f"axis {k + 1}: " if len(fit.axes) > 1 else ""
                    off = np.rad2deg(apart)
                    yield f"{which}{off:.0f}° between {source}, which serves, and {other.base.name}"


def _turn(name: str, base: Calibrated, other: Calibrated) -> Turn:
    """Return the rotation from the other's frame of a joint's parent into the base's."""
    limbs = (one.skeleton.limb(one.skeleton.joint(name).parent) for one in (base, other))
    return turn_between(*limbs)
