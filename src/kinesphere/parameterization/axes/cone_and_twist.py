"""What an axis leaves unexplained of a limb's motion, and the axis that leaves least."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from kinesphere.data import Array
from kinesphere.geometry.even_frames import every_nth
from kinesphere.geometry.rotations import mean_rotation, tangent_basis
from kinesphere.parameterization.axes.stratify import turning_weights
from kinesphere.parameterization.samples import JointSamples, Phase

FLOOR = float(np.deg2rad(1e-4))  # a spread below this is rounding, not noise
STEP = 1e-5  # rad, of the numerical derivative
LARGEST_STEP = 0.2  # rad, of one iteration
SETTLED = 1e-6  # rad
FREEDOM = 10.0  # of the t distribution that errors are taken from: its tails forgive bad frames,
# and the sway about other axes, which is no outlier, still counts
MEMORY = 0.4  # s, over which errors of markers on skin stay alike
NORMAL_MAD = 1.4826
TINY = 1e-9


@dataclass(frozen=True, eq=False)
class ConeAndTwist:
    """Frames of one main movement, and the two errors an axis leaves of each.

    About its axis a limb keeps one colatitude, and without twist its orientation follows. An axis
    leaves of every frame an out-of-cone angle ε, which twist cannot touch, and a twist τ about the
    mean of the phase, which the cone's opening cannot touch. Both are taken from t distributions
    whose spreads are estimated with the axis (Lange, Little & Taylor 1989,
    doi:10.1080/01621459.1989.10478852, by iterated reweighting), so each counts with its
    inverse variance and frames that something spoiled count little.
    """

    positions: Array
    """(n, 3) direction of the limb."""
    means: Array
    """(n, 3) direction of the limb in the mean rotation of the frame's phase."""
    scalars: Array
    """(n,) of the unit quaternions that turn the mean rotation into the frame's."""
    vectors: Array
    """(n, 3) of the same quaternions."""
    phase: NDArray[np.intp]
    """(n,)"""
    weights: Array
    """(n,) how much each frame counts, 1 on the mean."""
    effective: float
    """How many frames have errors of their own."""

    @classmethod
    def of(
        cls, samples: JointSamples, phases: tuple[Phase, ...], most: int, cell: float = 0.0
    ) -> "ConeAndTwist":
        """Return the frames of some phases, evenly thinned to about ``most``.

        With a ``cell``, in rad, frames count by how far they turn: a limb that dwells says nothing
        new.
        """
        length = sum(b - a for a, b in phases)
        stride = max(1, length // most)
        parts = [samples.rotations[a + every_nth(b - a, stride)] for a, b in phases]
        weights = np.ones(sum(len(part) for part in parts))
        if cell > 0:
            weights = np.concatenate([_turning(part, cell) for part in parts])
        counts = [len(part) for part in parts]
        means = [mean_rotation(part) for part in parts]
        turns = [part @ mean.T for part, mean in zip(parts, means, strict=True)]
        q = Rotation.from_matrix(np.concatenate(turns)).as_quat()
        return cls(
            positions=np.concatenate(parts) @ samples.long_axis,
            means=np.repeat([mean @ samples.long_axis for mean in means], counts, axis=0),
            scalars=q[:, 3],
            vectors=q[:, :3],
            phase=np.repeat(np.arange(len(parts)), counts),
            weights=weights / weights.mean(),
            effective=min(float(len(q)), max(1.0, length / samples.rate / MEMORY)),
        )

    @cached_property
    def _parts(self) -> tuple[Array, ...]:
        """What an axis is multiplied with, arrays (n, 3), and two products that it is not."""
        p, r, v = self.positions, self.means, self.vectors
        return np.cross(r, p), np.cross(p, v), (p * r).sum(axis=1), (p * v).sum(axis=1)

    def errors(self, axes: Array) -> tuple[Array, Array]:
        """Return colatitude and twist of every frame about each axis, (k, 3) → (k, n) rad twice.

        With ``D = R(p, τ) R(a, θ)`` the turn from the mean rotation, θ the azimuth from mean to
        present direction p, the twist is that of the quaternion product ``D · R(a, −θ)`` about p.
        """
        p_a, r_a = axes @ self.positions.T, axes @ self.means.T
        across, crossed, along, turned = self._parts
        colatitude = np.arctan2(np.sqrt(np.maximum(0.0, 1 - p_a**2)), p_a)
        half = np.arctan2(axes @ across.T, along - r_a * p_a) / 2
        s, c = np.sin(half), np.cos(half)
        sine = c * turned - s * (self.scalars * p_a + axes @ crossed.T)
        cosine = c * self.scalars + s * (axes @ self.vectors.T)
        sine = np.where(cosine < 0, -sine, sine)  # both quaternions of a rotation mean the same
        return colatitude, 2 * np.arctan2(sine, np.abs(cosine))

    def centred(self, values: Array, weights: Array) -> Array:
        """Return values, (n,), less their weighted mean in each phase."""
        sums = np.bincount(self.phase, weights * values)
        return np.asarray(values - (sums / np.bincount(self.phase, weights))[self.phase])


@dataclass(frozen=True)
class Cone:
    """What is known about the opening of a cone that all phases share."""

    usual: float
    """rad."""
    deviation: float
    """rad."""


def _turning(rotations: Array, cell: float) -> Array:
    """Return how much each rotation counts by how far it turns, (n, 3, 3) → (n,)."""
    there = turning_weights(np.ascontiguousarray(rotations), cell)
    back = turning_weights(np.ascontiguousarray(rotations[::-1]), cell)
    return (there + back[::-1]) / 2


def likeliest_axis(
    errors: ConeAndTwist,
    start: Array,
    rounds: int,
    cone: Cone | None = None,
    freedom: float = FREEDOM,
) -> tuple[Array, float]:
    """Return the axis, (3,), and its cost, the negative logarithm of its likelihood.

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
    """
    axis = start / np.linalg.norm(start)
    share = errors.effective / len(errors.positions)
    n = len(errors.positions)
    of_cone, of_twist = errors.weights, errors.weights
    opening = np.nan
    cost = np.inf
    for _ in range(rounds):
        basis = tangent_basis(axis)
        near = np.vstack([axis, axis + STEP * basis])
        near /= np.linalg.norm(near, axis=1)[:, None]
        colatitudes, twists = errors.errors(near)
        colatitude, twist = colatitudes[0], twists[0]
        tilted = list((colatitudes[1:] - colatitude) / STEP)
        twisted = list((twists[1:] - twist) / STEP)
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
        # columns: two ways to tilt the axis, the opening of the cone
        rows, values = np.zeros((2 * n + 1, 3)), np.zeros(2 * n + 1)
        rows[:n, :2] = np.stack(tilted, axis=1) * scales[0][:, None]
        rows[n:-1, :2] = np.stack(twisted, axis=1) * scales[1][:, None]
        values[:n], values[n:-1] = out * scales[0], turned * scales[1]
        rows[-1, 2] = 1.0
        if cone is not None:
            rows[:n, 2] = -scales[0]
            rows[-1, 2], values[-1] = 1 / cone.deviation, (opening - cone.usual) / cone.deviation
        cost = errors.effective * float(np.log(spreads).sum()) + 0.5 * float(values[-1] ** 2)
        # phases of a frame or two leave directions open: those stay as they are
        step = -np.linalg.lstsq(rows.T @ rows, rows.T @ values, TINY)[0][:2]
        size = float(np.linalg.norm(step))
        if size > LARGEST_STEP:
            step *= LARGEST_STEP / size
        axis = axis + step @ basis
        axis = axis / np.linalg.norm(axis)
        if size < SETTLED:
            break
    return np.asarray(axis), cost


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
