"""Rotations as matrices: about an axis, between directions, logarithm, mean. Arrays only."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]


def hat(vectors: Array) -> Array:
    """Return the skew matrices with ``hat(v) @ w = cross(v, w)``, (..., 3) → (..., 3, 3)."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    o = np.zeros_like(x)
    rows = [np.stack(row, axis=-1) for row in ((o, -z, y), (z, o, -x), (-y, x, o))]
    return np.stack(rows, axis=-2)


def rotation_about(axis: Array, angles: Array) -> Array:
    """Return rotations about one unit axis, (3,) and (...,) rad → (..., 3, 3); NaN stays NaN."""
    k = hat(axis)
    s, c = np.sin(angles)[..., None, None], np.cos(angles)[..., None, None]
    turned: Array = np.eye(3) + s * k + (1 - c) * (k @ k)
    return turned


def tangent_basis(axis: Array) -> Array:
    """Return two unit vectors perpendicular to a unit vector, (3,), and to each other, (2, 3)."""
    first = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(axis, first)])


def rotation_between(source: Array, target: Array) -> Array:
    """Return the least rotation that takes one unit vector to the other, (..., 3) → (..., 3, 3).

    Opposite vectors have no least rotation; they are turned about the coordinate axis farthest
    from them, made perpendicular.
    """
    source, target = np.broadcast_arrays(source, target)
    v = np.cross(source, target)
    c = (source * target).sum(axis=-1)[..., None, None]
    k = hat(v)
    with np.errstate(divide="ignore", invalid="ignore"):
        turned = np.eye(3) + k + (k @ k) / (1 + c)
    opposite = np.asarray(c[..., 0, 0] < -1 + 1e-12)
    if opposite.any():
        a = source[opposite]
        other = np.eye(3)[np.abs(a).argmin(axis=-1)]
        axis = np.cross(a, other)
        axis /= np.linalg.norm(axis, axis=-1, keepdims=True)
        turned[opposite] = 2 * axis[..., :, None] * axis[..., None, :] - np.eye(3)
    return np.asarray(turned)


def rotation_log(rotations: Array) -> Array:
    """Return rotation vectors in rad, (..., 3, 3) → (..., 3); NaN stays NaN."""
    flat = rotations.reshape(-1, 3, 3)
    known = np.isfinite(flat).all(axis=(1, 2))
    logs = np.full((len(flat), 3), np.nan)
    if known.any():
        logs[known] = Rotation.from_matrix(flat[known]).as_rotvec()
    return logs.reshape(rotations.shape[:-1])


def rotation_angle(rotations: Array) -> Array:
    """Return the angle of each rotation in rad, 0…π, (..., 3, 3) → (...,); NaN stays NaN."""
    axial = np.stack(
        [
            rotations[..., 2, 1] - rotations[..., 1, 2],
            rotations[..., 0, 2] - rotations[..., 2, 0],
            rotations[..., 1, 0] - rotations[..., 0, 1],
        ],
        axis=-1,
    )
    trace = np.trace(rotations, axis1=-2, axis2=-1)
    angle: Array = np.arctan2(np.linalg.norm(axial, axis=-1), trace - 1)
    return angle


def nearest_rotation(matrices: Array) -> Array:
    """Return the proper rotations closest to any matrices (chordal), (..., 3, 3) → (..., 3, 3)."""
    u, _, vt = np.linalg.svd(matrices)
    u[..., :, 2] *= np.linalg.det(u @ vt)[..., None]
    return np.asarray(u @ vt)


def mean_rotation(rotations: Array, weights: Array | None = None) -> Array:
    """Return the chordal mean on SO(3), (n, 3, 3) and optional (n,) weights → (3, 3).

    NaN entries are left out; ValueError if nothing is left.
    """
    known = np.isfinite(rotations).all(axis=(1, 2))
    if not known.any():
        raise ValueError("no rotation to average: all are NaN")
    w = np.ones(len(rotations)) if weights is None else weights
    return nearest_rotation(np.einsum("n,nij->ij", w[known], rotations[known]))
