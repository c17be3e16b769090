"""What one limb sees of another: sightings of its markers, and its orientation if it has one."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Turning:
    """How a limb with a pose of its own turns in the frame of the limb that sees it."""

    rotations: Array
    """(n_frames, 3, 3) from the turning limb into the seeing one; NaN where unknown."""
    shifts: Array
    """(n_frames, 3) m, its origin."""
    pose: Array
    """(6, 6) uncertainty of its pose, as `pose_covariance` returns it."""
    noise: float
    """m, what a point fixed in both limbs may stray in each direction for other reasons."""
    skin: Array | None = None
    """(6, 6) error of its pose that goes with the joint, at the joint's rms rotation."""
    skin_seeing: Array | None = None
    """(6, 6) the same of the seeing limb's pose; both or neither."""

    @cached_property
    def known(self) -> NDArray[np.bool_]:
        """(n_frames,) True where both limbs have a pose."""
        turned = np.isfinite(self.rotations).all(axis=(1, 2))
        return np.asarray(turned & np.isfinite(self.shifts).all(axis=1))

    @cached_property
    def back(self) -> Array:
        """(n_known, 3, 3) from the seeing limb into the turning one."""
        return np.ascontiguousarray(np.swapaxes(self.rotations[self.known], 1, 2))

    @cached_property
    def origins(self) -> Array:
        """(n_known, 3) m, where the seeing limb's origin lies in the turning one."""
        moved: Array = -(self.back @ self.shifts[self.known][..., None])[..., 0]
        return moved

    @cached_property
    def means(self) -> tuple[Array, Array]:
        """(3, 3) mean of `back`, and (9, 9) mean of its products with itself."""
        products = np.einsum("nij,nlk->iljk", self.back, self.back).reshape(9, 9) / len(self.back)
        return self.back.mean(axis=0), products

    def place(self, centre: Array) -> Array:
        """Return where a point of the seeing limb lies in the turning one, (n_known, 3) m."""
        moved: Array = self.back @ centre + self.origins
        return moved


class Sightings(NamedTuple):
    """Markers seen at least twice."""

    points: Array
    """(n_frames, n_markers, 3) m; anything where not seen."""
    seen: NDArray[np.bool_]
    """(n_frames, n_markers)."""
    noise: Array
    """(n_markers,) m."""
    complete: bool
    """True where every marker is seen in every frame."""


@dataclass(frozen=True)
class View:
    """Markers of one limb as another limb sees them, and how noisy that is."""

    points: Array
    """(n_frames, n_markers, 3) m; NaN where not seen."""
    noise: Array
    """(n_markers,) m, standard deviation of each marker in every direction."""
    pose: Array
    """(6, 6) uncertainty of the seeing limb's own pose, as `pose_covariance` returns it."""
    turning: Turning | None = None
    """The orientation of the limb that is seen, where its markers give one."""

    @cached_property
    def sightings(self) -> Sightings:
        """The markers that can keep a distance, with zeros instead of NaN."""
        seen = np.asarray(np.isfinite(self.points).all(axis=2))
        often = seen.sum(axis=0) > 1
        seen = seen[:, often]
        points = np.where(seen[..., None], self.points[:, often], 0.0)
        return Sightings(points, seen, self.noise[often], bool(seen.all()))
