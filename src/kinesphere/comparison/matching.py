"""The same limbs and joints called alike: files name a joint as its child limb, or in other words.

BVH has one name for a joint and the limb below it, and every program its own for the limbs.
"""

from collections.abc import Mapping
from dataclasses import replace

from kinesphere.comparison.sides import Side
from kinesphere.data import Skeleton
from kinesphere.data.figure import find_figure
from kinesphere.errors import BadModel


def called_alike(first: Side, second: Side) -> tuple[Side, Side]:
    """Return two sides whose limbs and joints have the same names where they are the same.

    Limbs are the same by their names or, of a human figure, by what names of other programs mean;
    joints by their names or by their child limbs. The side whose joints are called as their limbs
    takes the other's names; if both are or neither is, the second takes the first's.
    """
    if _as_limbs(first.skeleton) and not _as_limbs(second.skeleton):
        second, first = called_alike(second, first)
        return first, second
    limbs = _limbs_alike(first.skeleton, second.skeleton)
    renamed = _renamed(second, limbs, {})
    joints = _joints_alike(first.skeleton, renamed.skeleton)
    return first, _renamed(renamed, {}, joints)


def _as_limbs(skeleton: Skeleton) -> bool:
    return all(joint.name == joint.child for joint in skeleton.joints)


def _limbs_alike(ours: Skeleton, theirs: Skeleton) -> dict[str, str]:
    """Return their name → ours for limbs that are one part of a figure, as far as names tell."""
    parts = []
    for skeleton in (ours, theirs):
        try:
            figure = find_figure(skeleton)
        except BadModel:
            return {}
        if figure.source != "names":
            return {}
        limbs = {**figure.parts, "chest": figure.chest, "pelvis": figure.pelvis}
        parts.append({part: skeleton.limb_names[i] for part, i in limbs.items()})
    found: dict[str, str] = {}
    for part, theirs_name in parts[1].items():
        name = parts[0].get(part)
        # a name that both sides have means the same on both
        if name is None or name in theirs.limb_names or theirs_name in ours.limb_names:
            continue
        if theirs_name not in found and name not in found.values():
            found[theirs_name] = name
    return found


def _joints_alike(ours: Skeleton, theirs: Skeleton) -> dict[str, str]:
    """Return their name → ours for joints of one child limb that share no name."""
    taken = {*theirs.joint_names}
    by_child = {joint.child: joint.name for joint in ours.joints}
    return {
        joint.name: name
        for joint in theirs.joints
        if joint.name not in ours.joint_names
        and (name := by_child.get(joint.child)) is not None
        and name not in taken
    }


def _renamed(side: Side, limbs: Mapping[str, str], joints: Mapping[str, str]) -> Side:
    if not limbs and not joints:
        return side
    parameters = side.parameters
    if parameters is not None:
        parameters = replace(parameters, skeleton=_called(parameters.skeleton, limbs, joints))
    motion = replace(side.motion, skeleton=_called(side.motion.skeleton, limbs, joints))
    return replace(
        side,
        motion=motion,
        skeleton=_called(side.skeleton, limbs, joints),
        parameters=parameters,
    )


def _called(skeleton: Skeleton, limbs: Mapping[str, str], joints: Mapping[str, str]) -> Skeleton:
    def of(name: str) -> str:
        return limbs.get(name, name)

    return replace(
        skeleton,
        limbs=tuple(
            replace(one, name=of(one.name), parent=None if one.parent is None else of(one.parent))
            for one in skeleton.limbs
        ),
        joints=tuple(
            replace(
                one,
                name=joints.get(one.name, one.name),
                parent=of(one.parent),
                child=of(one.child),
            )
            for one in skeleton.joints
        ),
    )
