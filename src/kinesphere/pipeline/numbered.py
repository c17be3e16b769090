"""Limbs and joints without names in two recordings of one person: the same by their markers."""

import re
from collections.abc import Mapping
from dataclasses import replace

from kinesphere.data import Joint, Json, Limb, Skeleton, Step
from kinesphere.parameterization.reused import reused_fit
from kinesphere.pipeline.best_axes import Calibrated
from kinesphere.pipeline.frames_apart import turn_between

_NUMBERED = re.compile(r"(limb|joint)_\d+")


def as_numbered_in(
    skeleton: Skeleton, source: Calibrated
) -> tuple[Calibrated, dict[str, str], dict[str, str]]:
    """Return a solved recording whose numbered limbs and joints are called as in a skeleton.

    Numbers come from the order in which one recording's bodies were found and say nothing in
    another. Limbs are the same where most of the markers of each are on the other, joints where
    they join the same limbs; those that are nowhere here are called so that nothing takes them for
    its own. What bears a name of the conventions or of a model keeps it.

    Parameters
    ----------
    skeleton
        Of the motion to be solved.
    source
        Another recording of the same person.

    Returns
    -------
    source
    matched
        Numbered joint here → which one it is there.
    unmatched
        Numbered joint there whose axes are measured → why none here takes them, a clause.
    """
    theirs = source.skeleton
    if not any(map(_numbered, (*theirs.limb_names, *theirs.joint_names))):
        return source, {}, {}
    limbs = {limb.name: _same(limb, skeleton) for limb in theirs.limbs}
    here = {(joint.parent, joint.child): joint.name for joint in skeleton.joints}
    joints, matched, unmatched = {}, {}, {}
    for joint in theirs.joints:
        joints[joint.name] = joint.name
        if not _numbered(joint.name):
            continue
        ends = limbs[joint.parent], limbs[joint.child]
        same = here.get(ends) if None not in ends else None  # type: ignore[arg-type]
        why = _why(joint, limbs, same) or _frames_open(skeleton, theirs, joint, limbs)
        if same is not None and not why:
            joints[joint.name], matched[same] = same, joint.name
            continue
        joints[joint.name] = _foreign(joint.name, source.name)
        if reused_fit(joint.name, theirs) is not None:
            unmatched[joint.name] = why
    called = {
        name: (same or _foreign(name, source.name)) if _numbered(name) else name
        for name, same in limbs.items()
    }
    return Calibrated(source.name, _renamed(theirs, called, joints)), matched, unmatched


def _numbered(name: str) -> bool:
    return _NUMBERED.fullmatch(name) is not None


def _foreign(name: str, source: str) -> str:
    return f"{name} of {source}"


def _same(limb: Limb, skeleton: Skeleton) -> str | None:
    """Return which limb of a skeleton is this one; None if none, or none that is numbered too."""
    if not _numbered(limb.name):
        return limb.name if limb.name in skeleton.limb_names else None
    mine = _told_apart(limb)
    for other in filter(lambda one: _numbered(one.name), skeleton.limbs):
        its = _told_apart(other)
        if 2 * len(mine & its) > max(len(mine), len(its)):
            return other.name
    return None


def _told_apart(limb: Limb) -> frozenset[str]:
    """Return a limb's markers that somebody named; ``*12`` is another one in each recording."""
    return frozenset(m for m in limb.markers if not m.rpartition(":")[2].startswith("*"))


def _why(joint: Joint, limbs: Mapping[str, str | None], same: str | None) -> str:
    """Return why a joint is none of those here, a clause; empty where it is ``same``."""
    if same is not None:
        return "" if _numbered(same) else f"called {same} here"
    ends = joint.parent, joint.child
    alone = [name for name in ends if limbs[name] is None]
    if alone:
        return f"no limb here shares most of its markers with {' or '.join(alone)}"
    return f"nothing joins {limbs[joint.parent]} to {limbs[joint.child]} here"


def _frames_open(
    skeleton: Skeleton, theirs: Skeleton, joint: Joint, limbs: Mapping[str, str | None]
) -> str:
    """Return why the markers do not tell how frames of a joint's numbered limbs lie, a clause.

    Limbs with a name stand alike in two default positions; for others nothing says so.
    """
    for name in filter(_numbered, (joint.parent, joint.child)):
        turn = turn_between(skeleton.limb(str(limbs[name])), theirs.limb(name))
        if turn.why_named:
            return f"nothing tells how the frame of {name} lies here: {turn.why_named}"
    return ""


def _renamed(skeleton: Skeleton, limbs: Mapping[str, str], joints: Mapping[str, str]) -> Skeleton:
    return Skeleton(
        tuple(
            replace(limb, name=limbs[limb.name], parent=limb.parent and limbs[limb.parent])
            for limb in skeleton.limbs
        ),
        tuple(
            replace(
                joint,
                name=joints[joint.name],
                parent=limbs[joint.parent],
                child=limbs[joint.child],
            )
            for joint in skeleton.joints
        ),
        tuple(_renamed_step(step, joints) for step in skeleton.history),
    )


def _renamed_step(step: Step, joints: Mapping[str, str]) -> Step:
    found = step.findings.get("joints")
    if step.name != "parameterization" or not isinstance(found, Mapping):
        return step
    renamed: dict[str, Json] = {joints.get(name, name): told for name, told in found.items()}
    return replace(step, findings={**step.findings, "joints": renamed})
