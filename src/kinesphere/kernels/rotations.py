"""Rotations of many frames: as quaternions, as rotation vectors, turned about an axis."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

_SMALL = 1e-3  # rad; below it the ratio of an angle to its half's sine is a series


@kernel
def quaternions_kernel(rotations: NDArray[np.float64], quaternions: NDArray[np.float64]) -> None:
    """Write the unit quaternion (x, y, z, w) of every rotation, of either sign.

    From the largest of the diagonal and the trace, so that nothing small is divided by.

    Parameters
    ----------
    rotations : (n, 3, 3)
        NaN gives NaN.
    quaternions : (n, 4)
        Written.

    References
    ----------
    Shepperd (1978), J. Guidance and Control 1(3), 223-224, doi:10.2514/3.55767b.
    """
    for f in range(len(rotations)):
        m = rotations[f]
        q = quaternions[f]
        trace = m[0, 0] + m[1, 1] + m[2, 2]
        largest = 3
        best = trace
        for i in range(3):
            if m[i, i] > best:
                largest = i
                best = m[i, i]
        if largest == 3:
            q[0] = m[2, 1] - m[1, 2]
            q[1] = m[0, 2] - m[2, 0]
            q[2] = m[1, 0] - m[0, 1]
            q[3] = 1.0 + trace
        else:
            i = largest
            j = (i + 1) % 3
            k = (i + 2) % 3
            q[i] = 1.0 - trace + 2.0 * m[i, i]
            q[j] = m[j, i] + m[i, j]
            q[k] = m[k, i] + m[i, k]
            q[3] = m[k, j] - m[j, k]
        norm = np.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
        for i in range(4):
            q[i] /= norm


@kernel
def rotation_vectors_kernel(quaternions: NDArray[np.float64], vectors: NDArray[np.float64]) -> None:
    """Write the rotation vector in rad of every unit quaternion, of length 0 to π.

    Parameters
    ----------
    quaternions : (n, 4)
        x, y, z, w of either sign; NaN gives NaN.
    vectors : (n, 3)
        Written.
    """
    for f in range(len(quaternions)):
        q = quaternions[f]
        sine = np.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2])
        angle = 2.0 * np.arctan2(sine, abs(q[3]))
        if angle <= _SMALL:
            square = angle * angle
            scale = 2.0 + square / 12.0 + 7.0 * square * square / 2880.0
        else:
            scale = angle / np.sin(angle / 2.0)
        if q[3] < 0.0:
            scale = -scale
        for i in range(3):
            vectors[f, i] = scale * q[i]


@kernel
def turn_kernel(
    axis: NDArray[np.float64], angles: NDArray[np.float64], rotations: NDArray[np.float64]
) -> None:
    """Turn every rotation about one axis, in place: Rodrigues' formula on each column.

    Parameters
    ----------
    axis : (3,)
        Unit vector.
    angles : (n,) rad
    rotations : (n, 3, 3)
    """
    x, y, z = axis[0], axis[1], axis[2]
    for f in range(len(rotations)):
        s, c = np.sin(angles[f]), np.cos(angles[f])
        for k in range(3):
            p, q, r = rotations[f, 0, k], rotations[f, 1, k], rotations[f, 2, k]
            along = (1.0 - c) * (x * p + y * q + z * r)
            rotations[f, 0, k] = c * p + s * (y * r - z * q) + along * x
            rotations[f, 1, k] = c * q + s * (z * p - x * r) + along * y
            rotations[f, 2, k] = c * r + s * (x * q - y * p) + along * z


@kernel
def tangents_kernel(axis: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return two unit vectors perpendicular to a unit vector, (3,), and to each other, (2, 3)."""
    tangents = np.zeros((2, 3))
    least = np.argmin(np.abs(axis))
    i, j = (least + 1) % 3, (least + 2) % 3
    size = np.sqrt(axis[i] ** 2 + axis[j] ** 2)
    tangents[0, i] = axis[j] / size
    tangents[0, j] = -axis[i] / size
    for k in range(3):
        after, last = (k + 1) % 3, (k + 2) % 3
        tangents[1, k] = axis[after] * tangents[0, last] - axis[last] * tangents[0, after]
    return tangents
