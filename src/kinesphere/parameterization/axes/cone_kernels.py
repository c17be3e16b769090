"""What an axis leaves of every frame, and the equations of a better one: inner loops.

Written over frames: in plain Python they are hardly slower than compiled.
"""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.kernels.jit import kernel
from kinesphere.kernels.rotations import tangents_kernel

STEP = 1e-5  # rad, of the numerical derivative
FLOOR = float(np.deg2rad(1e-4))  # a spread below this is rounding, not noise
NORMAL_MAD = 1.4826


@kernel
def errors_about(axis: Array, vectors: Array, numbers: Array) -> tuple[Array, Array, Array]:
    """Return colatitude, twist and azimuth of every frame about an axis, (n,) rad each.

    Parameters
    ----------
    axis : (3,)
    vectors : (5, 3, n)
        Direction of the limb, its mean, the quaternion's vector; mean × direction and
        direction × vector.
    numbers : (3, n)
        The quaternion's scalar; direction · mean and direction · vector.
    """
    a, b, c = axis[0], axis[1], axis[2]
    p, r, v, across, crossed = vectors[0], vectors[1], vectors[2], vectors[3], vectors[4]
    scalar, along, turned = numbers[0], numbers[1], numbers[2]
    p_a = a * p[0] + b * p[1] + c * p[2]
    r_a = a * r[0] + b * r[1] + c * r[2]
    v_a = a * v[0] + b * v[1] + c * v[2]
    azimuth = np.arctan2(a * across[0] + b * across[1] + c * across[2], along - r_a * p_a)
    s, c_ = np.sin(azimuth / 2), np.cos(azimuth / 2)
    level = a * crossed[0] + b * crossed[1] + c * crossed[2]
    sine = c_ * turned - s * (scalar * p_a + level)
    cosine = c_ * scalar + s * v_a
    sine = np.where(cosine < 0, -sine, sine)  # both quaternions of a rotation mean the same
    colatitude = np.arctan2(np.sqrt(np.maximum(0.0, 1 - p_a * p_a)), p_a)
    return colatitude, 2 * np.arctan2(sine, np.abs(cosine)), azimuth


@kernel
def equations(
    axis: Array,
    vectors: Array,
    numbers: Array,
    phase: NDArray[np.intp],
    weights: Array,
    scaled: Array,
    share: float,
    freedom: float,
    one_cone: bool,
    coupled: float,
) -> tuple[Array, Array, Array, Array, float]:
    """Return the equations of a better axis, and what they rest on.

    Parameters
    ----------
    axis : (3,)
        Unit vector.
    vectors, numbers
        As `errors_about` takes them.
    phase, weights : (n,)
    scaled : (2, n)
        Weights of the errors of cone and twist, times those of the t distribution; renewed.
    share
        By which squares count, for errors are alike in frames beside each other.
    freedom
        Of the t distributions.
    one_cone
        Whether all phases share a cone.
    coupled
        How much the limb twists with the angle, rad a rad.

    Returns
    -------
    basis : (2, 3)
        Two ways to tilt the axis.
    columns : (4, 2 n)
        Derivatives of errors over their spreads, of the cone, then of the twist: by the two
        tilts, the opening of the cone, the coupling.
    errors : (2 n,)
    spreads : (2,) rad
        Of cone and twist.
    opening
        rad; 0 where every phase has a cone of its own.
    """
    n = len(weights)
    columns, errors, spreads = np.zeros((4, 2 * n)), np.empty(2 * n), np.empty(2)
    basis = tangents_kernel(axis)
    colatitude, twist, azimuth = errors_about(axis, vectors, numbers)
    for k in range(2):
        near = axis + STEP * basis[k]
        near = near / np.sqrt((near * near).sum())
        tilted, twisted, _ = errors_about(near, vectors, numbers)
        columns[k, :n] = (tilted - colatitude) / STEP
        columns[k, n:] = (twisted - twist) / STEP
    columns[3, n:] = -azimuth
    twist = twist - coupled * azimuth
    opening = 0.0
    if one_cone:
        opening = weighted_median(colatitude, weights)
        columns[2, :n] = -1.0
        out = colatitude - opening
    else:
        out = centred(colatitude, scaled[0], phase)
    turned = centred(twist, scaled[1], phase)
    spreads[0], spreads[1] = _spread(out, weights), _spread(turned, weights)
    scaled[0] = weights * (freedom + 1) / (freedom + (out / spreads[0]) ** 2)
    scaled[1] = weights * (freedom + 1) / (freedom + (turned / spreads[1]) ** 2)
    if not one_cone:
        out = centred(colatitude, scaled[0], phase)
        for k in range(2):
            columns[k, :n] = centred(columns[k, :n], scaled[0], phase)
    errors[:n], errors[n:] = out, centred(twist, scaled[1], phase)
    for k in (0, 1, 3):
        columns[k, n:] = centred(columns[k, n:], scaled[1], phase)
    scales = np.empty(2 * n)
    scales[:n] = np.sqrt(share * scaled[0]) / spreads[0]
    scales[n:] = np.sqrt(share * scaled[1]) / spreads[1]
    return basis, columns * scales, errors * scales, spreads, opening


@kernel
def centred(values: Array, weights: Array, phase: NDArray[np.intp]) -> Array:
    """Return values, (n,), less their weighted mean in each phase."""
    means = np.bincount(phase, weights * values) / np.bincount(phase, weights)
    return values - means[phase]


@kernel
def weighted_median(values: Array, weights: Array) -> float:
    """Return the value with half of the weight, (n,) and (n,), on either side."""
    order = np.argsort(values, kind="mergesort")
    before = np.cumsum(weights[order])
    half = before[-1] / 2
    low = np.searchsorted(before, half * (1 - 1e-12))
    high = min(np.searchsorted(before, half * (1 + 1e-12)), len(values) - 1)
    return float(values[order[low]] + values[order[high]]) / 2


@kernel
def _spread(errors: Array, weights: Array) -> float:
    """Return the standard deviation of errors, (n,), as if no outlier were among them, rad."""
    return max(NORMAL_MAD * weighted_median(np.abs(errors), weights), FLOOR)
