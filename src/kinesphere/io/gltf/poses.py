"""Poses as glTF tells them: nodes that hang from one another, turned by quaternions."""

from typing import NamedTuple

import numpy as np

from kinesphere.data import Array, Motion, Skeleton, default_origins, pivots, poses_without_gaps
from kinesphere.geometry.rotations import quaternions_from_rotations

FRONT_FROM_BODY = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
"""Body axes are x front, y up, z right; what glTF shows at rest looks along z, its left at x."""


class NodePoses(NamedTuple):
    """Where the nodes of the limbs are in their parents."""

    translations: Array
    """(n_frames, n_limbs, 3) m."""
    rotations: Array
    """(n_frames, n_limbs, 4) unit quaternions xyzw, no jumps of sign."""


def node_poses(motion: Motion) -> NodePoses:
    """Return the pose of every limb in its parent's node, in every frame.

    A node has the axes of its limb and lies where the limb turns (`pivots`), so that nothing is
    lost where joints come apart: the node follows the child.
    """
    rotations, origins = poses_without_gaps(motion)
    places = origins + (rotations @ pivots(motion.skeleton)[:, :, None])[..., 0]
    parents = motion.skeleton.parents[1:]
    turns, ways = rotations.copy(), places.copy()
    back = np.swapaxes(rotations[:, parents], -1, -2)
    turns[:, 1:] = back @ rotations[:, 1:]
    ways[:, 1:] = (back @ (places[:, 1:] - places[:, parents])[..., None])[..., 0]
    return NodePoses(ways, continuous(quaternions_from_rotations(turns)))


def rest_places(skeleton: Skeleton) -> Array:
    """Return where the nodes are in the default position, (n_limbs, 3) m in the body frame."""
    places: Array = default_origins(skeleton) + pivots(skeleton)
    return places


def continuous(quaternions: Array) -> Array:
    """Return the same rotations, (n_frames, ..., 4), each on the side of the one before."""
    same = np.einsum("f...i,f...i->f...", quaternions[1:], quaternions[:-1])
    signs = np.cumprod(np.where(same < 0, -1.0, 1.0), axis=0)
    joined = quaternions.copy()
    joined[1:] *= signs[..., None]
    return joined
