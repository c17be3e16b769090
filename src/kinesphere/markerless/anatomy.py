"""How a human surface may move: the full body and the paper's upper body, from named limbs.

Angles count from the bind pose. Ranges are round numbers that no healthy joint exceeds by much:
they are there to keep a search from impossible poses, not to describe a person.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from kinesphere.data import Array
from kinesphere.data.surface import Surface
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

UPPER = (
    "pelvis",
    "trunk",
    *(f"{s}_{b}" for s in ("left", "right") for b in ("upper_arm", "forearm", "hand")),
)
"""Limbs of the upper-body model of Rosenhahn et al. 2006, section 2: 6 + 1 + 2 · 7 parameters."""


def full_body(surface: Surface) -> Body:
    """Return the whole body: 42 degrees of freedom.

    A surface without clavicles gets them as a share of its trunk.

    Raises
    ------
    BadModel
        If the surface lacks a limb.
    """
    needed = [name for name in PARENTS if not name.endswith("clavicle")]
    if missing := [name for name in needed if name not in surface.limbs]:
        raise BadModel(f"the surface has no limb called {', '.join(missing)}")
    return _body(surface, list(PARENTS))


def upper_body(surface: Surface) -> Body:
    """Return the paper's model: six for the pose, one for the back, seven an arm.

    Head and clavicles are one with the trunk; legs are left away.
    """
    legs = [i for i, n in enumerate(surface.limbs) if n.endswith(("thigh", "shank", "foot"))]
    on_legs = surface.weights[:, legs].sum(axis=1) > 0.5
    whole = _body(surface, UPPER, back_hinge=True)
    faces = whole.faces[~on_legs[whole.faces].any(axis=1)]
    used = np.unique(faces)
    new = np.full(len(whole.bind), -1, dtype=np.int32)
    new[used] = np.arange(len(used))
    return replace(whole, bind=whole.bind[used], faces=new[faces], shares=whole.shares[used])


def _body(surface: Surface, names: Sequence[str], *, back_hinge: bool = False) -> Body:
    at = {name: i for i, name in enumerate(surface.limbs)}
    shares = np.zeros((len(surface.vertices), len(names)))
    for name, i in at.items():
        keeper = name
        while keeper not in names:  # what has no limb of its own moves with the next one inward
            keeper = PARENTS.get(keeper) or "pelvis"
        shares[:, names.index(keeper)] += surface.weights[:, i]
    places = {n: (surface.joint_centres[i], surface.ends[i]) for n, i in at.items()}
    if "left_clavicle" in names and "left_clavicle" not in at:
        _split_clavicles(surface.vertices, names, shares, places)
    hands = {
        n: surface.vertices[surface.weights[:, at[n]] > 0.5] for n in names if n.endswith("hand")
    }
    links = []
    for name in names:
        parent = PARENTS[name]
        while parent is not None and parent not in names:
            parent = PARENTS[parent]
        links.append(_link(name, parent, places, hands, back_hinge))
    house = tuple(n for n in names if not n.endswith("clavicle"))
    ends = np.array([places[n][1] for n in names])
    faces = surface.faces.astype(np.int32)
    return Body(Chain(tuple(links)), surface.vertices, faces, shares, ends, house)


def _split_clavicles(
    vertices: Array,
    names: Sequence[str],
    shares: Array,
    places: dict[str, tuple[Array, Array]],
) -> None:
    """Give each shoulder girdle its share of the trunk: all of it at the shoulder, none inward."""
    trunk = names.index("trunk")
    of_trunk = shares[:, trunk].copy()
    top = places["trunk"][1]
    for side in ("left", "right"):
        shoulder = places[f"{side}_upper_arm"][0]
        width = shoulder[2] - top[2]
        centre = np.array([shoulder[0], shoulder[1] + 0.1 * abs(width), top[2] + 0.15 * width])
        places[f"{side}_clavicle"] = (centre, shoulder)
        outward = _smooth((vertices[:, 2] - top[2]) / width, 0.25, 0.9)
        upward = _smooth((vertices[:, 1] - shoulder[1]) / abs(width), -1.2, -0.4)
        given = of_trunk * outward * upward
        shares[:, names.index(f"{side}_clavicle")] = given
        shares[:, trunk] -= given


def _smooth(x: Array, low: float, high: float) -> Array:
    t = np.clip((x - low) / (high - low), 0.0, 1.0)
    return np.asarray(t * t * (3 - 2 * t))


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
        ranges = (np.radians(angle) for angle in (swing, twist, stiffness))
        middle = _unit(towards)
        return Link(name, parent, centre, "ball", _NONE, _EMPTY, _EMPTY, along, middle, *ranges)

    def hinges(
        axes: Sequence[Array], low: Sequence[float], high: Sequence[float], stiffness: float
    ) -> Link:
        ranges = np.radians(low), np.radians(high)
        usual = float(np.radians(stiffness))
        stacked = np.array(axes)
        return Link(name, parent, centre, "axes", stacked, *ranges, along, along, stiffness=usual)

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
