"""Rigid motions as exponentials of twists, and the lines they are to bring points to."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.rotations import hat

Array = NDArray[np.float64]

_NO_TURN = 1e-12  # rad; below it a twist is a translation


def twist_exp(twists: Array) -> Array:
    """Return the rigid motions of twists, (..., 6) → (..., 4, 4).

    Rosenhahn et al. 2006, equations 5 to 9, by Rodrigues' formula. The angle is the length of the
    rotational part; where that is zero the motion is a translation.

    Parameters
    ----------
    twists : (..., 6)
        θv in m, then θω in rad.
    """
    v, w = twists[..., :3], twists[..., 3:]
    angle = np.linalg.norm(w, axis=-1)[..., None, None]
    k = hat(w)
    safe = np.maximum(angle, _NO_TURN)
    with_sine = np.where(angle > _NO_TURN, np.sin(safe) / safe, 1.0)
    with_cosine = np.where(angle > 1e-5, (1 - np.cos(safe)) / safe**2, 0.5)
    rest = np.where(angle > 1e-3, (safe - np.sin(safe)) / safe**3, 1 / 6 - angle**2 / 120)
    motion = np.zeros((*twists.shape[:-1], 4, 4))
    motion[..., :3, :3] = np.eye(3) + with_sine * k + with_cosine * (k @ k)
    # (I - R)(ω × v) + ω ωᵀ v θ for a unit ω, in a form that holds down to no turn at all
    reach = np.eye(3) + with_cosine * k + rest * (k @ k)
    motion[..., :3, 3] = (reach @ v[..., None])[..., 0]
    motion[..., 3, 3] = 1.0
    return motion


def joint_twists(axes: Array, points: Array) -> Array:
    """Return the twists of joints: screws without pitch about axes through points.

    Parameters
    ----------
    axes : (..., 3)
        Unit vectors.
    points : (..., 3) m
        Any point of each axis.
    """
    return np.concatenate([-np.cross(axes, points), axes], axis=-1)


def incidence(points: Array, directions: Array, moments: Array) -> Array:
    """Return how far points are from Plücker lines, as X × n − m, (..., 3) m.

    Zero where the point lies on the line (equation 10); else perpendicular to the line and as long
    as the distance.
    """
    x, y, z = points[..., 0], points[..., 1], points[..., 2]
    u, v, w = directions[..., 0], directions[..., 1], directions[..., 2]
    # as np.cross, at a fifth of its cost
    return np.asarray(np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=-1) - moments)
