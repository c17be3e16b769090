"""Skeletons to retarget onto: the recorded one changed, and rigs of animators."""

from collections.abc import Iterator

import numpy as np

from kinesphere.data import Array, Skeleton
from kinesphere.editing import scaled_skeleton
from kinesphere.io.bones import Bone, skeleton_of_bones
from kinesphere.io.bvh import BVH_FROM_BODY

OTHER_PROPORTIONS = {
    "thigh": 0.85,
    "shank": 1.1,
    "foot": 0.8,
    "pelvis": 1.3,
    "upper_arm": 1.15,
    "forearm": 0.9,
}
"""Limb → factor; no two neighbours alike."""


def changed(skeleton: Skeleton) -> Iterator[tuple[str, Skeleton]]:
    """Yield name and skeleton: the recorded one with other limb lengths."""
    yield "20 % shorter", scaled_skeleton(skeleton, 0.8)
    yield "20 % taller", scaled_skeleton(skeleton, 1.2)
    own = {
        name: OTHER_PROPORTIONS[part]
        for name in skeleton.limb_names
        if (part := name.removeprefix("left_").removeprefix("right_")) in OTHER_PROPORTIONS
    }
    yield "other proportions", scaled_skeleton(skeleton, 1.0, own)


def character(arms: str = "t", legs: float = 1.0, hips: float = 1.0) -> Skeleton:
    """Return a character's rig named as Mixamo names its own, 65 % of it legs if they are long.

    Parameters
    ----------
    arms
        ``"t"`` straight out, ``"a"`` 45° down.
    legs, hips
        Factors of the legs' length and of the hips' breadth.
    """
    down = {"t": 0.0, "a": np.pi / 4}[arms]

    def arm(side: float, length: float) -> Array:
        return length * np.array([side * np.cos(down), -np.sin(down), 0.0])

    bones: list[Bone] = []

    def add(name: str, parent: str | None, offset: object, end: object = None) -> None:
        at = [bone.name for bone in bones].index(f"mixamorig:{parent}") if parent else -1
        tip = None if end is None else np.asarray(end, dtype=np.float64)
        bones.append(Bone(f"mixamorig:{name}", at, np.asarray(offset, dtype=np.float64), tip))

    add("Hips", None, (0, 100 * legs, 0))
    add("Spine", "Hips", (0, 10, -1))
    add("Spine1", "Spine", (0, 12, -1))
    add("Spine2", "Spine1", (0, 13, 0))
    add("Neck", "Spine2", (0, 15, 1))
    add("Head", "Neck", (0, 9, 2), (0, 19, 3))
    for side, name in ((1.0, "Left"), (-1.0, "Right")):
        add(f"{name}Shoulder", "Spine2", (6 * side, 11, 0))
        add(f"{name}Arm", f"{name}Shoulder", (12 * side, 0, -1))
        add(f"{name}ForeArm", f"{name}Arm", arm(side, 27.0))
        add(f"{name}Hand", f"{name}ForeArm", arm(side, 26.0))
        add(f"{name}HandMiddle1", f"{name}Hand", arm(side, 9.0), arm(side, 8.0))
        add(f"{name}UpLeg", "Hips", (9 * side * hips, -6, 0))
        add(f"{name}Leg", f"{name}UpLeg", (0, -42 * legs, 0.5))
        add(f"{name}Foot", f"{name}Leg", (0, -43 * legs, -1.5))
        add(f"{name}ToeBase", f"{name}Foot", (1.5 * side, -8, 13), (0, -0.5, 7))
    return skeleton_of_bones(bones, 0.01, BVH_FROM_BODY)
