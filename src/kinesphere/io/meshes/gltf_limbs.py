"""Which of our limbs each joint of somebody's rig moves."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.data.figure import SIDES, find_figure
from kinesphere.data.skeleton import Skeleton
from kinesphere.errors import BadModel

_LIMBS = ("upper_arm", "forearm", "hand", "thigh", "shank", "foot")
_ABOVE = {"forearm": "upper_arm", "hand": "forearm", "shank": "thigh", "foot": "shank"}


class RigLimbs(NamedTuple):
    """Our limbs in a rig."""

    names: tuple[str, ...]
    """Parents first."""
    parents: NDArray[np.intp]
    begins: NDArray[np.intp]
    """(n_limbs,) the joint each begins at."""
    of_joint: NDArray[np.intp]
    """(n_joints,) which limb each joint moves."""
    source: str
    """What told the limbs: names, or the shape of the tree."""


def limbs_of_rig(skeleton: Skeleton) -> RigLimbs | None:
    """Return our limbs in a rig; None where arms and legs cannot be told.

    A joint that is no limb of ours moves what carries it: fingers the hand, toes the foot, collar
    bones the trunk. What lies between trunk and head belongs to the head.
    """
    try:
        figure = find_figure(skeleton)
    except BadModel:
        return None
    parts = figure.parts
    needed = [f"{side}_{limb}" for side in SIDES for limb in _LIMBS if limb not in ("hand", "foot")]
    if any(name not in parts for name in needed):
        return None
    begins = {"pelvis": figure.pelvis}
    if figure.spine:
        begins["trunk"] = figure.spine[0]
    if "head" in parts:
        begins["head"] = (*figure.neck, parts["head"])[0]
    begins |= {
        f"{side}_{limb}": parts[f"{side}_{limb}"]
        for side in SIDES
        for limb in _LIMBS
        if f"{side}_{limb}" in parts
    }
    names = tuple(begins)
    at = {joint: limb for limb, joint in enumerate(begins.values())}
    at |= dict.fromkeys((j for j in figure.spine if j not in at), names.index(_chest(names)))
    of_joint = np.zeros(len(skeleton.limbs), dtype=np.intp)
    for joint, parent in enumerate(skeleton.parents):
        if joint in at:
            of_joint[joint] = at[joint]
        elif parent >= 0:
            of_joint[joint] = of_joint[parent]
    above = [_carrier(name, names) for name in names]
    return RigLimbs(
        names, np.array(above), np.array(list(begins.values())), of_joint, figure.source
    )


def _carrier(name: str, names: tuple[str, ...]) -> int:
    side, _, limb = name.partition("_")
    if name == "pelvis":
        return -1
    if limb in _ABOVE:
        return names.index(f"{side}_{_ABOVE[limb]}")
    return 0 if name == "trunk" or limb == "thigh" else names.index(_chest(names))


def _chest(names: tuple[str, ...]) -> str:
    return "trunk" if "trunk" in names else "pelvis"
