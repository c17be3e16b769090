"""The point two limbs share, by linear equations: fast, and biased by noise."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STILL = 1e-6
"""m, motion below which a marker says nothing: rounding is all there is."""


def score_centre(
    rotations: Array, shifts: Array, ridge: float = 1e-3
) -> tuple[Array, Array, float]:
    """Return the common point of two bodies in both frames, and its rms disagreement.

    Minimises ``Σ |c_parent - R c_child - t|²`` (SCoRE [1]_, here in the parent's frame) with a
    ridge that draws both towards their origins where the motion says nothing.

    Parameters
    ----------
    rotations, shifts : (n_frames, 3, 3), (n_frames, 3) m
        ``parent_from_child``; frames with NaN take no part.
    ridge
        As a share of the number of frames.

    Returns
    -------
    in_parent, in_child : (3,) m
    rms : m

    References
    ----------
    .. [1] Ehrig et al. (2006), J. Biomech. 39(15), 2798-2809, doi:10.1016/j.jbiomech.2005.10.002.
    """
    known = np.isfinite(rotations).all(axis=(1, 2)) & np.isfinite(shifts).all(axis=1)
    r, t = rotations[known], shifts[known]
    n = len(r)
    if n == 0:
        return np.full(3, np.nan), np.full(3, np.nan), np.inf
    a = np.concatenate([np.broadcast_to(np.eye(3), (n, 3, 3)), -r], axis=2)
    normal = np.einsum("nki,nkj->ij", a, a) + ridge * n * np.eye(6)
    c = np.linalg.solve(normal, np.einsum("nki,nk->i", a, t))
    rms = float(np.sqrt(((a @ c - t) ** 2).sum(axis=1).mean()))
    return c[:3], c[3:], rms


def sphere_centre(points: Array, expected: Array, ridge: float = 1e-4) -> Array:
    """Return the common centre of the spheres that points move on, algebraically.

    Gamage and Lasenby's linear equations [1]_, with a small pull towards the expected centre where
    the motion leaves it free.

    Parameters
    ----------
    points : (n_frames, n_points, 3) m
        NaN where not seen.
    expected : (3,) m
    ridge
        Weight of the pull as a share of the points' widest motion.

    References
    ----------
    .. [1] Gamage & Lasenby (2002), J. Biomech. 35(1), 87-93, doi:10.1016/S0021-9290(01)00160-9.
    """
    normal, right = np.zeros((3, 3)), np.zeros(3)
    for seen in np.moveaxis(points, 1, 0) - expected:
        y = seen[np.isfinite(seen).all(axis=1)]
        if len(y) < 2:
            continue
        centred = y - y.mean(axis=0)
        normal += 2 * centred.T @ centred
        right += centred.T @ (y**2).sum(axis=1)
    widest = np.linalg.eigvalsh(normal)[2]
    if widest < STILL**2:
        return expected
    normal += ridge * widest * np.eye(3)
    centre: Array = expected + np.linalg.solve(normal, right)
    return centre
