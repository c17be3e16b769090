"""Movement axes of a joint in free motion: no calibration, no phases."""

from itertools import product

import numpy as np
from scipy.optimize import least_squares

from kinesphere.data import Array
from kinesphere.geometry.rotations import mean_rotation, rotation_angle
from kinesphere.parameterization.axes.phase_log_pca import phase_log_pca
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import AxesSettings

MOST_SAMPLES = 600  # evenly taken; more change nothing but the time
SCALE = 0.05  # rad, where the robust loss turns from square to linear
NEAREST = 15  # samples that make the reference orientation


def universal_joint(samples: JointSamples, n_axes: int, settings: AxesSettings) -> Array:
    """Fit a universal joint: one axis fixed in the parent, one in the child, an angle between.

    Such a joint keeps ``xᵀ Q y = cos γ`` in every pose, with x the proximal axis in the parent and
    y the distal axis in the child. Sampson's residual of that constraint is minimized robustly
    from several starts. Twist about the limb is not part of the joint: it acts as noise. One-axis
    joints are left to the phase method.

    Returns
    -------
    (n_found, 3)
        Distal axis first. The distal axis is given where the limb is in its reference
        orientation (see `reference_rotation`).
    """
    if n_axes != 2 or not samples.phases:
        return phase_log_pca(samples, n_axes, settings)
    q = np.concatenate([samples.rotations[a:b] for a, b in samples.phases])
    q = q[:: max(1, len(q) // MOST_SAMPLES)]
    if len(q) < 6:
        return np.empty((0, 3))
    reference = reference_rotation(samples)
    best, best_cost = None, np.inf
    starts = list(product(np.eye(3), repeat=2))
    short = q[:: max(1, len(q) // 80)]
    for x, a1 in starts:
        fit = _solve(short, x, reference.T @ a1, 12)
        if fit is not None and fit[2] < best_cost:
            best, best_cost = fit, fit[2]
    if best is None or (fit := _solve(q, best[0], best[1], 60)) is None:
        return np.empty((0, 3))
    x, y, _ = fit
    return np.stack([reference @ y, x])


def reference_rotation(samples: JointSamples) -> Array:
    """Return the mean of the samples around the one nearest to the body-aligned pose, (3, 3)."""
    known = samples.rotations[np.isfinite(samples.rotations).all(axis=(1, 2))]
    nearest = known[rotation_angle(known).argmin()]
    apart = rotation_angle(known @ nearest.T)
    return mean_rotation(known[np.argsort(apart, kind="stable")[:NEAREST]])


def _solve(q: Array, x0: Array, y0: Array, steps: int) -> tuple[Array, Array, float] | None:
    """Return x, y and the cost from one start; None if the axes became parallel."""
    bases = _tangent(x0), _tangent(y0)

    def split(v: Array) -> tuple[Array, Array]:
        x, y = x0 + bases[0] @ v[:2], y0 + bases[1] @ v[2:4]
        return x / np.linalg.norm(x), y / np.linalg.norm(y)

    def residuals(v: Array) -> Array:
        x, y = split(v)
        distal = q @ y
        cosine = distal @ x
        sine = np.sqrt(np.maximum(1 - cosine**2, 1e-6))
        result: Array = (cosine - v[4]) / sine
        return result

    start = np.array([0, 0, 0, 0, float(np.median(q @ y0 @ x0))])
    fit = least_squares(residuals, start, loss="soft_l1", f_scale=SCALE, max_nfev=steps)
    x, y = split(fit.x)
    if abs(fit.x[4]) > np.cos(np.deg2rad(20.0)):
        return None
    return x, y, float(fit.cost)


def _tangent(v: Array) -> Array:
    """Return two unit vectors perpendicular to v and each other, (3, 2)."""
    first = np.cross(v, np.eye(3)[np.abs(v).argmin()])
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(v, first)], axis=1)
