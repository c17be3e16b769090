"""How the distances between points that come and go are spread."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

Array = NDArray[np.float64]


@kernel
def pair_moments(points: Array, shift: Array) -> tuple[Array, Array, Array]:
    """Return how often each two points are seen together, and the moments of their distance.

    Parameters
    ----------
    points : (n_frames, n, 3)
        NaN where not seen.
    shift : (n, n)
        About the distance; moments are taken of what differs from it, for accuracy.

    Returns
    -------
    Count, sum and sum of squares, each (n, n) and symmetric; 0 on the diagonal.
    """
    n_frames, n, _ = points.shape
    count, total, squares = np.zeros((n, n)), np.zeros((n, n)), np.zeros((n, n))
    alive = np.empty(n, dtype=np.int64)
    for t in range(n_frames):
        n_alive = 0
        for m in range(n):
            if np.isfinite(points[t, m, 0]):
                alive[n_alive] = m
                n_alive += 1
        for i in range(n_alive):
            a = alive[i]
            for j in range(i):
                b = alive[j]
                x = points[t, a, 0] - points[t, b, 0]
                y = points[t, a, 1] - points[t, b, 1]
                z = points[t, a, 2] - points[t, b, 2]
                off = np.sqrt(x * x + y * y + z * z) - shift[a, b]
                count[a, b] += 1
                total[a, b] += off
                squares[a, b] += off * off
    return count + count.T, total + total.T, squares + squares.T
