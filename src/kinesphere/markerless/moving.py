"""What has moved: an image against the same camera's others, for want of an empty room's."""

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Frame, Scene
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
        images = [f.images[i] for f in frames]
        pictures = [view.image(picture) for picture in images if picture is not None]
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
