"""What an axis leaves unexplained of a limb's motion, and the axis that leaves least."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.geometry.rotations import mean_rotation, rotation_about
from kinesphere.parameterization.samples import JointSamples, Phase
from kinesphere.parameterization.twist import closed_twist

FLOOR = float(np.deg2rad(1e-4))  # a spread below this is rounding, not noise
STEP = 1e-5  # rad, of the numerical derivative
LARGEST_STEP = 0.2  # rad, of one iteration
SETTLED = 1e-6  # rad
FREEDOM = 10.0  # of the t distribution that errors are taken from: its tails forgive bad frames
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

    rotations: Array
    """(n, 3, 3)"""
    positions: Array
    """(n, 3)"""
    means: Array
    """(n, 3, 3) mean rotation of the frame's phase."""
    phase: NDArray[np.intp]
    """(n,)"""
    long_axis: Array
    """(3,)"""
    effective: float
    """How many frames have errors of their own."""

    @classmethod
    def of(cls, samples: JointSamples, phases: tuple[Phase, ...], most: int) -> "ConeAndTwist":
        """Return the frames of some phases, evenly thinned to about ``most``."""
        length = sum(b - a for a, b in phases)
        stride = max(1, length // most)
        parts = [samples.rotations[a:b:stride] for a, b in phases]
        counts = [len(part) for part in parts]
        rotations = np.concatenate(parts)
        return cls(
            rotations=rotations,
            positions=rotations @ samples.long_axis,
            means=np.repeat([mean_rotation(part) for part in parts], counts, axis=0),
            phase=np.repeat(np.arange(len(parts)), counts),
            long_axis=samples.long_axis,
            effective=min(float(len(rotations)), max(1.0, length / samples.rate / MEMORY)),
        )

    def colatitudes(self, axis: Array) -> Array:
        """Return the angle of every direction to an axis in rad, (n,)."""
        p = self.positions
        return np.asarray(np.arctan2(np.linalg.norm(np.cross(axis, p), axis=1), p @ axis))

    def twists(self, axis: Array) -> Array:
        """Return what is left when swing about the axis is taken out, (n,) rad."""
        r, p = self.means @ self.long_axis, self.positions
        theta = np.arctan2(np.cross(r, p) @ axis, (p * r).sum(axis=1) - (r @ axis) * (p @ axis))
        return closed_twist(
            rotation_about(axis, theta) @ self.means, self.rotations, self.long_axis
        )

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


def likeliest_axis(
    errors: ConeAndTwist, start: Array, rounds: int, cone: Cone | None = None
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
    """
    axis = start / np.linalg.norm(start)
    share = errors.effective / len(errors.positions)
    n = len(errors.positions)
    of_cone, of_twist = np.ones(n), np.ones(n)
    opening = np.nan
    cost = np.inf
    for _ in range(rounds):
        first = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
        first /= np.linalg.norm(first)
        basis = np.stack([first, np.cross(axis, first)])
        near = axis + STEP * basis
        near /= np.linalg.norm(near, axis=1)[:, None]
        colatitude, twist = errors.colatitudes(axis), errors.twists(axis)
        tilted = [(errors.colatitudes(a) - colatitude) / STEP for a in near]
        twisted = [(errors.twists(a) - twist) / STEP for a in near]
        if cone is not None:
            opening = float(np.median(colatitude))
            out = colatitude - opening
        else:
            out = errors.centred(colatitude, of_cone)
        turned = errors.centred(twist, of_twist)
        spreads = _spread(out), _spread(turned)
        of_cone, of_twist = _weights(out, spreads[0]), _weights(turned, spreads[1])
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
        normal = rows.T @ rows
        normal[np.diag_indices(3)] *= 1 + TINY
        step = -np.linalg.solve(normal, rows.T @ values)[:2]
        size = float(np.linalg.norm(step))
        if size > LARGEST_STEP:
            step *= LARGEST_STEP / size
        axis = axis + step @ basis
        axis = axis / np.linalg.norm(axis)
        if size < SETTLED:
            break
    return np.asarray(axis), cost


def _spread(errors: Array) -> float:
    return max(NORMAL_MAD * float(np.median(np.abs(errors))), FLOOR)


def _weights(errors: Array, spread: float) -> Array:
    """Return weights of a t distribution, (n,): 1 near the middle, less in the tails."""
    return np.asarray((FREEDOM + 1) / (FREEDOM + (errors / spread) ** 2))
