"""Which limbs of a skeleton are which parts of a human figure, whoever named and built it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from kinesphere.data.arrays import Array
from kinesphere.data.figure_names import Part, part_from_name
from kinesphere.data.figure_shape import parts_by_shape
from kinesphere.data.rest import default_origins
from kinesphere.data.skeleton import Skeleton
from kinesphere.data.tree import below, way_between, way_to_root
from kinesphere.errors import BadModel

SIDES = ("left", "right")
NEEDED = tuple(f"{side}_{part}" for part in ("thigh", "shank") for side in SIDES)
"""Parts without which a skeleton is no figure that walks."""
PARTS = (
    "head",
    *(
        f"{side}_{part}"
        for side in SIDES
        for part in ("upper_arm", "forearm", "hand", "thigh", "shank", "foot", "toes")
    ),
)
"""Parts that are found, or named by a person; what lies between them follows from the tree."""


@dataclass(frozen=True, eq=False)
class Figure:
    """Limbs of a skeleton by the part of the body they are."""

    parts: Mapping[str, int]
    """``PARTS`` → index of the limb; those that are not there are missing."""
    pelvis: int
    """The limb that both thighs hang from."""
    spine: tuple[int, ...]
    """Limbs above the pelvis, in order; the last one carries arms and head. May be empty."""
    neck: tuple[int, ...]
    """Limbs between the last of the spine and the head."""
    clavicles: Mapping[str, tuple[int, ...]]
    """Side → limbs between the last of the spine and the upper arm."""
    source: Literal["names", "shape", "given"]
    """What told the parts: names, the shape of the tree, or a person."""

    @property
    def chest(self) -> int:
        """The limb that arms and head hang from: the last of the spine, or the pelvis."""
        return self.spine[-1] if self.spine else self.pelvis


def find_figure(skeleton: Skeleton, given: Mapping[str, str] | None = None) -> Figure:
    """Find the parts of a human figure by the names of the limbs, or else by shape.

    Parameters
    ----------
    skeleton
        In its rest pose all limb frames stand parallel, y up.
    given
        Part → name of the limb, for what names and shape get wrong; an empty name: not there.

    Raises
    ------
    BadModel
        If there are no two legs, or a given part or limb does not exist.
    """
    said = dict(given or {})
    if odd := sorted(set(said) - set(PARTS)):
        raise BadModel(f"{odd[0]!r} is no part of a figure; the parts are {', '.join(PARTS)}")
    for part, limb in said.items():
        if limb and limb not in skeleton.limb_names:
            known = ", ".join(skeleton.limb_names[:20])
            raise BadModel(f"{part} is to be {limb!r}, which is no limb of the rig: {known}…")
    source: Literal["names", "shape", "given"] = "given" if said else "names"
    parts = _parts_by_name(skeleton)
    if any(part not in {**parts, **said} for part in NEEDED):
        parts = parts_by_shape(skeleton.parents, rest_places(skeleton))
        source = "given" if said else "shape"
    at = {name: i for i, name in enumerate(skeleton.limb_names)}
    parts = {k: i for k, i in parts.items() if k not in said} | {
        k: at[name] for k, name in said.items() if name
    }
    if missing := [part for part in NEEDED if part not in parts]:
        raise BadModel(
            f"neither names nor shape tell {', '.join(missing)} among {len(at)} limbs "
            f"({', '.join(list(at)[:8])}…); name them in a mapping"
        )
    if "head" not in {**parts, **said}:
        parts |= _head_of_spine(skeleton, parts)
    return _joined(skeleton.parents, parts, source)


def rest_places(skeleton: Skeleton) -> Array:
    """Return where each limb hangs in the rest pose, (n_limbs, 3) m, the root at the origin."""
    hangs = np.array([np.zeros(3), *(joint.centre_in_child for joint in skeleton.joints)])
    return np.asarray(default_origins(skeleton) + hangs)


def rest_from_body(figure: Figure, places: Array) -> Array:
    """Return the body's axes (x front, y up, z right) among those of the rest pose, (3, 3).

    Up along the body, right by hips and shoulders; a quarter turn at most from the axes there.

    Parameters
    ----------
    places : (n_limbs, 3) m
        Where each limb hangs in the rest pose.
    """
    parts = figure.parts
    hips = [places[parts[f"{side}_thigh"]] for side in SIDES]
    across = hips[1] - hips[0]
    if all(f"{side}_upper_arm" in parts for side in SIDES):
        across = across + places[parts["right_upper_arm"]] - places[parts["left_upper_arm"]]
    low = np.mean([places[parts[f"{side}_shank"]] for side in SIDES], axis=0)
    high = places[parts["head"]] if "head" in parts else np.mean(hips, axis=0)
    up = high - low
    z = _nearest_axis(across)
    up = np.where(z != 0, 0.0, up)
    y = _nearest_axis(up)
    return np.asarray(np.stack([np.cross(y, z), y, z], axis=1))


def _nearest_axis(vector: Array) -> Array:
    k = int(np.abs(vector).argmax())
    return np.asarray(np.eye(3)[k] * (1.0 if vector[k] >= 0 else -1.0))


def _parts_by_name(skeleton: Skeleton) -> dict[str, int]:
    """Return part → limb; of several limbs of one part the one nearest to the root counts."""
    parents = skeleton.parents
    found: dict[Part, list[int]] = {}
    for i, name in enumerate(skeleton.limb_names):
        if (part := part_from_name(name)) is not None:
            found.setdefault(part, []).append(i)
    for side in SIDES:
        arms, shoulders = Part("upper_arm", side), found.get(Part("shoulder", side), [])
        if shoulders and arms not in found:  # the file names joints: a shoulder, an elbow
            found[arms] = shoulders
        if (hips := found.get(Part("hip", side))) and Part("thigh", side) not in found:
            found[Part("thigh", side)] = hips
    parts = {}
    for part, limbs in found.items():
        name = f"{part.side}_{part.name}".lstrip("_")
        if name in PARTS:
            parts[name] = min(limbs, key=lambda i: len(way_to_root(parents, i)))
    return parts


def _head_of_spine(skeleton: Skeleton, parts: Mapping[str, int]) -> dict[str, int]:
    """Return the head where it is called as the spine is, as Rigify's ``spine.006``."""
    arms = [parts[f"{side}_upper_arm"] for side in SIDES if f"{side}_upper_arm" in parts]
    if len(arms) < 2:
        return {}
    chest = _common(skeleton.parents, arms)
    over = [
        i
        for i in below(skeleton.parents, chest)[1:]
        if (part := part_from_name(skeleton.limb_names[i])) and part.name == "trunk"
    ]
    return {"head": over[-1]} if over else {}


def _joined(
    parents: np.ndarray[tuple[int], np.dtype[np.intp]],
    parts: Mapping[str, int],
    source: Literal["names", "shape", "given"],
) -> Figure:
    legs = [parts[f"{side}_thigh"] for side in SIDES]
    pelvis = _common(parents, legs)
    upper = [parts[name] for name in ("head", "left_upper_arm", "right_upper_arm") if name in parts]
    chest = _common(parents, upper) if len(upper) > 1 else pelvis
    if chest in upper:  # an arm that hangs from the other, or from the head
        chest = int(parents[chest]) if parents[chest] >= 0 else pelvis
    spine = way_between(parents, pelvis, chest)
    if spine is None:  # arms and legs hang from one limb, or the tree is rooted at the chest
        chest, spine = pelvis, ()
    else:
        spine = (*spine, chest) if chest != pelvis else ()
    neck = way_between(parents, chest, parts["head"]) if "head" in parts else ()
    clavicles = {
        side: way_between(parents, chest, parts[f"{side}_upper_arm"]) or ()
        for side in SIDES
        if f"{side}_upper_arm" in parts
    }
    return Figure(dict(parts), pelvis, spine, neck or (), clavicles, source)


def _common(parents: np.ndarray[tuple[int], np.dtype[np.intp]], limbs: list[int]) -> int:
    """Return the last limb that all of these hang from, none of themselves if need be."""
    ways = [way_to_root(parents, i)[::-1] for i in limbs]
    shared = [step[0] for step in zip(*ways, strict=False) if len(set(step)) == 1]
    return shared[-1] if shared else 0
