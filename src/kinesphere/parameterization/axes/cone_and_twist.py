"""What an axis leaves unexplained of a limb's motion."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.geometry.even_frames import every_nth
from kinesphere.geometry.rotations import mean_rotation, quaternions_from_rotations
from kinesphere.parameterization.axes.cone_kernels import errors_about
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
        q = quaternions_from_rotations(np.concatenate(turns))
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
    def vectors_beside(self) -> Array:
        """(5, 3, n) what axes are multiplied with, as the kernels take it."""
        p, r, v = self.positions, self.means, self.vectors
        return np.stack([p.T, r.T, v.T, np.cross(r, p).T, np.cross(p, v).T])

    @cached_property
    def numbers_beside(self) -> Array:
        """(3, n) what they are not multiplied with."""
        p, r, v = self.positions, self.means, self.vectors
        return np.stack([self.scalars, (p * r).sum(axis=1), (p * v).sum(axis=1)])

    def errors(self, axes: Array) -> tuple[Array, Array]:
        """Return colatitude and twist of every frame about each axis, (k, 3) → (k, n) rad twice.

        With ``D = R(p, τ) R(a, θ)`` the turn from the mean rotation, θ the azimuth from mean to
        present direction p, the twist is that of the quaternion product ``D · R(a, −θ)`` about p.
        """
        found = [errors_about(axis, self.vectors_beside, self.numbers_beside) for axis in axes]
        return np.stack([one[0] for one in found]), np.stack([one[1] for one in found])


def _turning(rotations: Array, cell: float) -> Array:
    """Return how much each rotation counts by how far it turns, (n, 3, 3) → (n,)."""
    there = turning_weights(np.ascontiguousarray(rotations), cell)
    back = turning_weights(np.ascontiguousarray(rotations[::-1]), cell)
    return (there + back[::-1]) / 2
