"""What noise in orientations feigns: motion, and a centre drawn to where noise moves points least.

An orientation that shakes makes a limb seem to turn. Least squares take that for motion, too: they
seem to know a centre along the axis of a hinge, and place it where noise moves points least, near
the limbs' own markers. The share is known from the noise of the poses, and is taken off again, as
in corrected scores for errors in variables (Nakamura 1990, doi:10.1093/biomet/77.1.127).
"""

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.centre_views import Turning, View
from kinesphere.geometry.rotations import hat

Array = NDArray[np.float64]

DOUBT = 0.5
"""Relative standard deviation of what is known of the shake's size."""
SILENT = 1e-12
"""Share of the largest eigenvalue of information below which a direction tells nothing."""
_ARMS = np.concatenate([-hat(np.eye(3)), np.zeros((3, 3, 3))], axis=2)
_STILL = np.concatenate([np.zeros((3, 3)), np.eye(3)], axis=1)


def find_shake(
    view: View, turning: Turning, x: Array, whitening: Array, weights: Array
) -> tuple[Array, Array]:
    """Return what shaking orientations feign: information (3, 3) and gradient (3,) by the centre.

    They are the derivatives of half the squares that the noise of both poses adds to the residuals,
    ``½ Σ w tr(Wᵀ W C(x))``.

    Parameters
    ----------
    x : (3,) m
        The centre, in the seeing limb.
    whitening : (3, 3) 1/m
        W, what residuals are multiplied with.
    weights : (n,)
        w of each pose.
    """
    back = turning.back
    metric = whitening.T @ whitening
    square, linear = _noise_gradient(metric, turning.pose)
    weighed = back * weights[:, None, None]
    n = len(back)
    # Σ w Bₖᵢ Bₗⱼ: all of the frames that either sum needs
    products = (weighed.reshape(n, 9).T @ back.reshape(n, 9)).reshape(3, 3, 3, 3)
    shake = np.einsum("kilj,kl->ij", products, square)
    drawn = (turning.place(x) @ square + linear).ravel() @ weighed.reshape(-1, 3)
    carried = np.einsum("kilj,kl->ij", products, metric)
    square, linear = _noise_gradient(carried, view.pose)
    return shake + square, drawn + square @ x + linear


def clear_of_shake(told: Array, shake: Array, doubt: Array) -> tuple[Array, Array]:
    """Return information without what is feigned, and how much a gradient then says.

    With ``curve, heard = clear_of_shake(...)`` and the gradient less ``drawn``, a step is to solve
    ``(prior + heard @ curve) step = -(pull of the prior + heard @ gradient)``; ``heard @ curve`` is
    the information. It is the sandwich of the corrected score: the curve is less by the shake,
    the score's variance is not, and grows by what is not known of the shake. Where there is nothing
    but shake, nothing is heard, and there is no threshold at which that begins.

    Parameters
    ----------
    told : (3, 3) 1/m²
        Information of the residuals, shake and all.
    shake : (3, 3) 1/m²
        As `find_shake` returns it.
    doubt : (3, 3) 1/m²
        Variance that is added to the gradient as the shake is not known well: see `doubt_of`.
    """
    values, vectors = np.linalg.eigh(told)
    sizes = np.sqrt(np.maximum(values, max(SILENT * values[2], 1e-300)))
    root, inverse = vectors * sizes, vectors / sizes
    left, axes = np.linalg.eigh(np.eye(3) - inverse.T @ shake @ inverse)
    # in units in which told is one
    curve = (axes * np.maximum(left, 0.0)) @ axes.T
    heard = np.linalg.solve(np.eye(3) + inverse.T @ doubt @ inverse, curve).T
    return root @ curve @ root.T, root @ heard @ inverse.T


def doubt_of(shake: Array, drawn: Array, prior: Array) -> Array:
    """Return the variance of a gradient that is free of shake known within `DOUBT` of its size.

    Parameters
    ----------
    shake : (3, 3) 1/m²
    drawn : (3,) 1/m
        The gradient by the shake at the expected centre.
    prior : (3, 3) 1/m²
        How firmly the centre is expected there: what is drawn where it is may differ.
    """
    return DOUBT**2 * (np.outer(drawn, drawn) + shake @ np.linalg.solve(prior, shake))


def _noise_gradient(metric: Array, pose: Array) -> tuple[Array, Array]:
    """Return q, l: half the gradient of tr(metric · point_covariance(pose, p)) by p is q p + l."""
    moved = metric @ _ARMS @ pose  # (3, 3, 6)
    return np.einsum("iab,jab->ij", moved, _ARMS), np.einsum("iab,ab->i", moved, _STILL)
