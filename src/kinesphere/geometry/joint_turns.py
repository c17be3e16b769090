"""How a joint turns: away from its mean, about which axis, and which poses it shows."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from kinesphere.geometry.centre_views import Turning
from kinesphere.geometry.rotations import mean_rotation, rotation_log

Array = NDArray[np.float64]

ONE_AXIS = 0.05
"""Share of the widest rotation's variance below which the second-widest counts as none."""
DENSE = np.deg2rad(5.0)
"""rad, poses nearer to each other than this are one pose held."""
BLOCK = 64
"""Poses that are compared with all others at a time: so many stay in the processor's cache."""
STILL = 1e-3
"""rad, rms rotation of a joint below which nothing can be said to go with it."""


def joint_turns(rotations: Array) -> Array:
    """Return the joint's rotation away from its mean, rad; (n, 3, 3) → (n, 3)."""
    turns = rotation_log(mean_rotation(rotations).T @ rotations)
    centred: Array = turns - turns.mean(axis=0)
    return centred


def joint_modes(rotations: Array) -> Array:
    """Return the joint's rotation away from its mean, over its rms; (n, 3, 3) → (n, 3)."""
    return modes_of(joint_turns(rotations))


def modes_of(turns: Array) -> Array:
    """Return a joint's turns, as `joint_turns` returns them, over their rms; (n, 3) → (n, 3)."""
    modes: Array = turns / max(float(np.sqrt((turns**2).sum(axis=1).mean() / 3)), STILL)
    return modes


def has_one_axis(turns: Array, blur: float) -> bool:
    """Return whether a joint turns about one axis alone, from its turns (n, 3) rad.

    Parameters
    ----------
    turns
        As `joint_turns` returns them.
    blur
        rad², variance of the rotation that noise and skin can feign: what turns farther than that
        about a second axis is a second axis, however small.
    """
    variances = np.linalg.eigvalsh(turns.T @ turns / len(turns))
    return bool(variances[1] < min(ONE_AXIS * variances[2], blur))


def main_axis(turning: Turning) -> tuple[Array, float]:
    """Return the axis a joint turns about most, and how far single rotations stray from it.

    Returns
    -------
    axis : (3,) unit vector in the seeing limb
    strays
        Mean square tangent of the angle between the axis and the one each pose turned about: of a
        hinge nearly 0, of a ball up to 1.
    """
    rotations = turning.rotations[turning.known]
    turns = joint_turns(rotations)
    values, vectors = np.linalg.eigh(turns.T @ turns)
    axis: Array = mean_rotation(rotations) @ vectors[:, 2]
    return axis, float(values[1] / values[2]) if values[2] > 0 else 1.0


def crowds(rotations: Array) -> Array:
    """Return how many poses lie within some `DENSE` of each pose, itself among them, (n,)."""
    flat = rotations.reshape(len(rotations), 9)
    crowd = np.empty(len(flat))
    for start in range(0, len(flat), BLOCK):
        rows = slice(start, start + BLOCK)
        near = flat[rows] @ flat.T
        near -= 3.0  # less nearly the angle's square
        np.minimum(near, 0.0, out=near)
        near /= 2 * DENSE**2
        crowd[rows] = np.exp(near, out=near).sum(axis=1)
    return crowd


def nearest_poses(rotations: Array) -> NDArray[np.int64]:
    """Return for each pose the index of the one most like it, (n,)."""
    return nearest(rotations.reshape(len(rotations), 9))


def nearest(flat: Array) -> NDArray[np.int64]:
    """Return for each row the index of the one nearest to it, (n, k) → (n,)."""
    two = np.asarray(KDTree(flat).query(flat, k=2)[1])
    itself = two[:, 0] == np.arange(len(flat))
    other: NDArray[np.int64] = np.where(itself, two[:, 1], two[:, 0])
    return other
