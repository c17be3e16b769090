"""Poses of one limb in many frames, straight from the arrays of all limbs: no copies on the way."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel


@kernel
def place_kernel(
    rotations: NDArray[np.float64],
    shifts: NDArray[np.float64],
    point: NDArray[np.float64],
    placed: NDArray[np.float64],
) -> None:
    """Write where a fixed point of a moving frame is in the world.

    Parameters
    ----------
    rotations, shifts : (n, 3, 3), (n, 3) m
        ``world_from_frame``; NaN gives NaN.
    point : (3,) m
    placed : (n, 3) m
        Written.
    """
    x, y, z = point[0], point[1], point[2]
    for f in range(len(rotations)):
        for i in range(3):
            turned = rotations[f, i, 0] * x + rotations[f, i, 1] * y + rotations[f, i, 2] * z
            placed[f, i] = turned + shifts[f, i]


@kernel
def relative_kernel(
    parents: NDArray[np.float64], children: NDArray[np.float64], relative: NDArray[np.float64]
) -> None:
    """Write ``parent_from_child`` of two limbs.

    Parameters
    ----------
    parents, children : (n, 3, 3)
        ``world_from_limb``; NaN gives NaN.
    relative : (n, 3, 3)
        Written.
    """
    for f in range(len(relative)):
        for i in range(3):
            for k in range(3):
                relative[f, i, k] = (
                    parents[f, 0, i] * children[f, 0, k]
                    + parents[f, 1, i] * children[f, 1, k]
                    + parents[f, 2, i] * children[f, 2, k]
                )


@kernel
def misfits_kernel(
    rotations: NDArray[np.float64],
    shifts: NDArray[np.float64],
    shape: NDArray[np.float64],
    points: NDArray[np.float64],
    misfits: NDArray[np.float64],
) -> None:
    """Write the rms distance of points from where poses put them.

    Parameters
    ----------
    rotations, shifts : (n, 3, 3), (n, 3) m
        ``world_from_shape``; NaN where unknown.
    shape : (n_points, 3) m
    points : (n, n_points, 3) m
        NaN where not seen: such points count for nothing.
    misfits : (n,) m
        Written; NaN where no point counts.
    """
    for f in range(len(points)):
        total, count = 0.0, 0
        for p in range(len(shape)):
            square = 0.0
            for i in range(3):
                off = points[f, p, i] - shifts[f, i]
                for k in range(3):
                    off -= rotations[f, i, k] * shape[p, k]
                square += off * off
            if not np.isnan(square):
                total += square
                count += 1
        misfits[f] = np.sqrt(total / count) if count else np.nan
