"""Forward kinematics of a tree of limbs: parameters in, poses out. Arrays only."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.rotations import turned, turned_from

Array = NDArray[np.float64]


def joint_rotations(
    axes: Array, rest: Array, long_axis: Array, angles: Array, twists: Array
) -> Array:
    """Return ``parent_from_child`` of one joint from its parameters.

    ``R(axes[-1], angles[-1]) … R(axes[0], angles[0]) R(rest @ long_axis, twist) rest``, every axis
    fixed in the parent (Sar Dessai et al. 2006, sections 4.4 and 4.5).

    Parameters
    ----------
    axes : (n_axes, 3)
        Unit vectors in the parent frame, distal at rest first.
    rest : (3, 3)
        ``parent_from_child`` where all angles are zero.
    long_axis : (3,)
        Unit vector in the child frame.
    angles : (n_frames, 3) rad
        Columns beyond ``n_axes`` are ignored. Of three, the first is about the limb or nearly so;
        NaN counts as zero there while the others are known.
    twists : (n_frames,) rad
        NaN counts as zero: a twist that nothing tells.

    Returns
    -------
    (n_frames, 3, 3)
        NaN where another angle is NaN.
    """
    if len(axes) == 3:
        angles = three_told(angles)
    twists = np.nan_to_num(twists, nan=0.0)
    rotations = turned_from(rest, rest @ long_axis, twists)
    for axis, angle in zip(axes, angles.T, strict=False):
        rotations = turned(rotations, axis, angle)
    return rotations


def three_told(angles: Array) -> Array:
    """Return angles of three axes, (n_frames, 3) rad, with zero for a first one nothing tells.

    Frames without the other two stay as they are.
    """
    told = np.array(angles)
    told[np.isnan(told[:, 0]) & np.isfinite(told[:, 1:]).all(axis=1), 0] = 0.0
    return told


def chain_poses(
    parents: Sequence[int] | NDArray[np.intp],
    root_rotations: Array,
    root_origins: Array,
    relative: Array,
    centres_in_parent: Array,
    centres_in_child: Array,
) -> tuple[Array, Array]:
    """Return the world pose of every limb of a tree whose joints never come apart.

    Parameters
    ----------
    parents : (n_limbs,)
        Index of each limb's parent, −1 for limb 0; parents come first. Joint ``j`` carries limb
        ``j + 1``.
    root_rotations, root_origins : (n_frames, 3, 3), (n_frames, 3) m
    relative : (n_frames, n_joints, 3, 3)
        ``parent_from_child``.
    centres_in_parent, centres_in_child : (n_joints, 3) m

    Returns
    -------
    rotations, origins : (n_frames, n_limbs, 3, 3), (n_frames, n_limbs, 3) m
        NaN from the first unknown joint outward.
    """
    n_frames, n_limbs = len(root_rotations), len(parents)
    rotations = np.empty((n_frames, n_limbs, 3, 3))
    origins = np.empty((n_frames, n_limbs, 3))
    rotations[:, 0], origins[:, 0] = root_rotations, root_origins
    for joint, limb in enumerate(range(1, n_limbs)):
        parent = parents[limb]
        rotations[:, limb] = rotations[:, parent] @ relative[:, joint]
        centre = origins[:, parent] + rotations[:, parent] @ centres_in_parent[joint]
        origins[:, limb] = centre - rotations[:, limb] @ centres_in_child[joint]
    return rotations, origins
