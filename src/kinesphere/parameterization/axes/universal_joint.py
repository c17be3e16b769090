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
TWIST_SHARE = 0.9  # of a residual's variance that is put down to twist about the limb
NEAREST = 15  # samples that make the reference orientation


def universal_joint(samples: JointSamples, n_axes: int, settings: AxesSettings) -> Array:
    """Fit a universal joint: one axis fixed in the parent, one in the child, an angle between.

    Such a joint keeps ``xᵀ Q y = cos γ`` in every pose, with x the proximal axis in the parent and
    y the distal axis in the child. Sampson's residual of that constraint is minimized robustly
    from several starts. Twist about the limb is not part of the joint: it acts as noise of its
    own direction, and much of it spoils the axes. One-axis joints are left to the phase method.

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
    short = q[:: max(1, len(q) // 80)]
    starts = product(np.eye(3), repeat=2)
    tried = (_solve(short, x, reference.T @ a1, samples.long_axis, 12) for x, a1 in starts)
    found = [fit for fit in tried if fit is not None]
    if not found:
        return np.empty((0, 3))
    x, y, _ = min(found, key=lambda fit: fit[2])
    fit = _solve(q, x, y, samples.long_axis, 60)
    return np.empty((0, 3)) if fit is None else np.stack([reference @ fit[1], fit[0]])


def reference_rotation(samples: JointSamples) -> Array:
    """Return the mean of the samples around the one nearest to the body-aligned pose, (3, 3)."""
    known = samples.rotations[np.isfinite(samples.rotations).all(axis=(1, 2))]
    nearest = known[rotation_angle(known).argmin()]
    apart = rotation_angle(known @ nearest.T)
    return mean_rotation(known[np.argsort(apart, kind="stable")[:NEAREST]])


def _solve(
    q: Array, x0: Array, y0: Array, long_axis: Array, steps: int
) -> tuple[Array, Array, float] | None:
    """Return x, y and the cost from one start; None if the axes became parallel.

    A residual's variance is that of noise about any axis, ``‖x × Q y‖²``, and of twist about the
    limb u, ``(x · Q (u × y))²``: frames that see little twist count more.
    """
    bases = _tangent(x0), _tangent(y0)

    def split(v: Array) -> tuple[Array, Array]:
        x, y = x0 + bases[0] @ v[:2], y0 + bases[1] @ v[2:4]
        return x / np.linalg.norm(x), y / np.linalg.norm(y)

    def residuals(v: Array) -> Array:
        x, y = split(v)
        cosine = q @ y @ x
        twisting = q @ np.cross(long_axis, y) @ x
        variance = (1 - TWIST_SHARE) * np.maximum(1 - cosine**2, 1e-6) + TWIST_SHARE * twisting**2
        result: Array = (cosine - v[4]) / np.sqrt(variance)
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
