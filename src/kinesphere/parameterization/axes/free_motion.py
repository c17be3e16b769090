"""Frames of a joint in free motion, as its descriptions take them."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.geometry.rotations import nearest_rotation

SPACING = 0.1  # s between frames; people's angles hardly change their course within that
RESTLESS = np.deg2rad(0.7)  # errors new in every frame; correlated ones of 3° look like 0.5°
MOST_FRAMES = 1200  # of longer motion, every second, third… frame
FLOOR = 0.002  # rad, of an angle without any error
FLATTEST = (
    0.05  # least determinant of the angles' Jacobian: nearer to gimbal lock angles say little
)


@dataclass(frozen=True, eq=False)
class FreeMotion:
    """Frames of a joint that does what it likes."""

    rotations: Array
    """(n, 3, 3) ``parent_from_child``."""
    times: Array
    """(n,) s, growing."""
    long_axis: Array
    """(3,) in the child; what it twists about."""
    reference: Array
    """(3, 3) ``parent_from_child`` where the distal axis is told."""

    def thinned(self) -> "FreeMotion":
        """Return frames at least `SPACING` apart, at most `MOST_FRAMES` of them.

        Where errors are new in every frame, no process can follow them: there a frame stands for
        the mean of its `SPACING`.
        """
        cells = np.floor(self.times / SPACING + 1e-6)
        at = np.flatnonzero(np.diff(cells, prepend=-np.inf) > 0)
        stride = slice(None, None, 1 + (len(at) - 1) // MOST_FRAMES)
        if _new_in_every_frame(self.rotations) < RESTLESS:
            return self._at(at[stride])
        means = nearest_rotation(np.add.reduceat(self.rotations, at))
        times = np.add.reduceat(self.times, at) / np.diff(at, append=len(cells))
        few = replace(self, rotations=means, times=times)
        return few._at(np.arange(len(at))[stride])

    def first(self, count: int) -> "FreeMotion":
        """Return the first few frames."""
        return self._at(np.arange(min(count, len(self.times))))

    def _at(self, frames: NDArray[np.intp]) -> "FreeMotion":
        rotations = np.ascontiguousarray(self.rotations[frames])
        return replace(self, rotations=rotations, times=self.times[frames])


class AxesFit(NamedTuple):
    """Two axes, and how likely they are."""

    axes: Array
    """(2, 3) in the parent, distal first, the distal one where the limb is in its reference."""
    cost: float
    """Negative logarithm of the posterior, less a constant."""
    logs: Array = np.empty(0)
    """Logarithms of what its processes are like, if there are any."""


def _new_in_every_frame(rotations: Array) -> float:
    """Return the standard deviation in rad, about each axis, of errors that no frame shares."""
    if len(rotations) < 3:
        return 0.0
    bends = rotations[2:] + rotations[:-2] - 2 * rotations[1:-1]
    # of independent errors the squares of the nine entries add up to 36 variances
    return float(np.median(np.sqrt((bends**2).sum(axis=(1, 2))))) / 6
