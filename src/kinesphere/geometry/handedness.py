"""On which side of three points a fourth one lies, over time: what tells left from right.

Distances are the same in a mirror; the sign of the volume of four points is not.
"""

from math import comb

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

Array = NDArray[np.float64]
Signs = NDArray[np.int8]

FULL = 100
"""What a table holds for a quadruple that is right-handed in every frame."""


def handedness_table(points: Array) -> Signs:
    """Return the mean sign of the volume of every four points, in hundredths.

    Parameters
    ----------
    points : (n_frames, n_points, 3)
        NaN where not seen; frames that show all four count.

    Returns
    -------
    (n_points choose 4,) −100…100 in the order of ``rank_of``; 0 where four are never seen together.

    Raises
    ------
    ValueError
        If ``points`` are no such thing.
    """
    if points.ndim != 3 or points.shape[2] != 3:
        raise ValueError(f"points must be (n_frames, n_points, 3), got {points.shape}")
    table = np.zeros(comb(points.shape[1], 4), dtype=np.int8)
    by_point = np.ascontiguousarray(np.moveaxis(points, 1, 0), dtype=np.float64)
    handedness_kernel(by_point, table)
    return table


def quadruples_of(n: int) -> NDArray[np.int64]:
    """Return every four of n points, (n choose 4, 4) ascending, in the order of the table."""
    found = np.empty((comb(n, 4), 4), dtype=np.int64)
    _quadruples_kernel(n, found)
    return found


@kernel
def _quadruples_kernel(n: int, found: NDArray[np.int64]) -> None:
    for d in range(3, n):
        for c in range(2, d):
            for b in range(1, c):
                for a in range(b):
                    row = found[rank_of(a, b, c, d)]
                    row[0], row[1], row[2], row[3] = a, b, c, d


@kernel
def rank_of(a: int, b: int, c: int, d: int) -> int:
    """Return where the quadruple a < b < c < d stands in a table of all quadruples."""
    return (
        a
        + b * (b - 1) // 2
        + c * (c - 1) * (c - 2) // 6
        + d * (d - 1) * (d - 2) * (d - 3) // 24
    )  # fmt: skip


@kernel
def handedness_kernel(points: Array, table: Signs) -> None:
    """Fill the table of points (n_points, n_frames, 3)."""
    n, n_frames = points.shape[0], points.shape[1]
    for d in range(3, n):
        for c in range(2, d):
            for b in range(1, c):
                for a in range(b):
                    balance, seen = 0, 0
                    for t in range(n_frames):
                        v = volume(points[a, t], points[b, t], points[c, t], points[d, t])
                        if v > 0:
                            balance += 1
                            seen += 1
                        elif v <= 0:  # NaN is neither
                            balance -= 1 if v < 0 else 0
                            seen += 1
                    if seen > 0:
                        table[rank_of(a, b, c, d)] = np.int8(round(FULL * balance / seen))


@kernel
def volume(a: Array, b: Array, c: Array, d: Array) -> float:
    """Return six times the signed volume of the tetrahedron a, b, c, d."""
    x1, y1, z1 = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    x2, y2, z2 = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    x3, y3, z3 = d[0] - a[0], d[1] - a[1], d[2] - a[2]
    return float(x1 * (y2 * z3 - z2 * y3) - y1 * (x2 * z3 - z2 * x3) + z1 * (x2 * y3 - y2 * x3))


@kernel
def handedness_of(table: Signs, a: int, b: int, c: int, d: int) -> int:
    """Return the handedness of four points in any order; the table knows ascending ones."""
    sign = 1
    if a > b:
        a, b, sign = b, a, -sign
    if c > d:
        c, d, sign = d, c, -sign
    if a > c:
        a, c, sign = c, a, -sign
    if b > d:
        b, d, sign = d, b, -sign
    if b > c:
        b, c, sign = c, b, -sign
    return sign * int(table[rank_of(a, b, c, d)])
