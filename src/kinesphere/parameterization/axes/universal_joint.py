"""Movement axes of a joint in free motion: no calibration, no phases."""

from itertools import product

import numpy as np
from scipy.optimize import least_squares

from kinesphere.data import Array
from kinesphere.geometry.rotations import mean_rotation, rotation_angle, tangent_basis
from kinesphere.parameterization.axes.free_motion import FreeMotion
from kinesphere.parameterization.axes.joint_kernels import constraint_residuals
from kinesphere.parameterization.axes.phase_log_pca import phase_log_pca
from kinesphere.parameterization.axes.processes import likeliest_axes, likeliest_with_rests
from kinesphere.parameterization.axes.spectra import sparsest_axes
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import AxesSettings

MOST_SAMPLES = 600  # evenly taken; more change nothing but the time
SCALE = 0.05  # rad, where the robust loss turns from square to linear
TWIST_SHARE = 0.9  # of a residual's variance that is put down to twist about the limb
NEAREST = 15  # samples that make the reference orientation
ENDS = 6  # of the descents from different starts, that are looked at more closely
SAME = np.cos(np.deg2rad(10.0))
SHORTEST = 15.0  # s of movement; less shows too little of what angles are like in time
Fit = tuple[Array, Array, float]
"""Proximal axis in the parent, distal axis in the child, cost."""


def universal_joint(samples: JointSamples, n_axes: int, settings: AxesSettings) -> Array:
    """Fit a universal joint: one axis fixed in the parent, one in the child, an angle between.

    Such a joint keeps ``xᵀ Q y = cos γ`` in every pose, with x the proximal axis in the parent and
    y the distal axis in the child. Sampson's residual of that constraint is minimized robustly
    from several starts. Twist about the limb is not part of such a joint: it acts as noise of its
    own direction, and much of it spoils the axes. The best few ends are therefore starts of
    `likeliest_axes`, which takes the twist as what it is, unless ``refine`` is off or the
    movement too short. From where that ends `sparsest_axes` takes the angles for rhythms, from
    there the processes have another try, and so have processes that rest in some movements, as in
    a calibration (`likeliest_with_rests`). What is likeliest counts. One-axis joints are left to
    the phase method.

    Returns
    -------
    (n_found, 3)
        Distal axis first. The distal axis is given where the limb is in its reference
        orientation (see `reference_rotation`).
    """
    if n_axes != 2 or not samples.phases:
        return phase_log_pca(samples, n_axes, settings)
    moving = np.concatenate([np.arange(a, b) for a, b in samples.phases])
    q = samples.rotations[moving]
    q = q[:: max(1, len(q) // MOST_SAMPLES)]
    if len(q) < 6:
        return np.empty((0, 3))
    reference = reference_rotation(samples)
    short = q[:: max(1, len(q) // 80)]
    starts = product(np.eye(3), repeat=2)
    tried = (_solve(short, x, reference.T @ a1, samples.long_axis, 12) for x, a1 in starts)
    found = sorted((fit for fit in tried if fit is not None), key=lambda fit: fit[2])
    ends = (_solve(q, x, y, samples.long_axis, 60) for x, y, _ in _distinct(found))
    axes = [np.stack([reference @ fit[1], fit[0]]) for fit in ends if fit is not None]
    if not axes:
        return np.empty((0, 3))
    if not settings.refine or len(moving) < SHORTEST / 2 * samples.rate:  # halves are shorter
        return axes[0]
    motion = free_motion_of(samples).thinned()
    smooth = likeliest_axes(motion, axes)
    fits = [smooth, sparsest_axes(motion, smooth.axes)]
    if fits[1].cost < smooth.cost:  # rhythms, or the first descent was caught in gimbal lock
        fits.append(likeliest_axes(motion, [fits[1].axes]))
    smooth = min(fits[::2], key=lambda fit: fit.cost)
    fits.append(likeliest_with_rests(motion, smooth))
    return min(fits, key=lambda fit: fit.cost).axes


def free_motion_of(samples: JointSamples) -> FreeMotion:
    """Return the moving frames of a joint as its likelihood takes them: before any smoothing."""
    moving = np.concatenate([np.arange(a, b) for a, b in samples.phases])
    at = moving if samples.frames is None else samples.frames[moving]
    # smoothing would hide from the likelihood what the errors of the poses are like
    measured = samples.rotations if samples.measured is None else samples.measured
    reference = reference_rotation(samples)
    return FreeMotion(measured[moving], at / samples.rate, samples.long_axis, reference)


def _distinct(fits: list[Fit]) -> list[Fit]:
    """Return the first few fits that differ by their axes."""
    kept: list[Fit] = []
    for fit in fits:
        alike = (abs(fit[0] @ k[0]) > SAME and abs(fit[1] @ k[1]) > SAME for k in kept)
        if len(kept) < ENDS and not any(alike):
            kept.append(fit)
    return kept


def reference_rotation(samples: JointSamples) -> Array:
    """Return the mean of the samples around the one nearest to the body-aligned pose, (3, 3)."""
    known = samples.rotations[np.isfinite(samples.rotations).all(axis=(1, 2))]
    nearest = known[rotation_angle(known).argmin()]
    apart = rotation_angle(known @ nearest.T)
    return mean_rotation(known[np.argsort(apart, kind="stable")[:NEAREST]])


def _solve(q: Array, x0: Array, y0: Array, long_axis: Array, steps: int) -> Fit | None:
    """Return x, y and the cost from one start; None if the axes became parallel.

    A residual's variance is that of noise about any axis, ``‖x × Q y‖²``, and of twist about the
    limb u, ``(x · Q (u × y))²``: frames that see little twist count more.
    """
    bases = tangent_basis(x0), tangent_basis(y0)

    def told(v: Array) -> Array:
        (x, dx), (y, dy) = (
            _moved(x0, v[:2] @ bases[0], bases[0]),
            _moved(y0, v[2:4] @ bases[1], bases[1]),
        )
        return constraint_residuals(q, x, y, dx, dy, long_axis, float(v[4]), TWIST_SHARE)

    def residuals(v: Array) -> Array:
        return told(v)[:, 0]

    def derivatives(v: Array) -> Array:
        return told(v)[:, 1:]

    start = np.array([0, 0, 0, 0, float(np.median(q @ y0 @ x0))])
    fit = least_squares(
        residuals,
        start,
        derivatives,
        loss="soft_l1",
        f_scale=SCALE,
        max_nfev=steps,
    )
    x, y = (
        _moved(v0, moved @ basis, basis)[0]
        for v0, moved, basis in zip((x0, y0), (fit.x[:2], fit.x[2:4]), bases, strict=True)
    )
    if abs(fit.x[4]) > np.cos(np.deg2rad(20.0)):
        return None
    return x, y, float(fit.cost)


def _moved(start: Array, step: Array, basis: Array) -> tuple[Array, Array]:
    """Return ``start + step`` of unit length, (3,), and its derivatives along a basis, (2, 3)."""
    v = start + step
    size = float(np.linalg.norm(v))
    v = v / size
    return v, (basis - np.outer(basis @ v, v)) / size
