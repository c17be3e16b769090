"""How steady the distances between points are over time: what tells which of them ride together."""

from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

Array = NDArray[np.float64]


class PairDistances(NamedTuple):
    """Distances between every two points over time; all arrays symmetric."""

    mean: Array
    """(n_points, n_points) in the unit of the points; NaN where two were never seen together."""
    std: Array
    """(n_points, n_points), over the frames that show both; zero on the diagonal."""
    trimmed_std: Array
    """(n_points, n_points), the same without the shortest and the longest share of the frames:
    a swap or a ghost that lasts less does not show. Of normal noise 0.79 of ``std``."""
    frames: NDArray[np.int64]
    """(n_points, n_points) how many frames show both; on the diagonal, how many show the point."""


def pair_distances(points: Array, *, trim: float = 0.05) -> PairDistances:
    """Return mean and spread over time of the distance between every two points.

    Each pair counts the frames that show both (pairwise complete), so points with gaps, or seen
    at different times, need no filling.

    Parameters
    ----------
    points : (n_frames, n_points, 3)
        NaN where not seen.
    trim
        Share of a pair's frames left out at either end for ``trimmed_std``, 0 to below 0.5.

    Raises
    ------
    ValueError
        If ``points`` or ``trim`` are no such thing.
    """
    if points.ndim != 3 or points.shape[2] != 3:
        raise ValueError(f"points must be (n_frames, n_points, 3), got {points.shape}")
    if not 0 <= trim < 0.5:
        raise ValueError(f"trim is {trim}; it must be at least 0 and below 0.5")
    by_point = np.ascontiguousarray(np.moveaxis(points, 1, 0), dtype=np.float64)
    n = len(by_point)
    mean, std, trimmed = np.full((3, n, n), np.nan)
    count = np.zeros((n, n), dtype=np.int64)
    # uncompiled, the kernel takes a hundred times as long as whole columns
    compiled = not getattr(numba.config, "DISABLE_JIT", False)
    measure = pair_distances_kernel if compiled else pair_distances_by_columns
    measure(by_point, trim, mean, std, trimmed, count)
    return PairDistances(mean, std, trimmed, count)


def pair_distances_by_columns(
    points: Array,
    trim: float,
    mean: Array,
    std: Array,
    trimmed: Array,
    count: NDArray[np.int64],
) -> None:
    """Do what `pair_distances_kernel` does, a column of distances at a time."""
    for i in range(len(points)):
        for j in range(i, len(points)):
            distances = np.linalg.norm(points[i] - points[j], axis=1)
            known = np.sort(distances[np.isfinite(distances)])
            count[i, j] = count[j, i] = n = len(known)
            if n == 0:
                continue
            cut = int(trim * n)
            mean[i, j] = mean[j, i] = known.mean()
            std[i, j] = std[j, i] = known.std()
            trimmed[i, j] = trimmed[j, i] = known[cut : n - cut].std()


@kernel
def pair_distances_kernel(
    points: Array,
    trim: float,
    mean: Array,
    std: Array,
    trimmed: Array,
    count: NDArray[np.int64],
) -> None:
    """Fill the statistics of every pair, points (n_points, n_frames, 3), in place."""
    n_points, n_frames = points.shape[0], points.shape[1]
    distances = np.empty(n_frames)
    for i in range(n_points):
        for j in range(i, n_points):
            n = 0
            for t in range(n_frames):
                x = points[i, t, 0] - points[j, t, 0]
                y = points[i, t, 1] - points[j, t, 1]
                z = points[i, t, 2] - points[j, t, 2]
                d = np.sqrt(x * x + y * y + z * z)
                if np.isfinite(d):
                    distances[n] = d
                    n += 1
            count[i, j] = n
            count[j, i] = n
            if n == 0:
                continue
            known = distances[:n]
            known.sort()
            middle, spread = _moments(known)
            mean[i, j] = middle
            mean[j, i] = middle
            std[i, j] = spread
            std[j, i] = spread
            cut = int(trim * n)
            _, spread = _moments(known[cut : n - cut])
            trimmed[i, j] = spread
            trimmed[j, i] = spread


@kernel
def _moments(values: Array) -> tuple[float, float]:
    total = 0.0
    for value in values:
        total += value
    middle = total / len(values)
    square = 0.0
    for value in values:
        square += (value - middle) ** 2
    return middle, np.sqrt(square / len(values))
