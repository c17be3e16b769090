"""What an axis leaves unexplained of a limb's motion."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from kinesphere.data import Array
from kinesphere.geometry.even_frames import every_nth
from kinesphere.geometry.rotations import mean_rotation
from kinesphere.parameterization.axes.stratify import turning_weights
from kinesphere.parameterization.samples import JointSamples, Phase

MEMORY = 0.4  # s, over which errors of markers on skin stay alike


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

    def azimuths(self, axis: Array) -> Array:
        """Return the angle from mean to present direction about an axis, (3,) → (n,) rad."""
        across, _, along, _ = self._parts
        level = (self.means @ axis) * (self.positions @ axis)
        return np.asarray(np.arctan2(across @ axis, along - level))

    def centred(self, values: Array, weights: Array) -> Array:
        """Return values, (n,), less their weighted mean in each phase."""
        sums = np.bincount(self.phase, weights * values)
        return np.asarray(values - (sums / np.bincount(self.phase, weights))[self.phase])


def _turning(rotations: Array, cell: float) -> Array:
    """Return how much each rotation counts by how far it turns, (n, 3, 3) → (n,)."""
    there = turning_weights(np.ascontiguousarray(rotations), cell)
    back = turning_weights(np.ascontiguousarray(rotations[::-1]), cell)
    return (there + back[::-1]) / 2
