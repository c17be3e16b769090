"""The axis that leaves least unexplained of a limb's motion."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.rotations import tangent_basis
from kinesphere.parameterization.axes.cone_and_twist import ConeAndTwist

FLOOR = float(np.deg2rad(1e-4))  # a spread below this is rounding, not noise
STEP = 1e-5  # rad, of the numerical derivative
LARGEST_STEP = 0.2  # rad, of one iteration
SETTLED = 1e-6  # rad
FREEDOM = 10.0  # of the t distribution that errors are taken from: its tails forgive bad frames,
# and the sway about other axes, which is no outlier, still counts
NORMAL_MAD = 1.4826
TINY = 1e-9


class Likeliest(NamedTuple):
    """An axis, and what was found with it."""

    axis: Array
    """(3,)"""
    cost: float
    """Negative logarithm of its likelihood."""
    coupling: float = 0.0
    """rad of twist for a rad of the angle."""
    deviation: float = 0.0
    """Standard deviation of the coupling."""


@dataclass(frozen=True)
class Cone:
    """What is known about the opening of a cone that all phases share."""

    usual: float
    """rad."""
    deviation: float
    """rad."""


def likeliest_axis(
    errors: ConeAndTwist,
    start: Array,
    rounds: int,
    cone: Cone | None = None,
    freedom: float = FREEDOM,
    coupling: float = 0.0,
) -> Likeliest:
    """Return the axis of which a limb's cone and twist are likeliest.

    Gauss-Newton steps, spreads and weights taken anew each time.

    Parameters
    ----------
    errors
        Of one axis.
    start : (3,)
        Within some 40° of the truth.
    rounds
        How many steps at most.
    cone
        That all phases lie on; None gives every phase its own.
    freedom
        Degrees of freedom of the t distributions: fewer, heavier tails.
    coupling
        Usual size (standard deviation) of the twist that goes with the angle, rad a rad, where the
        limb may twist in proportion to it; 0 where it may not.
    """
    axis = start / np.linalg.norm(start)
    share = errors.effective / len(errors.positions)
    n = len(errors.positions)
    of_cone, of_twist = errors.weights, errors.weights
    opening = np.nan
    cost = np.inf
    coupled = deviation = 0.0
    n_columns = 4 if coupling else 3
    for _ in range(rounds):
        basis = tangent_basis(axis)
        near = np.vstack([axis, axis + STEP * basis])
        near /= np.linalg.norm(near, axis=1)[:, None]
        colatitudes, twists = errors.errors(near)
        colatitude = colatitudes[0]
        tilted = list((colatitudes[1:] - colatitude) / STEP)
        twisted = list((twists[1:] - twists[0]) / STEP)
        twist = twists[0]
        if coupling:
            azimuth = errors.azimuths(axis)
            twist = twist - coupled * azimuth
            twisted.append(-azimuth)
        if cone is not None:
            opening = _median(colatitude, errors.weights)
            out = colatitude - opening
        else:
            out = errors.centred(colatitude, of_cone)
        turned = errors.centred(twist, of_twist)
        spreads = _spread(out, errors.weights), _spread(turned, errors.weights)
        of_cone = errors.weights * _weights(out, spreads[0], freedom)
        of_twist = errors.weights * _weights(turned, spreads[1], freedom)
        scales = np.sqrt(share * of_cone) / spreads[0], np.sqrt(share * of_twist) / spreads[1]
        if cone is None:
            out = errors.centred(colatitude, of_cone)
            tilted = [errors.centred(column, of_cone) for column in tilted]
        turned = errors.centred(twist, of_twist)
        twisted = [errors.centred(column, of_twist) for column in twisted]
        # columns: two ways to tilt the axis, the opening of the cone, the coupling
        rows, values = np.zeros((2 * n + n_columns - 2, n_columns)), np.zeros(2 * n + n_columns - 2)
        rows[:n, :2] = np.stack(tilted, axis=1) * scales[0][:, None]
        rows[n : 2 * n, [0, 1, 3][: len(twisted)]] = np.stack(twisted, axis=1) * scales[1][:, None]
        values[:n], values[n : 2 * n] = out * scales[0], turned * scales[1]
        known = slice(2 * n, None)
        rows[2 * n, 2] = 1.0
        if cone is not None:
            rows[:n, 2] = -scales[0]
            rows[2 * n, 2] = 1 / cone.deviation
            values[2 * n] = (opening - cone.usual) / cone.deviation
        if coupling:
            rows[-1, 3], values[-1] = 1 / coupling, coupled / coupling
        cost = errors.effective * float(np.log(spreads).sum()) + 0.5 * float(
            values[known] @ values[known]
        )
        normal = rows.T @ rows
        # phases of a frame or two leave directions open: those stay as they are
        step = -np.linalg.lstsq(normal, rows.T @ values, TINY)[0]
        if coupling:
            coupled += float(step[3])
            deviation = float(np.sqrt(np.linalg.pinv(normal, hermitian=True)[3, 3]))
        step = step[:2]
        size = float(np.linalg.norm(step))
        if size > LARGEST_STEP:
            step *= LARGEST_STEP / size
        axis = axis + step @ basis
        axis = axis / np.linalg.norm(axis)
        if size < SETTLED:
            break
    return Likeliest(np.asarray(axis), cost, coupled, deviation)


def _spread(errors: Array, weights: Array) -> float:
    return max(NORMAL_MAD * _median(np.abs(errors), weights), FLOOR)


def _median(values: Array, weights: Array) -> float:
    """Return the value with half of the weight on either side."""
    order = np.argsort(values, kind="stable")
    before = np.cumsum(weights[order])
    half = before[-1] / 2
    low = int(np.searchsorted(before, half * (1 - 1e-12)))
    high = int(np.searchsorted(before, half * (1 + 1e-12)))
    return float(values[order[low]] + values[order[min(high, len(values) - 1)]]) / 2


def _weights(errors: Array, spread: float, freedom: float) -> Array:
    """Return weights of a t distribution, (n,): 1 near the middle, less in the tails."""
    return np.asarray((freedom + 1) / (freedom + (errors / spread) ** 2))
