"""The visual hull: what of space every silhouette allows."""

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from kinesphere.data import Array
from kinesphere.errors import BadScene
from kinesphere.markerless.kernels.contour import project_kernel
from kinesphere.markerless.views import View

_TALLEST = 2.6
"""m; how large a space around the person is looked at."""
_SEEN_BY = 2
"""Cameras that must see a point, at least, for it to count."""
_EXPLAINS = 0.3
"""Share of every silhouette that the hull must cover, or the silhouettes are not of one thing."""


def visual_hull(
    views: Sequence[View], masks: Sequence[NDArray[np.uint8] | None], side: float = 0.03
) -> Array:
    """Return the middles of the cubes that no silhouette excludes, (n, 3) m in the world.

    Parameters
    ----------
    masks
        (height, width) 0 to 255, one a view; None where there is none.
    side
        m, of a cube.

    Raises
    ------
    BadScene
        If fewer than two silhouettes are there, or they have nothing in common.
    """
    seen = [
        (view, mask)
        for view, mask in zip(views, masks, strict=True)
        if mask is not None and (mask > 127).any()
    ]
    if len(seen) < _SEEN_BY:
        raise BadScene(
            f"the person is found in {len(seen)} of {len(views)} cameras; a start needs two"
        )
    middle = _nearest_point(seen)
    step = 4 * side
    grid = np.arange(-_TALLEST / 2, _TALLEST / 2, step)
    coarse = np.stack(np.meshgrid(grid, grid, grid, indexing="ij"), -1).reshape(-1, 3) + middle
    coarse = coarse[_inside(coarse, seen, step)]
    offsets = (np.arange(4) - 1.5) * side
    cell = np.stack(np.meshgrid(offsets, offsets, offsets, indexing="ij"), -1).reshape(-1, 3)
    fine: Array = (coarse[:, None] + cell).reshape(-1, 3)
    fine = fine[_inside(fine, seen, 0.0)]
    hull = largest_piece_of_space(fine, side) if len(fine) else fine
    if len(hull) == 0 or min(_covered(hull, view, mask, side) for view, mask in seen) < _EXPLAINS:
        raise BadScene(
            "the silhouettes of the cameras have nothing in common; calibration, synchronisation "
            "or masks do not fit together"
        )
    return hull


def largest_piece_of_space(points: Array, side: float) -> Array:
    """Return the largest connected piece: corners that few cameras see are cut off by none."""
    index = np.rint((points - points.min(axis=0)) / side).astype(int)
    grid = np.zeros(index.max(axis=0) + 1, dtype=bool)
    grid[tuple(index.T)] = True
    labels, n = ndimage.label(grid, structure=np.ones((3, 3, 3)))
    if n < 2:
        return points
    of_point = labels[tuple(index.T)]
    return np.asarray(points[of_point == np.bincount(of_point)[1:].argmax() + 1])


def _nearest_point(seen: Sequence[tuple[View, NDArray[np.uint8]]]) -> Array:
    """Return the point nearest to the lines of sight through the silhouettes' middles."""
    total, right = np.zeros((3, 3)), np.zeros(3)
    for view, mask in seen:
        rows, cols = np.nonzero(mask > 127)
        fx, fy, cx, cy = view.lens
        ray = np.array([(cols.mean() - cx) / fx, (rows.mean() - cy) / fy, 1.0]) @ view.rotation
        ray /= np.linalg.norm(ray)
        across = np.eye(3) - np.outer(ray, ray)
        total += across
        right += across @ view.centre
    return np.asarray(np.linalg.lstsq(total, right)[0])


def _inside(
    points: Array, seen: Sequence[tuple[View, NDArray[np.uint8]]], step: float
) -> NDArray[np.bool_]:
    """Return which points, or cubes of side ``step``, every silhouette that sees them allows."""
    allowed = np.ones(len(points), dtype=bool)
    count = np.zeros(len(points), dtype=int)
    pixels, depths = np.empty((len(points), 2)), np.empty(len(points))
    for view, mask in seen:
        project_kernel(points, view.rotation, view.shift, view.lens, pixels, depths)
        person = mask > 127
        if step > 0:
            reach = max(1, round(0.9 * step * view.lens[0] / max(float(np.median(depths)), 0.1)))
            person = _grown(person, reach)
        col, row = np.nan_to_num(np.rint(pixels), nan=-1).astype(int).T
        shown = (row >= 0) & (row < view.height) & (col >= 0) & (col < view.width)
        count += shown
        allowed[shown] &= person[row[shown], col[shown]]
    return np.asarray(allowed & (count >= _SEEN_BY))


def _covered(hull: Array, view: View, mask: NDArray[np.uint8], side: float) -> float:
    """Return the share of a silhouette that the hull covers, by cells as large as its cubes."""
    pixels, depths = np.empty((len(hull), 2)), np.empty(len(hull))
    project_kernel(hull, view.rotation, view.shift, view.lens, pixels, depths)
    cell = max(2.0, side * view.lens[0] / max(float(np.median(depths)), 0.1))
    shape = (int(view.height / cell) + 1, int(view.width / cell) + 1)
    filled = np.zeros(shape, dtype=bool)
    col, row = (np.nan_to_num(pixels, nan=-1e6) / cell).astype(int).T
    shown = (row >= 0) & (row < shape[0]) & (col >= 0) & (col < shape[1])
    filled[row[shown], col[shown]] = True
    rows, cols = np.nonzero(mask > 127)
    return float(filled[(rows / cell).astype(int), (cols / cell).astype(int)].mean())


def _grown(mask: NDArray[np.bool_], reach: int) -> NDArray[np.bool_]:
    kernel = np.ones((2 * reach + 1, 2 * reach + 1), np.uint8)
    return np.asarray(cv2.dilate(mask.astype(np.uint8), kernel) > 0)
