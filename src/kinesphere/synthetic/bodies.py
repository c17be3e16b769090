"""The bodies an actor can have, as tables.

Lengths are shares of stature after Drillis & Contini (1966), *Body segment parameters*, report
1166-03, New York University, as printed in Winter (2009), *Biomechanics and motor control of human
movement*, figure 4.1: heights of ankle .039, knee .285, hip .530, shoulder .818; upper arm .186,
forearm .146, foot .152. That figure shows outer breadths; joint centres lie deeper: hips .050 from
the middle (half of .72 of the distance of the anterior spines, Bell et al. 1990,
doi:10.1016/0021-9290(90)90054-7), shoulders .115 (biacromial .259, less the acromion).
Ranges of motion stay inside those of healthy adults (Winter 2009, chapter 5; Kapandji 1974).
"""

from dataclasses import replace
from math import cos, radians, sin

from kinesphere.synthetic.plan import BodyPlan, LimbPlan, Movement, mirrored_plan

_UP, _DOWN, _AHEAD = (0.0, 1.0, 0.0), (0.0, -1.0, 0.0), (1.0, 0.0, 0.0)
_LATERAL = (0.0, 0.0, 1.0)
_BACKWARD_LATERAL = (0.0, 0.0, -1.0)


def _hanging(out: float, forward: float) -> tuple[float, float, float]:
    """Return the direction of a left limb that hangs, ``out`` and ``forward`` of down in deg."""
    o, f = radians(out), radians(forward)
    return sin(f) * cos(o), -cos(f) * cos(o), -sin(o)


def _treading(out: float, down: float) -> tuple[float, float, float]:
    """Return the direction from a left ankle to the toes, ``out`` and ``down`` in deg."""
    o, d = radians(out), radians(down)
    return cos(d) * cos(o), -sin(d), -cos(d) * sin(o)


_LEFT_ARM = (
    LimbPlan(
        name="left_upper_arm",
        parent="trunk",
        joint="left_shoulder",
        canonical=_DOWN,
        length=0.186,
        at=(0.0, 0.288, -0.115),
        stands=_hanging(out=9, forward=0),
        movements=(
            Movement("abduction", _AHEAD, -8, 65, gait=(3, 3, 0.25)),
            Movement("flexion", _LATERAL, -40, 110, gait=(0, 20, 0.5)),
        ),
        twist=(-45, 45),
    ),
    LimbPlan(
        name="left_forearm",
        parent="left_upper_arm",
        joint="left_elbow",
        canonical=_DOWN,
        length=0.146,
        stands=_hanging(out=5, forward=10),
        movements=(Movement("flexion", _LATERAL, -5, 120, gait=(20, 15, 0.5)),),
        twist=(-65, 65),
    ),
)

_LEFT_LEG = (
    LimbPlan(
        name="left_thigh",
        parent="trunk",
        joint="left_hip",
        canonical=_DOWN,
        length=0.245,
        at=(0.0, 0.0, -0.050),
        stands=_hanging(out=2, forward=0),
        movements=(
            Movement("abduction", _AHEAD, -20, 40, gait=(2, 5, 0.25)),
            Movement("flexion", _LATERAL, -20, 85, gait=(10, 25, 0.0)),
        ),
        twist=(-30, 30),
    ),
    LimbPlan(
        name="left_shank",
        parent="left_thigh",
        joint="left_knee",
        canonical=_DOWN,
        length=0.246,
        stands=_hanging(out=0, forward=-2),
        movements=(Movement("flexion", _BACKWARD_LATERAL, -5, 110, gait=(30, 28, -0.15)),),
        twist=(-10, 10),
    ),
    LimbPlan(
        name="left_foot",
        parent="left_shank",
        joint="left_ankle",
        canonical=_AHEAD,
        length=0.115,
        stands=_treading(out=7, down=7),
        movements=(
            Movement("abduction", _UP, -20, 20, gait=(0, 4, 0.1)),
            Movement("dorsiflexion", _LATERAL, -35, 20, gait=(-3, 12, 0.6)),
        ),
        twist=(-20, 20),
    ),
)

HUMAN = BodyPlan(
    name="human",
    limbs=(
        LimbPlan("trunk", None, "", canonical=_UP, length=0.310),
        LimbPlan(
            name="head",
            parent="trunk",
            joint="neck",
            canonical=_UP,
            length=0.160,
            movements=(
                Movement("side bending", _AHEAD, -30, 30, gait=(0, 3, 0.25)),
                Movement("flexion", _BACKWARD_LATERAL, -35, 40, gait=(5, 4, 0.1)),
            ),
            twist=(-50, 50),
        ),
        *(twin for limb in _LEFT_ARM for twin in (limb, mirrored_plan(limb))),
        *(twin for limb in _LEFT_LEG for twin in (limb, mirrored_plan(limb))),
    ),
    size=(1.73, 0.08),
    together=frozenset({"shoulder", "elbow", "ankle"}),
    stands_on=("left_shank", "right_shank", "left_foot", "right_foot"),
    sole=0.025,
)
"""Twelve limbs, eleven joints; the trunk, pelvis included, is the root."""

PLAYER = replace(
    HUMAN,
    name="player",
    limbs=(
        *HUMAN.limbs,
        LimbPlan(
            name="racket",
            parent="right_forearm",
            joint="grip",
            canonical=_DOWN,
            length=0.39,
            stands=(0.5, -1.0, 0.0),
            movements=(
                Movement("swing", _LATERAL, -40, 40),
                Movement("tilt", _AHEAD, -30, 30),
            ),
            twist=(-40, 40),
        ),
    ),
)
"""A person with a racket of 68 cm, held in a hand that has no markers."""
