"""How OpenSim turns a joint: our angles as the coordinates of its custom joints.

Ours (``docs/conventions.md``), every axis fixed in the parent:

    parent_from_child = R(axes[-1], a) … R(axes[0], a1) · R(rest · long_axis, twist) · rest

A ``CustomJoint`` turns its child frame M against its parent frame F by ``R(u1, q1) R(u2, q2)
R(u3, q3)`` (Seth et al. 2010, Procedia IUTAM 2, 212–232, section 3.1; body-fixed, which as a
product of matrices is the same). With F standing like the parent, the ``u`` are our axes from the
proximal one to the twist's, and M is the child frame turned by ``rest`` transposed. Three
rotations fit into one joint and no two may share an axis; where there are more, a body without
extent stands between two joints.
"""

import re
from typing import NamedTuple

import numpy as np

from kinesphere.data import Array, Skeleton
from kinesphere.errors import BadModel
from kinesphere.geometry.rotations import rotation_between

LEAST_SINE = 0.05
"""Sine of the least angle (3°) between two axes of one OpenSim joint."""
ROOT_ROTATIONS = ("rx", "ry", "rz")
"""FreeJoint: body-fixed rotations about x, y, z, in this order."""
ROOT_TRANSLATIONS = ("tx", "ty", "tz")
COORDINATES = (
    "Coordinates: JOINT_axis1, 2, 3 and JOINT_twist are those angles; ROOT_rx, ry, rz body-fixed "
    "turns about x, y, z, ROOT_tx, ty, tz metres."
)


class Turn(NamedTuple):
    """One rotation of a joint."""

    coordinate: str
    """Name of the coordinate; empty for an axis that nothing turns about."""
    axis: Array
    """(3,) unit vector in the parent's frame."""


def opensim_name(name: str) -> str:
    r"""Return a name OpenSim takes: no blanks and none of ``/ \\ * +`` in it."""
    return re.sub(r"[\s/\\*+]", "_", name)


def root_coordinates(skeleton: Skeleton) -> list[str]:
    """Return the names of the root's coordinates: three rotations, three translations."""
    root = opensim_name(skeleton.limbs[0].name)
    return [f"{root}_{what}" for what in (*ROOT_ROTATIONS, *ROOT_TRANSLATIONS)]


def joint_coordinates(skeleton: Skeleton, joint: int) -> list[str]:
    """Return the names of a joint's coordinates: each axis, then the twist."""
    j = skeleton.joints[joint]
    name = opensim_name(j.name)
    return [*(f"{name}_axis{k}" for k in range(1, j.n_axes + 1)), f"{name}_twist"]


def joint_turns(skeleton: Skeleton, joint: int) -> list[list[Turn]]:
    """Return the rotations of a joint from its parent outward, as many groups as OpenSim needs.

    Each group holds exactly three rotations about axes no two of which are the same; the last of
    them may be about an axis without a coordinate.

    Raises
    ------
    BadModel
        If the joint has no axes or no rest orientation yet.
    """
    j = skeleton.joints[joint]
    if j.axes is None or j.rest is None:
        raise BadModel(f"joint {j.name} has no movement axes yet: parameterize first")
    *axis_names, twist_name = joint_coordinates(skeleton, joint)
    turns = [Turn(name, axis) for name, axis in zip(axis_names, j.axes, strict=True)][::-1]
    turns.append(Turn(twist_name, j.rest @ skeleton.limbs[joint + 1].long_axis))
    groups: list[list[Turn]] = [[]]
    for turn in turns:
        beside = [np.linalg.norm(np.cross(turn.axis, other.axis)) for other in groups[-1]]
        if len(beside) == 3 or min(beside, default=1.0) < LEAST_SINE:
            groups.append([])
        groups[-1].append(turn)
    return [_completed(group) for group in groups]


def _completed(group: list[Turn]) -> list[Turn]:
    """Add axes that nothing turns about until there are three."""
    if len(group) == 3:
        return group
    first = group[0].axis
    second = group[1].axis if len(group) > 1 else rotation_between(np.eye(3)[0], first)[:, 1]
    across = np.cross(first, second)
    idle = [Turn("", second)] if len(group) == 1 else []
    return [*group, *idle, Turn("", across / np.linalg.norm(across))]
