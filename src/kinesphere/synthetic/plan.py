"""What a body is before it has a size: a tree of limbs, and how each of them can move."""

from dataclasses import dataclass, replace

import numpy as np

from kinesphere.geometry.rotations import Array

MIRROR = np.diag([1.0, 1.0, -1.0])
"""Left to right in the body frame (x anterior, y superior, z to the right)."""

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Movement:
    """A main movement of a limb: about which axis, how far, and what it does in a gait."""

    name: str
    about: Vector
    """Nominal direction of its axis in the body frame; the actor's own is tilted from it."""
    low: float
    """deg, may be 0 or a little below for a movement to one side."""
    high: float
    """deg."""
    gait: Vector = (0.0, 0.0, 0.0)
    """Mean and amplitude in deg, and lead in cycles, of the sine it follows while walking."""


@dataclass(frozen=True)
class LimbPlan:
    """A limb, the joint it hangs from and the movements that joint allows."""

    name: str
    parent: str | None
    joint: str
    """Name of the joint towards the parent; empty for the root."""
    canonical: Vector
    """Long axis in limb coordinates, proximal to distal (docs/conventions.md)."""
    length: float
    """Share of the body's size."""
    at: Vector | None = None
    """Joint centre from the parent's proximal end, as shares of the body's size, in the parent's
    frame; None for the parent's distal end."""
    stands: Vector | None = None
    """Direction of the limb in the default position, in the body frame; None for canonical."""
    movements: tuple[Movement, ...] = ()
    """About the distal axis first (docs/conventions.md, joint parameters)."""
    twist: tuple[float, float] = (0.0, 0.0)
    """deg, range of the twist about the limb's own long axis."""


@dataclass(frozen=True)
class BodyPlan:
    """A kind of body: what every actor drawn from it has in common."""

    name: str
    limbs: tuple[LimbPlan, ...]
    """Parents before children."""
    size: tuple[float, float]
    """m, mean and standard deviation of the size that all lengths are shares of."""
    together: frozenset[str] = frozenset()
    """Joints (without ``left_``) whose two sides calibrate at the same time."""
    stands_on: tuple[str, ...] = ()
    """Limbs whose far ends carry the body; none for a body held in the air."""
    sole: float = 0.0
    """Share of the size from those far ends down to the floor."""


def side_of(name: str) -> str:
    """Return ``left``, ``right`` or nothing."""
    side = name.partition("_")[0]
    return side if side in ("left", "right") else ""


def without_side(name: str) -> str:
    """Return ``knee`` for ``left_knee`` and for ``right_knee``."""
    side = side_of(name)
    return name.removeprefix(f"{side}_") if side else name


def other_side(name: str) -> str:
    """Return ``right_knee`` for ``left_knee`` and back; ``neck`` stays ``neck``."""
    swapped = {"left": "right", "right": "left"}
    side = side_of(name)
    return f"{swapped[side]}_{without_side(name)}" if side else name


def mirrored_plan(limb: LimbPlan) -> LimbPlan:
    """Return the same limb of the other side; an axis ``a`` becomes ``−S a``."""
    half_cycle = 0.5
    return replace(
        limb,
        name=other_side(limb.name),
        parent=None if limb.parent is None else other_side(limb.parent),
        joint=other_side(limb.joint),
        at=None if limb.at is None else _vector(MIRROR @ limb.at),
        stands=None if limb.stands is None else _vector(MIRROR @ limb.stands),
        movements=tuple(
            replace(
                movement,
                about=_vector(-MIRROR @ movement.about),
                gait=(movement.gait[0], movement.gait[1], movement.gait[2] + half_cycle),
            )
            for movement in limb.movements
        ),
    )


def _vector(values: Array) -> Vector:
    x, y, z = values
    return float(x), float(y), float(z)
