"""A centre by distances and orientation: the way down to the point that stays where it is."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.centre_terms import find_terms
from kinesphere.geometry.centre_views import View

Array = NDArray[np.float64]

ROUNDING = 1e-15
"""Share of the largest eigenvalue below which there is nothing but rounding."""
SETTLED = 1e-6
"""m, step of the descent that ends it."""


def mean_residual(view: View, x: Array) -> float:
    """Return how badly a start fits: the mean size of the residuals."""
    off = [
        np.abs(term.residual if term.seen is None else term.residual[term.seen]).ravel()
        for term in find_terms(view, x)
    ]
    return float(np.mean(np.concatenate(off))) if off else 0.0


def descend(
    view: View, x: Array, expected: Array, prior: Array, looks: float, rounds: int
) -> Array:
    """Return the centre, (3,), by Gauss-Newton; weights and scales follow the current point."""
    for _ in range(rounds):
        hessian, gradient = prior, prior @ (x - expected)
        for term in find_terms(view, x):
            scale, w, count = term.scales()
            share = w * (looks / count / scale**2)
            jacobian = term.jacobian.reshape(-1, 3)
            weighed = (term.jacobian * share[..., None, None]).reshape(-1, 3)
            hessian = hessian + weighed.T @ jacobian
            gradient = gradient + weighed.T @ term.residual.ravel()
        values, vectors = np.linalg.eigh(hessian)
        # without noise one direction may weigh 10¹⁶ times another: rounding must not divide by zero
        step = -vectors @ (vectors.T @ gradient / np.maximum(values, ROUNDING * values[2]))
        length = float(np.linalg.norm(step))
        x = x + step * min(1.0, 0.05 / max(length, 1e-12))
        if length < SETTLED:
            break
    return x
