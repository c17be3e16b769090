"""Which limb a bone is, by the names that rigs in use give their bones."""

import re

_WORDS: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("forearm", ("forearm", "lowerarm", "lowarm", "elbow", "arm_lower", "ulna")),
    ("clavicle", ("clavicle", "collar", "shoulder")),
    ("upper_arm", ("upperarm", "uparm", "arm_upper", "humerus", "arm")),
    ("hand", ("hand", "wrist")),
    ("thigh", ("upleg", "upperleg", "thigh", "leg_upper", "femur")),
    ("foot", ("foot", "ankle")),
    ("shank", ("lowerleg", "lowleg", "shin", "shank", "calf", "leg_lower", "knee", "tibia", "leg")),
)
"""Kind of limb with a side → words for it; the first that is found counts."""
_MIDDLE = (
    ("pelvis", ("pelvis", "hips", "hip")),
    ("trunk", ("trunk", "spine", "chest", "torso", "abdomen", "waist", "thorax")),
    ("head", ("neck", "head")),
)
_LEFT, _RIGHT = (
    re.compile(r"(^|[^a-z])(l|left)([^a-z]|$)"),
    re.compile(r"(^|[^a-z])(r|right)([^a-z]|$)"),
)
_NO_LIMB = (
    "twist",
    "roll",
    "ik",
    "pole",
    "helper",
    "toe",
    "finger",
    "thumb",
    "index",
    "eye",
    "jaw",
)


def limb_of_bone(name: str) -> str | None:
    """Return the house's name of the limb that begins with a bone, None if no limb does.

    >>> limb_of_bone("mixamorig:LeftForeArm"), limb_of_bone("thigh_r"), limb_of_bone("UpperArm.L")
    ('left_forearm', 'right_thigh', 'left_upper_arm')
    """
    bare = re.sub(
        r"^(mixamorig\d*|bip\d*|cc_base|def|org|armature)[:_\- .|]+", "", name, flags=re.I
    )
    parted = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", bare).lower()
    side = "left" if _LEFT.search(parted) else "right" if _RIGHT.search(parted) else ""
    words = re.sub(r"[^a-z_]", "_", parted)
    joined = re.sub(r"_+", "", re.sub(r"(^|_)(l|r|left|right)(?=_|$)", "_", words))
    if any(word in words.split("_") or joined.startswith(word) for word in _NO_LIMB):
        return None
    for kind, spellings in _WORDS if side else _MIDDLE:
        if any(s.replace("_", "") in joined for s in spellings):
            return f"{side}_{kind}" if side else kind
    return None
