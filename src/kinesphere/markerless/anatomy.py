"""How a human surface may move: the full body and the paper's upper body, from named limbs.

Angles count from the bind pose. Ranges are round numbers that no healthy joint exceeds by much:
they are there to keep a search from impossible poses, not to describe a person.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.errors import BadModel
from kinesphere.markerless.body import Body
from kinesphere.markerless.chain import Chain, Link

AHEAD, UP, RIGHT = np.eye(3)
_NONE = np.empty((0, 3))
_EMPTY = np.empty(0)
_BENT = np.radians(10)  # from here on the bind pose itself tells a hinge's axis

PARENTS = {
    "pelvis": None,
    "trunk": "pelvis",
    "head": "trunk",
    **{
        f"{side}_{limb}": parent if parent in ("trunk", "pelvis") else f"{side}_{parent}"
        for side in ("left", "right")
        for limb, parent in (
            ("clavicle", "trunk"),
            ("upper_arm", "clavicle"),
            ("forearm", "upper_arm"),
            ("hand", "forearm"),
            ("thigh", "pelvis"),
            ("shank", "thigh"),
            ("foot", "shank"),
        )
    },
}
"""The human limbs known here, parents first; a clavicle may be missing."""

UPPER = ("pelvis", "trunk", *(f"{s}_{b}" for s in ("left", "right") for b in ("upper_arm", "forearm", "hand")))
"""Limbs of the upper-body model of Rosenhahn et al. 2006, section 2: 6 + 1 + 2 · 7 parameters."""


@dataclass(frozen=True, eq=False)
class Rig:
    """A surface with named limbs in the bind pose: y up, x ahead, z to the right, metres."""

    vertices: Array
    """(n_vertices, 3)."""
    faces: NDArray[np.int32]
    limb_names: tuple[str, ...]
    shares: Array
    """(n_vertices, n_limbs)."""
    centres: Array
    """(n_limbs, 3) where each limb begins."""
    ends: Array
    """(n_limbs, 3) where it ends."""


def full_body(rig: Rig) -> Body:
    """Return the whole body: 42 degrees of freedom, 38 where the surface has no clavicles.

    Raises
    ------
    BadModel
        If the surface lacks a limb.
    """
    needed = [name for name in PARENTS if not name.endswith("clavicle")]
    if missing := [name for name in needed if name not in rig.limb_names]:
        raise BadModel(f"the surface has no limb called {', '.join(missing)}")
    return _body(rig, [name for name in PARENTS if name in rig.limb_names])


def upper_body(rig: Rig) -> Body:
    """Return the paper's model: six for the pose, one for the back, seven an arm.

    Head and clavicles are one with the trunk; legs are left away.
    """
    legs = [i for i, n in enumerate(rig.limb_names) if n.endswith(("thigh", "shank", "foot"))]
    on_legs = rig.shares[:, legs].sum(axis=1) > 0.5
    faces = rig.faces[~on_legs[rig.faces].any(axis=1)]
    used = np.unique(faces)
    new = np.full(len(rig.vertices), -1, dtype=np.int32)
    new[used] = np.arange(len(used))
    cut = Rig(
        rig.vertices[used],
        new[faces],
        rig.limb_names,
        rig.shares[used],
        rig.centres,
        rig.ends,
    )
    return _body(cut, UPPER, back_hinge=True)


def _body(rig: Rig, names: Sequence[str], *, back_hinge: bool = False) -> Body:
    at = {name: i for i, name in enumerate(rig.limb_names)}
    shares = np.zeros((len(rig.vertices), len(names)))
    for name, i in at.items():
        keeper = name
        while keeper not in names:  # what has no limb of its own moves with the next one inward
            keeper = PARENTS.get(keeper) or "pelvis"
        shares[:, names.index(keeper)] += rig.shares[:, i]
    places = {n: (rig.centres[at[n]], rig.ends[at[n]]) for n in names}
    hands = {n: rig.vertices[rig.shares[:, at[n]] > 0.5] for n in names if n.endswith("hand")}
    links = []
    for name in names:
        parent = PARENTS[name]
        while parent is not None and parent not in names:
            parent = PARENTS[parent]
        links.append(_link(name, parent, places, hands, back_hinge))
    house = tuple(n for n in names if not n.endswith("clavicle"))
    ends = np.array([places[n][1] for n in names])
    return Body(Chain(tuple(links)), rig.vertices, rig.faces, shares, ends, house)


def _link(
    name: str,
    parent: str | None,
    places: Mapping[str, tuple[Array, Array]],
    hands: Mapping[str, Array],
    back_hinge: bool,
) -> Link:
    centre, end = places[name]
    along = _unit(end - centre)
    out = RIGHT if name.startswith("right") else -RIGHT
    limb = name.split("_", 1)[-1]

    def ball(towards: Array, swing: float, twist: float, stiffness: float) -> Link:
        return Link(name, parent, centre, "ball", _NONE, _EMPTY, _EMPTY, along,
                    _unit(towards), np.radians(swing), np.radians(twist), np.radians(stiffness))  # fmt: skip

    def hinges(axes: Sequence[Array], low: Sequence[float], high: Sequence[float], stiff: float) -> Link:  # fmt: skip
        return Link(name, parent, centre, "axes", np.array(axes), np.radians(low),
                    np.radians(high), along, along, stiffness=np.radians(stiff))  # fmt: skip

    if parent is None:
        return Link(name, None, centre, "free", _NONE, _EMPTY, _EMPTY, along, along)
    if limb == "trunk":
        if back_hinge:
            return hinges([-RIGHT], [-30], [90], 20)
        return ball(along, 70, 60, 15)
    if limb == "head":
        return ball(along, 70, 80, 20)
    if limb == "clavicle":
        # raised, and brought forward
        axes = [_unit(np.cross(out, UP)), _unit(np.cross(out, AHEAD))]
        return hinges(axes, [-15, -25], [40, 30], 10)
    if limb == "upper_arm":
        return ball(out + 0.5 * AHEAD - 0.2 * UP, 115, 110, 60)
    if limb == "forearm":
        before = _unit(centre - places[name.replace("forearm", "upper_arm")][0])
        axis, bent = _hinge(before, along, AHEAD)
        return hinges([axis, along], [-bent - 5, -100], [150 - bent, 100], 60)
    if limb == "hand":
        palm = _thinnest(hands[name], along)
        return hinges([palm, np.cross(palm, along)], [-35, -80], [35, 80], 20)
    if limb == "thigh":
        return ball(-UP + 0.6 * AHEAD + 0.2 * out, 100, 60, 40)
    if limb == "shank":
        before = _unit(centre - places[name.replace("shank", "thigh")][0])
        axis = _unit(RIGHT * -1.0 - along * (-RIGHT @ along))
        bent = float(np.degrees(np.arcsin(np.clip(np.cross(before, along) @ axis, -1, 1))))
        return hinges([axis], [-bent - 5], [155 - bent], 40)
    if limb == "foot":
        return hinges([RIGHT, AHEAD], [-60, -30], [40, 30], 20)
    raise BadModel(f"limb {name} is none of {', '.join(PARENTS)}")


def _hinge(before: Array, along: Array, forward: Array) -> tuple[Array, float]:
    """Return the axis that flexes, and how far the bind pose has flexed already, in degrees."""
    axis = np.cross(before, along)
    bent = float(np.arctan2(np.linalg.norm(axis), before @ along))
    if bent < _BENT:
        axis = np.cross(before, forward)
    return _unit(axis), float(np.degrees(bent))


def _thinnest(points: Array, along: Array) -> Array:
    """Return the direction across ``along`` in which points spread least."""
    if len(points) < 4:
        flat = np.cross(along, UP if abs(along @ UP) < 0.9 else AHEAD)
        return _unit(flat)
    spread = points - points.mean(axis=0)
    spread = spread - (spread @ along)[:, None] * along
    # of the two directions across, the second; the third is the one taken out
    return _unit(np.linalg.svd(spread, full_matrices=False)[2][1])


def _unit(v: Array) -> Array:
    return np.asarray(v / np.linalg.norm(v))
