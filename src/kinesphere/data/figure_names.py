"""What animation and anatomy call the parts of a human figure, and which part a name means.

Mixamo and MotionBuilder (``LeftUpLeg``), Unity (``LeftUpperLeg``), Unreal (``thigh_l``), Rigify
(``DEF-thigh.L``), Biped (``Bip01 L Thigh``), VRM (``J_Bip_L_UpperLeg``), CMU's ASF (``lfemur``),
OpenSim (``femur_l``), files that name joints (``LeftHip``, ``LeftKnee``), and ours.
"""

import re
from typing import NamedTuple

_SPELLINGS = {
    "pelvis": "pelvis hips hip hipscenter",
    "trunk": "trunk torso chest upperchest thorax spine ribcage abdomen waist lowerback upperback",
    "neck": "neck lowerneck upperneck",
    "head": "head skull",
    "clavicle": "clavicle collar collarbone",
    "upper_arm": "upperarm uparm humerus arm",
    "forearm": "forearm lowerarm lowarm radius ulna elbow",
    "hand": "hand wrist",
    "thigh": "thigh upleg upperleg femur",
    "shank": "shank leg calf shin tibia lowerleg lowleg knee",
    "foot": "foot ankle calcn",
    "toes": "toes toe toebase ball",
    # one word for two parts: the tree tells which
    "shoulder": "shoulder",
    "hip": "",
}
_PART = {word: part for part, words in _SPELLINGS.items() for word in words.split()}
_CENTRAL = ("pelvis", "trunk", "neck", "head")
_SIDES = {"l": "left", "left": "left", "r": "right", "right": "right"}
_PREFIX = re.compile(
    r"^(.*[:|])?"
    r"(mixamorig\d*|character\d*|valvebiped|bip\d+|cc_base|def|org|j_bip_c|j_bip|genesis\d*)?"
    r"[-_. ]*",
    re.IGNORECASE,
)
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+")


class Part(NamedTuple):
    """A part of the body."""

    name: str
    """``thigh``, or ``shoulder`` and ``hip`` where the word alone does not tell the part."""
    side: str
    """``left``, ``right`` or empty."""


def part_from_name(name: str) -> Part | None:
    """Return the part of the body that a limb's name means; None if it means none."""
    words = [word.lower() for word in _WORD.findall(_PREFIX.sub("", name, count=1))]
    sides = {_SIDES[word] for word in words if word in _SIDES}
    side = sides.pop() if len(sides) == 1 else ""
    word = "".join(word for word in words if word not in _SIDES)
    if word not in _PART and not side:  # lfemur, leftarm
        for start in ("left", "right", "l", "r"):
            if word.startswith(start) and word.removeprefix(start) in _PART:
                side, word = _SIDES[start], word.removeprefix(start)
                break
    part = _PART.get(word)
    if part is None:
        return None
    if side and part == "pelvis":
        return Part("hip", side) if word == "hip" else None
    if bool(side) == (part in _CENTRAL):
        return None
    return Part(part, side)
