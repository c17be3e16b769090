"""By how many pixels cameras were moved since they were calibrated, told by silhouettes.

A camera that was knocked turns by a fraction of a degree; its image is shifted by a few pixels,
and the visual hull no longer fills its silhouette (nor those of the others). The shifts wanted are
those with which the hull fills all silhouettes best.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Camera, Mask

_SIDE = 0.025
"""m, of the cubes of space that are looked at."""
_REACH = 1.3
"""m around the person's middle."""
_CELL = 0.008
"""Of the image's diagonal: side of the squares in which a silhouette counts as filled."""
_STEPS = (0.0025, 0.0025, 0.00125, 0.00125)
"""Of the diagonal, by which shifts are tried, round after round: two, one and half a cell."""
_FARTHEST = 5
"""Steps to either side in a round."""
_CLEARLY = 0.02
"""What mending must gain to be told: 0.037 on real cameras 5 to 15 px off, 0.009 on good ones."""
_HELD = 0.2
"""Filling that a shift of a hundredth of the diagonal must gain, squared: all cameras shifted
alike is the person moved, and says nothing."""


@dataclass(frozen=True, eq=False)
class Alignment:
    """Where images lie, beside where calibration puts them."""

    shifts: Array
    """(n_cameras, 2) px, column and row, to be added to where a point is projected."""
    filled: float
    """Share of the silhouettes that the visual hull fills with them."""
    filled_before: float
    """The same without."""


@dataclass(frozen=True, eq=False)
class _Seen:
    """One camera at one instant."""

    pixels: NDArray[np.float32]
    """(n, 2) where the cubes are projected."""
    mask: Mask
    weights: Array
    """Pixels of the silhouette in each cell, flat."""
    n_columns: int
    cell: float
    diagonal: float


def aligned(
    cameras: Sequence[Camera],
    frames: Sequence[Sequence[Mask | None]],
    only: int | None = None,
) -> Alignment | None:
    """Return the shifts of cameras with which silhouettes agree best.

    Parameters
    ----------
    frames
        Silhouettes, (height, width), one a camera; None where there is none.
    only
        The camera that may have been moved; any, if None.

    Returns
    -------
    Alignment
        None where fewer than three cameras show a silhouette at once: two can always be agreed.
    """
    instants = [seen for masks in frames if len(seen := _instant(cameras, masks)) >= 3]
    if not instants:
        return None
    shifts = np.zeros((len(cameras), 2))
    before = best = _filled(instants, shifts)
    for step in _STEPS:
        for camera in {c for seen in instants for c in seen if only in (None, c)}:
            diagonal = float(np.hypot(cameras[camera].width, cameras[camera].height))
            for axis in (0, 1):
                tried = []
                for n in range(-_FARTHEST, _FARTHEST + 1):
                    other = shifts.copy()
                    other[camera, axis] += n * step * diagonal
                    held = float(((other[camera] / diagonal) ** 2).sum())
                    tried.append((_filled(instants, other) - _HELD * held / 0.01, -abs(n), other))
                shifts = max(tried, key=lambda one: one[:2])[2]
    best = _filled(instants, shifts)
    return Alignment(shifts, best, before)


def moved_cameras(
    cameras: Sequence[Camera],
    frames: Sequence[Sequence[Mask | None]],
    only: int | None = None,
) -> list[str]:
    """Return a word for each camera that seems to have been moved, with the line that mends it."""
    found = aligned(cameras, frames, only)
    if found is None or found.filled - found.filled_before < _CLEARLY:
        return []
    return [
        f"{camera.name} seems to have been moved by {np.hypot(*shift):.0f} px since it was "
        f"calibrated (the silhouettes fill each other to {found.filled_before:.0%}, "
        f"to {found.filled:.0%} with all cameras mended); try {pixel_map(shift)} in its "
        "[[camera]], added to what may be there"
        for camera, shift in zip(cameras, found.shifts, strict=True)
        if np.hypot(*shift) > 2 * _STEPS[-1] * np.hypot(camera.width, camera.height)
    ]


def pixel_map(shift: Array) -> str:
    """Return the line of SCENE.toml that takes a camera's shift, (2,) px, into account."""
    column, row = (round(float(-x), 1) + 0.0 for x in shift)
    return f"calibration_pixel = {{ scale = 1.0, shift = [{column}, {row}] }}"


def _instant(cameras: Sequence[Camera], masks: Sequence[Mask | None]) -> dict[int, _Seen]:
    able = {c: m for c, m in enumerate(masks) if m is not None and m.any()}
    if not able:
        return {}
    middle = _middle(cameras, able)
    axis = np.arange(-_REACH, _REACH, _SIDE)
    points = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), -1).reshape(-1, 3) + middle
    for c, mask in able.items():  # what no shift brings into the silhouette is left out
        reach = round(sum(_STEPS) * _FARTHEST * np.hypot(*mask.shape))
        grown = cv2.dilate(mask.astype(np.uint8), np.ones((2 * reach + 1, 2 * reach + 1))) > 0
        points = points[_looked_up(grown, cameras[c].project(points))]
    return {c: _seen(cameras[c], mask, points) for c, mask in able.items()}


def _seen(camera: Camera, mask: Mask, points: Array) -> _Seen:
    diagonal = float(np.hypot(*mask.shape))
    cell = _CELL * diagonal
    n_rows, n_columns = int(mask.shape[0] / cell) + 1, int(mask.shape[1] / cell) + 1
    rows, columns = np.nonzero(mask)
    at = (rows / cell).astype(int) * n_columns + (columns / cell).astype(int)
    weights = np.bincount(at, minlength=n_rows * n_columns) / len(rows)
    pixels = camera.project(points).astype(np.float32)
    return _Seen(pixels, mask, weights, n_columns, cell, diagonal)


def _filled(instants: Sequence[dict[int, _Seen]], shifts: Array) -> float:
    """Return the share of the silhouettes that is filled, the mean over cameras and instants."""
    shares = []
    for seen in instants:
        moved = {c: one.pixels + shifts[c].astype(np.float32) for c, one in seen.items()}
        inside = np.ones(len(next(iter(moved.values()))), dtype=bool)
        for c, one in seen.items():
            inside[inside] = _looked_up(one.mask, moved[c][inside])
        for c, one in seen.items():
            columns, rows = (moved[c][inside] / one.cell).astype(int).T
            shares.append(float(one.weights[np.unique(rows * one.n_columns + columns)].sum()))
    return float(np.mean(shares))


def _looked_up(mask: Mask, pixels: Array) -> Mask:
    """Return whether each pixel, (n, 2), is in the mask; False outside the image."""
    # beside a camera, or behind it, a point may be projected as far away as numbers go
    known = np.nan_to_num(np.rint(pixels), nan=-1, posinf=-1, neginf=-1)
    columns, rows = np.clip(known, -1, 1e6).astype(int).T
    height, width = mask.shape
    shown = (rows >= 0) & (rows < height) & (columns >= 0) & (columns < width)
    found = np.zeros(len(pixels), dtype=bool)
    found[shown] = mask[rows[shown], columns[shown]]
    return found


def _middle(cameras: Sequence[Camera], masks: dict[int, Mask]) -> Array:
    """Return the point nearest to the lines of sight through the silhouettes' middles."""
    total, right = np.zeros((3, 3)), np.zeros(3)
    for c, mask in masks.items():
        rows, columns = np.nonzero(mask)
        ray = cameras[c].rays(np.array([[np.median(columns), np.median(rows)]]))[0]
        across = np.eye(3) - np.outer(ray, ray)
        total += across
        right += across @ cameras[c].centre
    return np.asarray(np.linalg.lstsq(total, right)[0])
