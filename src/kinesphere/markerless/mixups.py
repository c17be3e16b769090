"""Cameras whose images or places were mixed up, and a person of a size nobody has."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from kinesphere.data import Array, Camera, Frame, Mask
from kinesphere.markerless.consistency import cost, distances, middle_of, sights

_FEW = 4
"""Frames in which pairs are tried; the best pair is judged by all."""
_CAMERAS = 8
"""More have too many pairs."""


@dataclass(frozen=True)
class Swap:
    """Two cameras whose images, exchanged, agree best with the others."""

    first: int
    second: int
    mended: float
    """The share of the cameras' disagreement that exchanging them mends."""


def find_swap(cameras: Sequence[Camera], frames: Sequence[tuple[Mask | None, ...]]) -> Swap | None:
    """Return the two cameras whose silhouettes fit better the other way round, if any do.

    Opposite cameras see nearly mirrored silhouettes, so exchanging them is hardly a contradiction
    in pixels; that it can be mended is what gives it away. None for two cameras, where exchanging
    both is another world and no contradiction, and for cameras with images of unlike sizes.
    """
    n = len(cameras)
    if not 3 <= n <= _CAMERAS:
        return None
    few = frames[:: max(1, len(frames) // _FEW)]
    pairs = [
        (a, b)
        for a, b in combinations(range(n), 2)
        if (cameras[a].width, cameras[a].height) == (cameras[b].width, cameras[b].height)
    ]
    now = _cost(cameras, few)
    if not pairs or not now > 0:
        return None
    first, second = min(pairs, key=lambda pair: _cost(cameras, few, pair))
    before, after = _cost(cameras, frames), _cost(cameras, frames, (first, second))
    return Swap(first, second, 1 - after / before) if after < before else None


def same_pictures(cameras: Sequence[Camera], frame: Frame) -> tuple[str, str] | None:
    """Return the names of two cameras whose images are the same to the last pixel, if any are."""
    shown = [(c.name, p) for c, p in zip(cameras, frame.images, strict=True) if p is not None]
    for (one, a), (other, b) in combinations(shown, 2):
        if np.array_equal(a, b):
            return one, other
    return None


def turned_inside_out(cameras: Sequence[Camera], world_from_file: Array) -> tuple[Camera, ...]:
    """Return the cameras that are meant if a calibration has camera-to-world turns and places."""
    out = []
    for camera in cameras:
        world_from_camera = (camera.rotation @ world_from_file).T
        out.append(
            replace(
                camera,
                rotation=world_from_camera @ world_from_file.T,
                translation=-world_from_camera @ camera.translation,
            )
        )
    return tuple(out)


def person_size(cameras: Sequence[Camera], frames: Sequence[tuple[Mask | None, ...]]) -> float:
    """Return the largest extent of the person, m, as silhouettes show it; NaN without any.

    The diagonal of the silhouette's box at the distance of the person's middle: about the height
    of who stands or lies, more with outstretched arms.
    """
    middle = middle_of(cameras, frames)
    sizes = []
    for masks in frames:
        for camera, mask in zip(cameras, masks, strict=True):
            if mask is None or not mask.any():
                continue
            rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
            diagonal = np.hypot(np.ptp(rows) + 1, np.ptp(columns) + 1)
            sizes.append(diagonal * float(camera.depths(middle)) / camera.matrix[0, 0])
    return float(np.median(sizes)) if sizes else float("nan")


def _cost(
    cameras: Sequence[Camera],
    frames: Sequence[tuple[Mask | None, ...]],
    pair: tuple[int, int] | None = None,
) -> float:
    order = list(range(len(cameras)))
    if pair is not None:
        a, b = pair
        order[a], order[b] = b, a
    found = cost(distances(sights(cameras, [tuple(m[i] for i in order) for m in frames])))
    return float("inf") if np.isnan(found) else found
