"""Bodies that are no people, so that nothing in the line takes a person for granted.

Sizes are round figures of a large dog and of an adult's hand (phalanges about 0.23, 0.13 and 0.10
of the hand's length, Buryanov & Kotiuk 2010, Int. J. Morphol. 28(3), 755-758).
"""

from kinesphere.synthetic.plan import BodyPlan, LimbPlan, Movement, Vector, mirrored_plan

_UP, _DOWN, _AHEAD = (0.0, 1.0, 0.0), (0.0, -1.0, 0.0), (1.0, 0.0, 0.0)
_LATERAL, _BACKWARD_LATERAL = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)


def _leg(end: str, at: Vector, bends: Vector, lead: float) -> tuple[LimbPlan, ...]:
    """Return a left leg of three limbs; ``bends`` is the axis of its middle joint."""
    return (
        LimbPlan(
            name=f"left_{end}_thigh",
            parent="trunk",
            joint=f"left_{end}_hip",
            canonical=_DOWN,
            length=0.28,
            at=at,
            stands=(-0.2 * bends[2], -1.0, -0.05),
            movements=(
                Movement("abduction", _AHEAD, -20, 35, gait=(0, 3, 0.25)),
                Movement("swing", _LATERAL, -40, 50, gait=(0, 20, lead)),
            ),
            twist=(-20, 20),
        ),
        LimbPlan(
            name=f"left_{end}_shank",
            parent=f"left_{end}_thigh",
            joint=f"left_{end}_knee",
            canonical=_DOWN,
            length=0.28,
            stands=(0.2 * bends[2], -1.0, 0.0),
            movements=(Movement("flexion", bends, -10, 80, gait=(25, 20, lead + 0.2)),),
            twist=(-10, 10),
        ),
        LimbPlan(
            name=f"left_{end}_foot",
            parent=f"left_{end}_shank",
            joint=f"left_{end}_ankle",
            canonical=_DOWN,
            length=0.14,
            stands=(0.2, -1.0, 0.0),
            movements=(
                Movement("abduction", _AHEAD, -20, 20),
                Movement("swing", _LATERAL, -45, 45, gait=(0, 15, lead + 0.3)),
            ),
            twist=(-15, 15),
        ),
    )


_FORELEG = _leg("fore", (0.75, -0.1, -0.12), _LATERAL, lead=0.0)
_HIND_LEG = _leg("hind", (0.0, -0.05, -0.10), _BACKWARD_LATERAL, lead=0.5)

QUADRUPED = BodyPlan(
    name="quadruped",
    limbs=(
        LimbPlan("trunk", None, "", canonical=_AHEAD, length=0.80),
        LimbPlan(
            name="head",
            parent="trunk",
            joint="neck",
            canonical=_AHEAD,
            length=0.40,
            stands=(1.0, 0.5, 0.0),
            movements=(
                Movement("turn", _UP, -45, 45),
                Movement("nod", _LATERAL, -50, 35, gait=(0, 8, 0.1)),
            ),
            twist=(-30, 30),
        ),
        *(twin for limb in _FORELEG for twin in (limb, mirrored_plan(limb))),
        *(twin for limb in _HIND_LEG for twin in (limb, mirrored_plan(limb))),
    ),
    size=(0.90, 0.08),
    together=frozenset({"fore_ankle", "hind_ankle"}),
    stands_on=("left_fore_foot", "right_fore_foot", "left_hind_foot", "right_hind_foot"),
)
"""Fourteen limbs, thirteen joints; its trunk lies along the body's x."""


def _finger(name: str, at: Vector, share: float, spread: float) -> tuple[LimbPlan, ...]:
    """Return three phalanges of a hand held out flat, palm down; ``share`` scales their length."""
    flexion = Movement("flexion", _BACKWARD_LATERAL, -5, 85)
    return (
        LimbPlan(
            name=f"{name}_proximal",
            parent="palm",
            joint=f"{name}_knuckle",
            canonical=_AHEAD,
            length=0.23 * share,
            at=at,
            stands=(1.0, 0.0, spread),
            movements=(
                Movement("spread", _UP, -18, 18),
                Movement("flexion", _BACKWARD_LATERAL, -20, 75),
            ),
            twist=(-8, 8),
        ),
        LimbPlan(
            name=f"{name}_middle",
            parent=f"{name}_proximal",
            joint=f"{name}_middle_joint",
            canonical=_AHEAD,
            length=0.13 * share,
            stands=(1.0, -0.08, spread),
            movements=(flexion,),
            twist=(-4, 4),
        ),
        LimbPlan(
            name=f"{name}_distal",
            parent=f"{name}_middle",
            joint=f"{name}_end_joint",
            canonical=_AHEAD,
            length=0.10 * share,
            stands=(1.0, -0.16, spread),
            movements=(flexion,),
            twist=(-4, 4),
        ),
    )


HAND = BodyPlan(
    name="hand",
    limbs=(
        LimbPlan("palm", None, "", canonical=_AHEAD, length=0.50),
        *_finger("thumb", (0.15, 0.0, -0.15), 1.0, -0.7),
        *_finger("index", (0.50, 0.0, -0.14), 1.0, -0.1),
        *_finger("middle", (0.50, 0.0, -0.04), 1.1, 0.0),
        *_finger("ring", (0.48, 0.0, 0.06), 1.0, 0.08),
        *_finger("little", (0.44, 0.0, 0.15), 0.8, 0.18),
    ),
    size=(0.19, 0.01),
)
"""Sixteen limbs of a right hand in the air, fingers ahead, thumb to the left."""
