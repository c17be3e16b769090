"""Points that ride on several limbs at once. Arrays only."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.rotations import quaternions_from_rotations
from kinesphere.kernels.skinning import dual_quaternion_kernel, linear_blend_kernel

Array = NDArray[np.float64]


def linear_blend(
    vertices: Array, limbs: NDArray[np.intp], shares: Array, matrices: Array, shifts: Array
) -> Array:
    """Return vertices moved by the weighted mean of their limbs' maps.

    Parameters
    ----------
    vertices : (n_vertices, 3) m
        As bound.
    limbs, shares : (n_vertices, n_shares)
        Which limbs carry each vertex, and how much of it; shares add up to 1.
    matrices, shifts : (n_frames, n_limbs, 3, 3), (n_frames, n_limbs, 3) m
        ``matrices @ p + shifts`` is where a limb takes a bound point: any linear map.

    Returns
    -------
    (n_frames, n_vertices, 3) m
        NaN where a limb that carries the vertex is.
    """
    moved = np.empty((len(matrices), len(vertices), 3))
    linear_blend_kernel(*_contiguous(vertices, limbs, shares, matrices, shifts), moved)
    return moved


def dual_quaternion_blend(
    vertices: Array, limbs: NDArray[np.intp], shares: Array, rotations: Array, shifts: Array
) -> Array:
    """Return vertices moved by the blended screw of their limbs; parameters as `linear_blend`.

    Limbs turn by rotations only. Unlike the linear blend it keeps what twists from collapsing
    (Kavan et al. 2008, doi:10.1145/1409625.1409627).
    """
    moved = np.empty((len(rotations), len(vertices), 3))
    quaternions = quaternions_from_rotations(np.asarray(rotations))
    dual_quaternion_kernel(*_contiguous(vertices, limbs, shares, quaternions, shifts), moved)
    return moved


def _contiguous(
    vertices: Array, limbs: NDArray[np.intp], shares: Array, turns: Array, shifts: Array
) -> tuple[Array, NDArray[np.intp], Array, Array, Array]:
    v, s, r, t = (
        np.ascontiguousarray(array, dtype=np.float64) for array in (vertices, shares, turns, shifts)
    )
    return v, np.ascontiguousarray(limbs, dtype=np.intp), s, r, t
