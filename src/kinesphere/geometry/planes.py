"""Planes and rectangles that hold a handful of points, for many frames at once. Arrays only."""

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.vectors import is_seen
from kinesphere.kernels.principal_axes import principal_axes_kernel

Array = NDArray[np.float64]


def fit_planes(points: Array) -> tuple[Array, Array, Array]:
    """Return the plane closest to the points of each frame, in the least-squares sense.

    Parameters
    ----------
    points : (n_frames, n_points, 3) m
        NaN points are left out.

    Returns
    -------
    centres : (n_frames, 3) m
        Mean of the points.
    axes : (n_frames, 3, 3)
        Columns: principal directions by falling variance, the last one the plane's normal. Each
        has either sign.
    variances : (n_frames, 3) m²
        Mean square along each direction; the last one is the mean squared distance to the plane.

    Frames with fewer than three points give NaN.
    """
    seen = is_seen(points)
    n = seen.sum(axis=1)
    enough = n >= 3
    weights = np.where(seen & enough[:, None], 1.0, 0.0) / np.maximum(n, 1)[:, None]
    filled = np.where(seen[..., None], points, 0.0)
    centres = np.einsum("fp,fpi->fi", weights, filled)
    spread = np.where(seen[..., None], points - centres[:, None], 0.0)
    covariances = np.swapaxes(weights[..., None] * spread, 1, 2) @ spread
    vectors, values = np.empty_like(covariances), np.empty_like(centres)
    principal_axes_kernel(covariances, vectors, values)
    unknown = ~enough
    centres[unknown], values[unknown], vectors[unknown] = np.nan, np.nan, np.nan
    return centres, vectors, values


def smallest_rectangles(points: Array) -> tuple[Array, Array, Array]:
    """Return the rectangle of least area around the points of each frame.

    One side of it lies along an edge of the convex hull (Freeman & Shapira 1975,
    doi:10.1145/360881.360919), so the best of the directions between any two points is exact; for
    a dozen points trying them all at once is quicker than a hull per frame.

    Parameters
    ----------
    points : (n_frames, n_points, 2) m
        NaN points are left out.

    Returns
    -------
    short, long : (n_frames,) m
        Lengths of its sides; NaN where fewer than two points are there.
    direction : (n_frames, 2)
        Unit vector along the longer side, of either sign.
    """
    n_frames, n_points = points.shape[:2]
    best = np.full(n_frames, np.inf)
    sides = np.full((n_frames, 2), np.nan)
    direction = np.full((n_frames, 2), np.nan)
    for i, j in combinations(range(n_points), 2):
        along = points[:, j] - points[:, i]
        length = np.linalg.norm(along, axis=1)
        usable = length > 0  # False where NaN, too
        along = along[usable] / length[usable, None]
        across = np.stack([-along[:, 1], along[:, 0]], axis=1)
        here = points[usable]
        u = np.einsum("fpi,fi->fp", here, along)
        v = np.einsum("fpi,fi->fp", here, across)
        du = np.nanmax(u, axis=1) - np.nanmin(u, axis=1)
        dv = np.nanmax(v, axis=1) - np.nanmin(v, axis=1)
        at = np.flatnonzero(usable)
        better = du * dv < best[at]
        at, du, dv = at[better], du[better], dv[better]
        best[at] = du * dv
        sides[at] = np.sort(np.stack([du, dv], axis=1), axis=1)
        direction[at] = np.where((du >= dv)[:, None], along[better], across[better])
    return sides[:, 0], sides[:, 1], direction
