"""New limb frames in every frame of the recording, and in everything measured in them."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Array, Joint, Limb, Motion, Skeleton, given_away
from kinesphere.normalization.kernels import move_frames


def propagate(motion: Motion, turns: Array, shifts: Array, along: Array, lengths: Array) -> Motion:
    """Give every limb a new frame that sits still within it (Sar Dessai et al. 2006, section 3).

    ``R_new(t) = R(t) C`` and ``x_new(t) = x(t) + R(t) s``: where things are in the world does not
    change, only the coordinates that say it.

    Parameters
    ----------
    motion
    turns : (n_limbs, 3, 3)
        C, ``old_from_new``.
    shifts : (n_limbs, 3) m
        s, the new origins in the old frames.
    along : (n_limbs, 3)
        Long axes in the new frames.
    lengths : (n_limbs,) m
        Used where a limb has no length yet.
    """
    rotations, origins = move_frames(motion.rotations, motion.origins, turns, shifts)
    return replace(
        motion,
        skeleton=move_skeleton(motion.skeleton, turns, shifts, along, lengths),
        rotations=given_away(rotations),
        origins=given_away(origins),
    )


def move_skeleton(
    skeleton: Skeleton, turns: Array, shifts: Array, along: Array, lengths: Array
) -> Skeleton:
    """Return the skeleton in new limb frames; parameters as in ``propagate``."""
    at = {name: i for i, name in enumerate(skeleton.limb_names)}
    limbs = tuple(
        _moved_limb(limb, turns[i], shifts[i], along[i], lengths[i])
        for i, limb in enumerate(skeleton.limbs)
    )
    joints = tuple(
        _moved_joint(joint, turns, shifts, at[joint.parent], at[joint.child])
        for joint in skeleton.joints
    )
    return replace(skeleton, limbs=limbs, joints=joints)


def _moved_limb(limb: Limb, turn: Array, shift: Array, along: Array, length: float) -> Limb:
    return replace(
        limb,
        marker_positions=(limb.marker_positions - shift) @ turn,
        long_axis=along,
        length=limb.length if np.isfinite(limb.length) else float(length),
    )


def _moved_joint(joint: Joint, turns: Array, shifts: Array, parent: int, child: int) -> Joint:
    turn = turns[parent]
    return replace(
        joint,
        centre_in_parent=(joint.centre_in_parent - shifts[parent]) @ turn,
        centre_in_child=(joint.centre_in_child - shifts[child]) @ turns[child],
        covariance=turn.T @ joint.covariance @ turn,
        axes=None if joint.axes is None else joint.axes @ turn,
        rest=None if joint.rest is None else turn.T @ joint.rest @ turns[child],
    )
