"""Do the cameras agree? What one sees at the person's rim, the others must see somewhere.

A line of sight through a silhouette passes through the person, so somewhere along it is a point that
lies in every other silhouette as well: the visual hull touches every line. The distance, in pixels,
by which no such point exists measures calibration and synchronisation together, without a model
(visual hulls: Laurentini 1994, doi:10.1109/34.273735).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Camera, Mask

RAYS = 160
"""Lines of sight taken along one silhouette's rim."""
_STEPS = 96
"""Points along each of them."""
_REACH = 1.7
"""m around the person's middle in which they lie."""
_BORDER = 3
"""px; a silhouette that reaches the border goes on outside."""
_SHARE = 0.95
"""Quantile over lines: a hand that one mask lacks must not speak for a camera."""


@dataclass(frozen=True, eq=False)
class Sight:
    """One camera at one instant: how far every pixel is from the person, and lines through it."""

    outside: NDArray[np.float32]
    """(height, width) px from the silhouette, 0 inside."""
    pixels: tuple[Array, ...]
    """For each camera, (RAYS, _STEPS, 2) where the lines of sight through this silhouette's rim
    appear there."""


def sights(
    cameras: Sequence[Camera], frames: Sequence[tuple[Mask | None, ...]]
) -> list[list[Sight | None]]:
    """Return, for each frame, what each camera knows; None where it has no silhouette."""
    import cv2

    middle = _middle(cameras, frames)
    found: list[list[Sight | None]] = []
    for masks in frames:
        row: list[Sight | None] = []
        for camera, mask in zip(cameras, masks, strict=True):
            if mask is None or not mask.any():
                row.append(None)
                continue
            rim = _rim(mask)
            if not len(rim):
                row.append(None)
                continue
            rays = camera.rays(rim)
            ahead = (middle - camera.centre) @ rays.T
            along = ahead[:, None] + np.linspace(-_REACH, _REACH, _STEPS)
            points = camera.centre + np.maximum(along, 0.05)[..., None] * rays[:, None]
            outside = cv2.distanceTransform((~mask).astype(np.uint8), cv2.DIST_L2, 3)
            row.append(Sight(outside, tuple(other.project(points) for other in cameras)))
        found.append(row)
    return found


def disagreement(
    seen: Sequence[Sequence[Sight | None]],
    without: int | None = None,
    late: tuple[int, int] = (-1, 0),
) -> float:
    """Return by how many pixels silhouettes contradict each other: a high quantile over lines.

    Parameters
    ----------
    seen
        As `sights` returns it.
    without
        A camera to leave out.
    late : (camera, frames)
        A camera to be taken so many frames later than the others.

    Returns
    -------
    float
        NaN where fewer than two cameras have silhouettes.
    """
    camera, shift = late
    far: list[Array] = []
    for t in range(max(0, -shift), len(seen) - max(0, shift)):
        row = list(seen[t])
        if camera >= 0:
            row[camera] = seen[t + shift][camera]
        far += [
            _off(sight, c, row, without)
            for c, sight in enumerate(row)
            if sight is not None and c != without
        ]
    values = np.concatenate(far) if far else np.empty(0)
    values = values[np.isfinite(values)]
    return float(np.quantile(values, _SHARE)) if len(values) else float("nan")


def _off(sight: Sight, c: int, row: Sequence[Sight | None], without: int | None) -> Array:
    """Return each line's least distance, (RAYS,), from lying in all other silhouettes; NaN: alone."""
    worst = np.full(sight.pixels[c].shape[:2], np.nan)
    unseen = np.zeros(worst.shape, dtype=bool)
    for k, other in enumerate(row):
        if other is None or k in (c, without):
            continue
        height, width = other.outside.shape
        pixels = sight.pixels[k]
        with np.errstate(invalid="ignore"):
            inside = (pixels > -0.5).all(axis=-1) & (pixels[..., 0] < width - 0.5)
            inside &= pixels[..., 1] < height - 0.5
        unseen |= ~inside
        at = np.rint(pixels[inside]).astype(np.intp)
        worst[inside] = np.fmax(worst[inside], other.outside[at[:, 1], at[:, 0]])
    # where one camera cannot see it cannot deny: a line that may pass through the person there
    # tells nothing
    tells = ~(unseen & (worst == 0)).any(axis=1)
    worst[unseen] = np.nan
    known = tells & np.isfinite(worst).any(axis=1)
    least = np.full(len(worst), np.nan)
    least[known] = np.nanmin(worst[known], axis=1)
    return least


def _rim(mask: Mask) -> Array:
    """Return RAYS pixels (x, y) evenly along a silhouette's rim, the image's border left out."""
    inner = mask.copy()
    inner[1:] &= mask[:-1]
    inner[:-1] &= mask[1:]
    inner[:, 1:] &= mask[:, :-1]
    inner[:, :-1] &= mask[:, 1:]
    rim = mask & ~inner
    rim[:_BORDER] = rim[-_BORDER:] = False
    rim[:, :_BORDER] = rim[:, -_BORDER:] = False
    rows, columns = np.nonzero(rim)
    if not len(rows):
        return np.empty((0, 2))
    chosen = np.linspace(0, len(rows) - 1, min(RAYS, len(rows))).astype(np.intp)
    return np.stack([columns[chosen], rows[chosen]], axis=-1).astype(np.float64)


def _middle(cameras: Sequence[Camera], frames: Sequence[tuple[Mask | None, ...]]) -> Array:
    """Return the point nearest to the lines of sight through the silhouettes' centroids, (3,) m."""
    a, b = np.zeros((3, 3)), np.zeros(3)
    for masks in frames:
        for camera, mask in zip(cameras, masks, strict=True):
            if mask is None or not mask.any():
                continue
            rows, columns = np.nonzero(mask)
            ray = camera.rays(np.array([columns.mean(), rows.mean()]))
            off = np.eye(3) - np.outer(ray, ray)
            a += off
            b += off @ camera.centre
    middle: Array = np.linalg.lstsq(a, b, rcond=None)[0]
    return middle
