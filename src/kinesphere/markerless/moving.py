"""What has moved: an image against the same camera's others, for want of an empty room's."""

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Frame, Scene
from kinesphere.markerless.hull import largest_piece_of_space
from kinesphere.markerless.kernels.contour import project_kernel
from kinesphere.markerless.views import View

Picture = NDArray[np.uint8]

_INSTANTS = 11
"""Instants whose median stands for the room."""
_SPAN = 6.0
"""s about the start in which they are taken: light changes slowly."""
_SHADOW = (0.6, 1.25)
"""How much darker or brighter the same thing may have become."""
_SPECK = 2e-4
"""Share of an image below which a piece that has moved is noise."""
_MOST = 0.3
"""Share of an image above which it is the camera or the light that has changed."""

_FAR = 2.0
"""m about the point looked at in which somebody may move."""
_SIDE = 0.08
"""m, of the cubes in which they are looked for."""
_NEAR = 7
"""px; gaps in what has moved."""
_TALL = 1.0
"""m; what has moved is that high, or it was not the whole person."""


def instants_about(scene: Scene, first: int) -> list[Frame]:
    """Return some frames of the scene about the first one, evenly spread."""
    half = round(_SPAN / 2 * scene.rate)
    low = max(0, min(first - half, scene.n_frames - 2 * half))
    high = min(scene.n_frames, low + 2 * half)
    every = max(1, (high - low) // _INSTANTS)
    return list(scene.frames(low, high, every))


def rooms(views: Sequence[View], frames: Sequence[Frame]) -> list[Picture | None]:
    """Return the median of each camera's images: the room, as far as the person does not stay.

    None for a camera with fewer than three.
    """
    out: list[Picture | None] = []
    for i, view in enumerate(views):
        pictures = [view.image(f.images[i]) for f in frames if f.images[i] is not None]
        enough = len(pictures) > 2
        out.append(np.median(pictures, axis=0).astype(np.uint8) if enough else None)
    return out


def moved_since(picture: Picture, room: Picture) -> Picture:
    """Return where an image differs from the room, 0 or 255.

    Brightness is divided out as in `plate_difference`, but all pieces count that are no specks.
    """
    now, then = (cv2.GaussianBlur(p, (5, 5), 0).astype(np.float32) for p in (picture, room))
    brightness = (now * then).sum(axis=2) / np.maximum((then * then).sum(axis=2), 1.0)
    apart = np.linalg.norm(now - np.clip(brightness, *_SHADOW)[..., None] * then, axis=2)
    noise = float(np.median(apart)) + 0.5
    different = (apart > max(8 * noise, 8.0)).astype(np.uint8)
    different = cv2.morphologyEx(different, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
    _, labels, stats, _ = cv2.connectedComponentsWithStats(different)
    large = stats[:, cv2.CC_STAT_AREA] >= _SPECK * different.size
    large[0] = False
    out = large[labels]
    return np.asarray(out * np.uint8(255 if out.mean() < _MOST else 0), dtype=np.uint8)


def place_of(
    views: Sequence[View], moved: Sequence[Picture | None], looked_at: Array
) -> Array:
    """Return about where the person's middle is, (3,) m: where all cameras see things move.

    The point that the cameras look at is returned where they agree on nothing, or on arms alone.
    """
    axis = np.arange(-_FAR, _FAR + _SIDE, _SIDE)
    points = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), -1).reshape(-1, 3) + looked_at
    for_it, shown_by = np.zeros(len(points), dtype=int), np.zeros(len(points), dtype=int)
    pixels, depths = np.empty((len(points), 2)), np.empty(len(points))
    for view, mask in zip(views, moved, strict=True):
        if mask is None:
            continue
        project_kernel(points, view.rotation, view.shift, view.lens, pixels, depths)
        near = cv2.dilate(mask, np.ones((_NEAR, _NEAR), np.uint8)) > 0
        col, row = np.nan_to_num(np.rint(pixels), nan=-1).clip(-1, 1e6).astype(int).T
        shown = (row >= 0) & (row < view.height) & (col >= 0) & (col < view.width)
        shown_by += shown
        for_it[shown] += near[row[shown], col[shown]]
    agreed = points[(shown_by == for_it) & (for_it >= min(3, len(views)))]
    if len(agreed) == 0:
        return looked_at
    piece = largest_piece_of_space(agreed, _SIDE)
    low, high = piece.min(axis=0), piece.max(axis=0)
    return np.asarray(0.5 * (low + high)) if high[1] - low[1] > _TALL else looked_at
