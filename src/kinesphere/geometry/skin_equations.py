"""The equations of a joint's centre and of what skin does to both limbs' poses with the joint."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.centre_views import Turning, View
from kinesphere.geometry.pose_errors import point_covariance
from kinesphere.geometry.rotations import hat
from kinesphere.kernels.skin_columns import skin_columns_kernel

Array = NDArray[np.float64]


class Skin(NamedTuple):
    """What goes with the joint."""

    modes: Array
    """(n, k): three, or none where the joint is a hinge."""
    seeing: Array
    """(6, 6) square root of the covariance of what it does to the seeing limb's pose."""
    turning: Array
    """(6, 6) the same of the turning limb's."""


def equations(
    view: View, turning: Turning, x: Array, inner: Array, skin: Skin
) -> tuple[Array, Array, Array]:
    """Return residuals (n, 3) over their noise, and their derivatives (n, 3, 6 + 12 k).

    By the centre in either limb, and by the maps from the joint's rotation to their poses' errors.
    """
    n, k = skin.modes.shape
    products = turning.means[1]
    carried = (products @ point_covariance(view.pose, x).ravel()).reshape(3, 3)
    noise = point_covariance(turning.pose, inner) + carried + turning.noise**2 * np.eye(3)
    values, vectors = np.linalg.eigh(noise)
    w = (vectors / np.sqrt(np.maximum(values, turning.noise**2))) @ vectors.T
    back = w @ turning.back
    columns = np.empty((n, 3, 6 + 12 * k))
    columns[:, :, :3] = back
    columns[:, :, 3:6] = -w
    if k:
        seeing = np.concatenate([-hat(x), np.eye(3)], axis=1) @ skin.seeing
        own = np.concatenate([-hat(inner), np.eye(3)], axis=1) @ skin.turning
        skin_columns_kernel(back @ seeing, -(w @ own), skin.modes, columns[:, :, 6:])
    return (turning.place(x) - inner) @ w.T, columns, w


def root_of(covariance: Array) -> Array:
    """Return R with R Rᵀ = the covariance, (k, k)."""
    values, vectors = np.linalg.eigh(covariance)
    root: Array = vectors * np.sqrt(np.maximum(values, 0.0))
    return root
