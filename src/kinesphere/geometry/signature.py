"""What a set of points shows of itself over time: distances, their spread, handedness."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import minimum_spanning_tree

from kinesphere.geometry.handedness import handedness_table
from kinesphere.geometry.pair_distances import pair_distances

Array = NDArray[np.float64]

FRAMES = 300
"""Most frames looked at: more do not change the statistics of a recording that is long already."""
HANDED_FRAMES = 60
"""Most frames that handedness is counted on: its sampling error is 0.13 at worst, and next to none
where it is stable, which is where it is used."""


class Signature(NamedTuple):
    """Statistics of points over time that no rigid motion, and no order of frames, changes."""

    mean: Array
    """(n, n) mean distance, in the unit of the points; NaN where never seen together."""
    std: Array
    """(n, n) its standard deviation."""
    frames: NDArray[np.int64]
    """(n, n) frames that show both, of those looked at."""
    handedness: NDArray[np.int8]
    """(n choose 4,) mean sign of the volume of each quadruple, in hundredths."""

    @property
    def n(self) -> int:
        """Number of points."""
        return len(self.mean)


def signature(points: Array) -> Signature:
    """Return the statistics of points (n_frames, n_points, 3), NaN where not seen."""
    some = points[evenly_spread(len(points), FRAMES)]
    distances = pair_distances(some)
    table = handedness_table(some[evenly_spread(len(some), HANDED_FRAMES)])
    return Signature(distances.mean, distances.std, distances.frames, table)


def evenly_spread(n_frames: int, count: int) -> NDArray[np.intp]:
    """Return at most ``count`` frames, evenly spread, the same ones when time runs backwards."""
    if n_frames <= count:
        return np.arange(n_frames)
    half = (count + 1) // 2
    first = np.floor((np.arange(half) + 0.5) * n_frames / count).astype(np.intp)
    return np.unique(np.concatenate([first, n_frames - 1 - first]))[:count]


def scale_of(mean: Array) -> float:
    """Return the length of the shortest tree that joins all points, by their mean distances.

    It measures a body that wears a full layout to about 6 % whatever it does. Pairs never seen
    together, or at no distance, are no edges.
    """
    known = np.where(np.isfinite(mean), mean, 0.0)
    return float(minimum_spanning_tree(np.maximum(known, known.T)).sum())
