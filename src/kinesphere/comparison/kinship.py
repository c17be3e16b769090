"""What two sides share by their origin: their frames, their world, the frames of their limbs.

What is shared is not sought: a fit would take out with it some of what was changed.
"""

from dataclasses import dataclass

import numpy as np

from kinesphere.comparison.sides import Side, relative
from kinesphere.data import History, Skeleton
from kinesphere.geometry.rotations import rotation_angle

_ROUNDED = 1e-6  # m or rad: what tables and files keep
_TURNS = 1e-4  # rad from one frame to the next from which on a joint moves
_MOST = 0.5  # of the frames in which a joint moves


@dataclass(frozen=True)
class Kinship:
    """What needs no alignment, because both sides have it from one source."""

    clock: bool = False
    """Frame k of one is frame k of the other."""
    world: bool = False
    """Both are told in one world."""
    limbs: bool = False
    """Limbs have one shape in frames that are therefore the same."""


def find_kinship(first: Side, second: Side) -> Kinship:
    """Return what two sides share.

    One recording, solved twice or edited, has one clock, and one world where it was put upright
    alike. Where nothing tells the recording, as in tables and BVH files, joints that move through
    the same angles frame by frame tell the clock. One skeleton has one set of limb frames.
    """
    alike = _as_many_frames(first, second)
    recording = alike and _one_recording(first.history, second.history)
    return Kinship(
        clock=recording or (alike and _a_joint_moves_alike(first, second)),
        world=recording and _turned_upright(first.history) == _turned_upright(second.history),
        limbs=_one_shape(first.skeleton, second.skeleton),
    )


def _as_many_frames(first: Side, second: Side) -> bool:
    a, b = first.motion, second.motion
    return (a.n_frames, a.rate, a.first_frame) == (b.n_frames, b.rate, b.first_frame)


def _one_recording(first: History, second: History) -> bool:
    """Return whether both were made of one file; a name such as ``motion.bvh`` alone says little.

    What was only read, and never solved, does not tell of which recording it is.
    """
    solved = all(any(step.name != "read" for step in history) for history in (first, second))
    return solved and _said(first, "read")[:1] == _said(second, "read")[:1] != []


def _turned_upright(history: History) -> list[tuple[object, object]]:
    return _said(history, "orientation")


def _said(history: History, name: str) -> list[tuple[object, object]]:
    return [(step.settings, step.findings) for step in history if step.name == name]


def _a_joint_moves_alike(first: Side, second: Side) -> bool:
    """Return whether a joint has the same poses in most of the frames in which it moves."""
    for joint in first.skeleton.joints:
        if joint.name not in second.skeleton.joint_names:
            continue
        other = second.skeleton.joint(joint.name)
        a = relative(first, joint.parent, joint.child)
        b = relative(second, other.parent, other.child)
        with np.errstate(invalid="ignore"):
            moves = rotation_angle(np.swapaxes(a[:-1], -1, -2) @ a[1:]) > _TURNS
            same = np.abs(a - b).max(axis=(1, 2)) < _ROUNDED
        if moves.any() and same[1:][moves].mean() > _MOST:
            return True
    return False


def _one_shape(first: Skeleton, second: Skeleton) -> bool:
    """Return whether common limbs have their markers, and common joints their centres, in place.

    Two skeletons that were measured apart never do.
    """
    limbs = [
        (limb, second.limb(limb.name)) for limb in first.limbs if limb.name in second.limb_names
    ]
    joints = [
        (joint, second.joint(joint.name))
        for joint in first.joints
        if joint.name in second.joint_names
    ]
    return all(
        a.markers == b.markers
        and _near(a.marker_positions, b.marker_positions)
        and _near(a.long_axis, b.long_axis)
        for a, b in limbs
    ) and all(
        (a.parent, a.child) == (b.parent, b.child)
        and _near(a.centre_in_parent, b.centre_in_parent)
        and _near(a.centre_in_child, b.centre_in_child)
        for a, b in joints
    )


def _near(first: np.ndarray, second: np.ndarray) -> bool:
    return bool(np.allclose(first, second, rtol=0.0, atol=_ROUNDED, equal_nan=True))
