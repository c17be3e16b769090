"""The rotation about the limb's own long axis (paper section 4.5)."""

import numpy as np

from kinesphere.data import Array


def closed_twist(model: Array, actual: Array, long_axis: Array) -> Array:
    """Return the twist that best takes the model orientation to the actual one.

    The answer the paper leaves open: ``Σ ‖R(u, τ) aₖ − bₖ‖²`` over the columns of the two is least
    at ``τ = atan2(u·v(N), tr N − uᵀ N u)``, N = modelᵀ · actual seen in the limb, v its axial
    vector (the twist of a swing-twist decomposition). It is least in the geodesic sense too,
    for both grow with the trace.

    Parameters
    ----------
    model, actual : (n, 3, 3)
    long_axis : (3,)
        Unit vector in the child frame.

    Returns
    -------
    (n,) rad
        0 where every twist is as good as any other; NaN where an orientation is.
    """
    n = np.swapaxes(model, -1, -2) @ actual
    axial = np.stack(
        [n[:, 2, 1] - n[:, 1, 2], n[:, 0, 2] - n[:, 2, 0], n[:, 1, 0] - n[:, 0, 1]], axis=1
    )
    along = np.einsum("i,nij,j->n", long_axis, n, long_axis)
    twist: Array = np.arctan2(axial @ long_axis, np.trace(n, axis1=1, axis2=2) - along)
    return twist


def sampled_twist(model: Array, actual: Array, long_axis: Array, step: float) -> Array:
    """Return the best of evenly sampled twists, as the paper does it.

    Parameters
    ----------
    model, actual : (n, 3, 3)
    long_axis : (3,)
    step
        rad between samples; rounded so that a full turn holds a whole number of them.

    Returns
    -------
    (n,) rad
        Least in the sum of the angles between the three pairs of axes.
    """
    count = max(2, round(2 * np.pi / step))
    n = np.swapaxes(actual, -1, -2) @ model  # the model's axes seen from the actual limb
    best, twist = np.full(len(model), np.inf), np.full(len(model), np.nan)
    # column k of n R(u, τ) has k-th entry cosine, so only three diagonals are needed
    k = np.array(
        [
            [0, -long_axis[2], long_axis[1]],
            [long_axis[2], 0, -long_axis[0]],
            [-long_axis[1], long_axis[0], 0],
        ]
    )
    plain, first, second = (np.diagonal(n @ m, axis1=1, axis2=2) for m in (np.eye(3), k, k @ k))
    for tau in np.linspace(-np.pi, np.pi, count, endpoint=False) + 2 * np.pi / count:
        cosines = plain + np.sin(tau) * first + (1 - np.cos(tau)) * second
        total = np.arccos(np.clip(cosines, -1, 1)).sum(axis=1)
        better = total < best
        best[better], twist[better] = total[better], tau
    return twist
