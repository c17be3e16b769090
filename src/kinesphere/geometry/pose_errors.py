"""How uncertain a rigid fit is, and what its pose carries."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.rotations import hat

Array = NDArray[np.float64]

POSED = 3
"""Points that tell a pose."""


def pose_covariance(shape: Array, noise: Array) -> Array:
    """Return how uncertain a rigid fit's pose is, from the noise of its points.

    Parameters
    ----------
    shape : (n_points, 3) m
        A point that is NaN tells nothing.
    noise : (n_points,) m, standard deviation of each point in every direction.

    Returns
    -------
    (6, 6)
        Of a small turn (rad) about the shape's origin and a shift (m), both in the shape's frame;
        the inverse of the weighted least-squares normal matrix.
    """
    return _inverse(_information(shape, noise))


def _information(shape: Array, noise: Array) -> Array:
    known = np.isfinite(shape).all(axis=1)
    shape, noise = shape[known], noise[known]
    moved = np.concatenate([-hat(shape), np.broadcast_to(np.eye(3), (len(shape), 3, 3))], axis=2)
    information: Array = np.einsum("pki,p,pkj->ij", moved, 1 / noise**2, moved)
    return information


def _inverse(information: Array) -> Array:
    return np.asarray(np.linalg.pinv(information, hermitian=True, rcond=1e-12))


def mean_pose_covariance(shape: Array, noise: Array, seen: NDArray[np.bool_]) -> Array:
    """Return how uncertain poses are on average that some of the points tell each, (6, 6).

    Of four points in a square, three shake by more than four; of those nearly on a line, by far
    more. Frames that tell no pose are left out; where none does, all points tell it.

    Parameters
    ----------
    shape, noise
        As `pose_covariance` takes them.
    seen : (n_frames, n_points)
    """
    each, times = _of_sets(shape, noise, seen)
    mean: Array = np.average([_inverse(one) for one in each], axis=0, weights=times)
    return mean


def usual_pose_covariance(shape: Array, noise: Array, seen: NDArray[np.bool_]) -> Array:
    """Return the same by the mean of what poses tell: the inverse of their information's, (6, 6).

    As `mean_pose_covariance`, but a few frames in which little tells a pose hardly count: what
    weighs all frames alike should suit those that tell most.
    """
    each, times = _of_sets(shape, noise, seen)
    return _inverse(np.average(each, axis=0, weights=times))


def _of_sets(shape: Array, noise: Array, seen: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Return what poses by each set of points that tells one know, (n, 6, 6), and how often."""
    if len(seen) and seen.all():  # as most often: nothing to sort
        sets, times = seen[:1], np.ones(1, dtype=np.intp)
    else:
        sets, times = np.unique(seen, axis=0, return_counts=True)
    enough = (sets & np.isfinite(shape).all(axis=1)).sum(axis=1) >= POSED
    sets, times = sets[enough], times[enough]
    if not len(sets):
        sets, times = np.ones((1, len(shape)), dtype=np.bool_), np.ones(1, dtype=times.dtype)
    each = np.array([_information(shape[one], noise[one]) for one in sets])
    return each, times.astype(np.float64)


def point_covariance(pose: Array, points: Array) -> Array:
    """Return the covariance that a pose's uncertainty gives to points it carries.

    Parameters
    ----------
    pose : (6, 6)
        As `pose_covariance` returns it.
    points : (..., 3) m in the shape's frame.

    Returns
    -------
    (..., 3, 3) m²
    """
    moved = np.concatenate(
        [-hat(points), np.broadcast_to(np.eye(3), (*points.shape[:-1], 3, 3))], axis=-1
    )
    covariance: Array = moved @ pose @ np.swapaxes(moved, -1, -2)
    return covariance
