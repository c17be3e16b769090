"""What other programs call the limbs that a BVH file holds."""

from collections.abc import Sequence
from typing import Literal, TypeAlias

Naming: TypeAlias = Literal["kinesphere", "unity", "motionbuilder"]

_UNITY = {
    "pelvis": "Hips",
    "trunk": "Spine",
    "head": "Head",
    "upper_arm": "UpperArm",
    "forearm": "LowerArm",
    "hand": "Hand",
    "thigh": "UpperLeg",
    "shank": "LowerLeg",
    "foot": "Foot",
}
_MOTIONBUILDER = _UNITY | {
    "upper_arm": "Arm",
    "forearm": "ForeArm",
    "thigh": "UpLeg",
    "shank": "Leg",
}
NAMINGS: dict[str, dict[str, str]] = {
    "kinesphere": {},
    "unity": _UNITY,
    "motionbuilder": _MOTIONBUILDER,
}
"""Unity's human bones; MotionBuilder's characters, which Mixamo and most of Blender's add-ons
take as well."""


def renamed(limbs: Sequence[str], naming: Naming) -> tuple[str, ...]:
    """Return the limbs' names in another program's words; what it has no word for stays.

    Where no limb is called pelvis, the trunk that stands in for it is the hips.
    """
    words = NAMINGS[naming]
    if words and "pelvis" not in limbs:
        words = words | {"trunk": words["pelvis"]}
    names = []
    for limb in limbs:
        side, _, part = limb.partition("_")
        if side in ("left", "right") and part in words:
            names.append(side.title() + words[part])
        else:
            names.append(words.get(limb, limb))
    return tuple(names) if len(set(names)) == len(names) else tuple(limbs)
