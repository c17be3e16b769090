"""What the poses of a limb say of points and of other limbs, frame by frame. Arrays only."""

import numba
import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.poses import misfits_kernel, place_kernel, relative_kernel

Array = NDArray[np.float64]


def place(rotations: Array, shifts: Array, point: Array) -> Array:
    """Return a fixed point of a moving frame in the world, (n, 3, 3), (n, 3), (3,) m → (n, 3) m.

    What `kinesphere.geometry.rigid.out_of_frame` does for many points; arrays need not be in a
    row, as one limb's poses among those of all are not. NaN stays NaN.
    """
    placed = np.empty((len(rotations), 3))
    place_kernel(rotations, shifts, np.ascontiguousarray(point), placed)
    return placed


def relative_rotations(parents: Array, children: Array) -> Array:
    """Return ``parent_from_child``, (..., 3, 3) ``world_from_limb`` each → (..., 3, 3).

    In a tenth of the time of a product of stacks; arrays need not be in a row. NaN stays NaN.
    """
    if getattr(numba.config, "DISABLE_JIT", False):  # uncompiled, the kernel takes very long
        return np.asarray(np.swapaxes(parents, -1, -2) @ children)
    rows, relative = (-1, 3, 3), np.empty(children.shape)
    parents = np.broadcast_to(parents, children.shape).reshape(rows)
    relative_kernel(parents, children.reshape(rows), relative.reshape(rows))
    return relative


def misfits(rotations: Array, shifts: Array, shape: Array, points: Array) -> Array:
    """Return the rms distance of points from where poses put them, (n,) m.

    Parameters
    ----------
    rotations, shifts : (n, 3, 3), (n, 3) m
        ``world_from_shape``; NaN where unknown.
    shape : (n_points, 3) m
    points : (n, n_points, 3) m
        NaN where not seen: such points count for nothing, and where none counts it is NaN.
    """
    found = np.empty(len(points))
    misfits_kernel(rotations, shifts, np.ascontiguousarray(shape), points, found)
    return found
