"""The axis of a joint that has only one: cone and twist, each weighed by its worth."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.geometry.rotations import mean_rotation, rotation_about
from kinesphere.parameterization.axes.fit import moving_positions, plane_normal
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.twist import closed_twist

MOST_FRAMES = 400  # more change the axis by less than its uncertainty
TRIAL_FRAMES = 80  # enough to tell starts apart
ROUNDS = (6, 20)  # of a trial and of the last fit
FLOOR = np.deg2rad(1e-4)  # a spread below this is rounding, not noise
STEP = 1e-5  # rad, of the numerical derivative
LARGEST_STEP = 0.2  # rad, of one iteration
SETTLED = 1e-7  # rad
FREEDOM = 4.0  # of the t distribution that errors are taken from: its tails forgive bad frames
USUAL_CONE = np.deg2rad(20.0)  # standard deviation of a limb's angle to its hinge about 90 deg:
# carrying angles reach 20 deg; without it any cluster of directions lies on some tiny circle
MEMORY = 0.4  # s, over which errors of markers on skin stay alike
NORMAL_MAD = 1.4826


def hinge_axis(samples: JointSamples, starts: Array) -> Array:
    """Return the one axis of a hinge, (1, 3), from directions and orientations together.

    About its axis a limb keeps one colatitude in all phases, and without twist its orientation
    follows. An axis leaves of every frame an out-of-cone angle ε, which twist cannot touch, and a
    twist τ about its mean in the phase, which the cone's opening cannot touch. Both errors are
    taken from t distributions whose spreads are estimated with the axis (Lange, Little & Taylor
    1989, doi:10.1080/01621459.1989.10478852, by iterated reweighting): each estimator counts with
    its inverse variance, so noise-free directions make the axis exact however the limb twists.

    Parameters
    ----------
    samples
        One joint with at least one phase.
    starts : (n, 3)
        Where to start from, beside the planes that directions lie in.

    Returns
    -------
    (1, 3)
    """
    parts = [samples.positions[a:b] for a, b in samples.phases]
    centred = np.concatenate([part - part.mean(axis=0) for part in parts])
    tried = np.vstack([starts, plane_normal(centred), plane_normal(moving_positions(samples))])
    few = _Errors.of(samples, TRIAL_FRAMES)
    best = min((_fit(few, start, ROUNDS[0]) for start in tried), key=lambda fit: fit[1])
    return _fit(_Errors.of(samples, MOST_FRAMES), best[0], ROUNDS[1])[0][None]


@dataclass(frozen=True, eq=False)
class _Errors:
    """The frames of all phases, and what an axis leaves unexplained of them."""

    rotations: Array
    """(n, 3, 3)"""
    positions: Array
    """(n, 3)"""
    means: Array
    """(n, 3, 3) mean rotation of the frame's phase."""
    phase: NDArray[np.intp]
    """(n,)"""
    counts: NDArray[np.intp]
    """(n_phases,)"""
    long_axis: Array
    """(3,)"""
    effective: float
    """How many frames have errors of their own."""

    @classmethod
    def of(cls, samples: JointSamples, most: int) -> "_Errors":
        length = sum(b - a for a, b in samples.phases)
        stride = max(1, length // most)
        parts = [samples.rotations[a:b:stride] for a, b in samples.phases]
        counts = np.array([len(part) for part in parts])
        rotations = np.concatenate(parts)
        return cls(
            rotations=rotations,
            positions=rotations @ samples.long_axis,
            means=np.repeat([mean_rotation(part) for part in parts], counts, axis=0),
            phase=np.repeat(np.arange(len(parts)), counts),
            counts=counts,
            long_axis=samples.long_axis,
            effective=min(float(len(rotations)), max(1.0, length / samples.rate / MEMORY)),
        )

    def colatitudes(self, axis: Array) -> Array:
        """Return the angle of every direction to an axis in rad, (n,)."""
        p = self.positions
        return np.asarray(np.arctan2(np.linalg.norm(np.cross(axis, p), axis=1), p @ axis))

    def twists(self, axis: Array) -> Array:
        """Return what is left of the rotation when swing about the axis is taken out, centred."""
        r, p = self.means @ self.long_axis, self.positions
        theta = np.arctan2(np.cross(r, p) @ axis, (p * r).sum(axis=1) - (r @ axis) * (p @ axis))
        tau = closed_twist(rotation_about(axis, theta) @ self.means, self.rotations, self.long_axis)
        centre = np.angle(
            np.bincount(self.phase, np.cos(tau)) + 1j * np.bincount(self.phase, np.sin(tau))
        )[self.phase]
        return np.asarray(np.angle(np.exp(1j * (tau - centre))))


def _fit(errors: _Errors, start: Array, rounds: int) -> tuple[Array, float]:
    """Return the axis from one start and its cost, the negative logarithm of its likelihood."""
    axis = start / np.linalg.norm(start)
    cost = np.inf
    share = errors.effective / len(errors.positions)
    for _ in range(rounds):
        first = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
        first /= np.linalg.norm(first)
        basis = np.stack([first, np.cross(axis, first)])
        cone, twist = errors.colatitudes(axis), errors.twists(axis)
        opening = float(np.median(cone))
        spreads = [_spread(cone - opening), _spread(twist)]
        # columns: two ways to tilt the axis, the opening of the cone
        rows, values = np.zeros((2 * len(cone) + 1, 3)), np.zeros(2 * len(cone) + 1)
        parts = (slice(0, len(cone)), slice(len(cone), 2 * len(cone)))
        weights = [
            np.sqrt(share * _weights(e, s)) / s
            for e, s in zip((cone - opening, twist), spreads, strict=True)
        ]
        for k, direction in enumerate(basis):
            near = axis + STEP * direction
            near /= np.linalg.norm(near)
            rows[parts[0], k] = (errors.colatitudes(near) - cone) / STEP * weights[0]
            rows[parts[1], k] = (errors.twists(near) - twist) / STEP * weights[1]
        rows[parts[0], 2] = -weights[0]
        rows[-1, 2] = 1 / USUAL_CONE
        values[parts[0]] = (cone - opening) * weights[0]
        values[parts[1]] = twist * weights[1]
        values[-1] = (opening - np.pi / 2) / USUAL_CONE
        cost = errors.effective * float(np.log(spreads).sum()) + 0.5 * float(values[-1] ** 2)
        step = -np.linalg.lstsq(rows, values, rcond=None)[0][:2]
        size = float(np.linalg.norm(step))
        if size > LARGEST_STEP:
            step *= LARGEST_STEP / size
        axis = axis + step @ basis
        axis = axis / np.linalg.norm(axis)
        if size < SETTLED:
            break
    return np.asarray(axis), cost


def _spread(errors: Array) -> float:
    spread = NORMAL_MAD * float(np.median(np.abs(errors)))
    return max(spread, float(FLOOR))


def _weights(errors: Array, spread: float) -> Array:
    """Return weights of a t distribution, (n,): 1 near the middle, less in the tails."""
    return np.asarray((FREEDOM + 1) / (FREEDOM + (errors / spread) ** 2))
