"""Which angles move in which movement of a joint."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Mask

REST = 2.5  # usual gaps between frames; after a longer one another movement begins
LEAST_SHARE = 1 / 3  # of the deviation in its widest movement: an angle that does less rests


@dataclass(frozen=True, eq=False)
class Movements:
    """A motion's frames as movements, in each of which an angle moves or rests."""

    of_frame: NDArray[np.intp]
    """(n_frames,) the movement it belongs to, growing from 0."""
    moving: Mask
    """(n_movements, 3) whether the angle about distal axis, proximal axis and limb moves."""

    @classmethod
    def one(cls, n_frames: int) -> Self:
        """Return a single movement of all angles."""
        return cls(np.zeros(n_frames, dtype=np.intp), np.ones((1, 3), dtype=bool))

    @classmethod
    def by_rests(cls, times: Array, angles: Array) -> Self:
        """Cut a motion, (n,) s, at its rests; look how far angles, (n, 3) rad, go in each part."""
        gaps = np.diff(times)
        of_frame = np.concatenate([[0], np.cumsum(gaps > REST * np.median(gaps))])
        spreads = np.array([angles[of_frame == i].std(axis=0) for i in range(of_frame[-1] + 1)])
        return cls(of_frame, spreads >= LEAST_SHARE * spreads.max(axis=0))

    @property
    def resting(self) -> bool:
        """Whether any angle rests in any movement."""
        return not self.moving.all()

    @property
    def surprise(self) -> float:
        """Negative logarithm of the probability of what moves where, each being as probable."""
        return self.moving.size * np.log(2) if self.resting else 0.0

    def deviations(self, widest: Array, sway: float) -> Array:
        """Return every angle's deviation in every movement, (n_movements, 3) rad."""
        return np.where(self.moving, widest, sway)
