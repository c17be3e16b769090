"""Whether the limbs that a person names for parts of a figure can be those parts."""

from collections.abc import Mapping
from itertools import pairwise

from kinesphere.data.skeleton import Skeleton
from kinesphere.data.tree import way_to_root
from kinesphere.errors import BadModel

_CHAINS = (("upper_arm", "forearm", "hand"), ("thigh", "shank", "foot", "toes"))


def check_given(skeleton: Skeleton, parts: Mapping[str, int], said: Mapping[str, str]) -> None:
    """Raise BadModel where one limb is two parts, or is not below the limb of the part above it.

    Only what a person named is doubted; what names and shape tell stays.

    Parameters
    ----------
    parts
        Part → index of the limb, those that were named among them.
    said
        Part → name of the limb, as a person named them.
    """
    names = skeleton.limb_names
    by_limb: dict[int, str] = {}
    for part, limb in sorted(parts.items(), key=lambda item: item[0] not in said):
        if (other := by_limb.setdefault(limb, part)) != part and other in said:
            also = "" if part in said else f"; name another limb for {part}, or an empty one"
            raise BadModel(f"{names[limb]!r} is to be both {other} and {part}{also}")
    for upper, lower in _pairs(parts):
        if (upper in said or lower in said) and parts[upper] not in way_to_root(
            skeleton.parents, parts[lower]
        ):
            raise BadModel(
                f"{lower} is {names[parts[lower]]!r}, which does not hang from "
                f"{names[parts[upper]]!r}, the {upper}; a part's limb is below that of the part "
                "it hangs from"
            )


def check_trunk(
    skeleton: Skeleton, pelvis: int, parts: Mapping[str, int], said: Mapping[str, str]
) -> None:
    """Raise BadModel where a named part is what both legs hang from.

    Parameters
    ----------
    pelvis
        Index of the limb that both thighs hang from.
    parts, said
        As of `check_given`.
    """
    for part in said:
        if parts.get(part) in way_to_root(skeleton.parents, pelvis):
            raise BadModel(
                f"{part} is to be {said[part]!r}, but both legs hang from it: that is the pelvis, "
                "or above it"
            )


def _pairs(parts: Mapping[str, int]) -> list[tuple[str, str]]:
    """Return the parts that are there, each with the next below it that is there."""
    found = []
    for side in ("left", "right"):
        for chain in _CHAINS:
            there = [name for part in chain if (name := f"{side}_{part}") in parts]
            found += list(pairwise(there))
    return found
