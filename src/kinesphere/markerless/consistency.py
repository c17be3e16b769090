"""Do the cameras agree? What one sees at the person's rim, the others must see somewhere.

A line of sight through a silhouette passes through the person, so somewhere along it is a point
that lies in every other silhouette as well: the visual hull touches every line. The distance, in
pixels, by which no such point exists measures calibration and synchronisation together, without a
model (visual hulls: Laurentini 1994, doi:10.1109/34.273735).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Camera, Mask
from kinesphere.markerless.kernels.sight import hold_against_kernel, least_kernel

RAYS = 128
"""Lines of sight taken along one silhouette's rim."""
_STEPS = 160
"""Points along each of them."""
_REACH = 1.4
"""m around the person's middle in which they lie."""
_BORDER = 3
"""px; a silhouette that reaches the border goes on outside."""
_FAR = 8.0
"""px; farther off is not worse, for a comparison of shifts."""
_CLEARLY = 0.5
"""Without the camera that is wrong, the others contradict each other by so much less."""
_AS_GOOD = 0.1
"""Shares of the disagreement that differ by less are no choice between two cameras."""
_SHARE = 0.9
"""Quantile over lines: a hand that one mask lacks must not speak for a camera."""


@dataclass(frozen=True, eq=False)
class Sight:
    """One camera at one instant: how far every pixel is from the person, and lines through it."""

    outside: NDArray[np.float32]
    """(height, width) px from the silhouette, 0 inside."""
    pixels: tuple[NDArray[np.float32], ...]
    """For each camera, (n_lines, _STEPS, 2) where the lines of sight through this silhouette's rim
    appear there."""


def sights(
    cameras: Sequence[Camera], frames: Sequence[tuple[Mask | None, ...]]
) -> list[list[Sight | None]]:
    """Return, for each frame, what each camera knows; None where it has no silhouette."""
    middle = middle_of(cameras, frames)
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
            outside = np.asarray(
                cv2.distanceTransform((~mask).astype(np.uint8), cv2.DIST_L2, 3), dtype=np.float32
            )
            row.append(
                Sight(outside, tuple(other.project(points).astype(np.float32) for other in cameras))
            )
        found.append(row)
    return found


def distances(
    seen: Sequence[Sequence[Sight | None]],
    *,
    without: int | None = None,
    late: tuple[int, int] = (-1, 0),
    margin: int = 0,
) -> Array:
    """Return, for lines of sight of all cameras and frames, how far from the person they pass, px.

    Parameters
    ----------
    seen
        As `sights` returns it.
    without
        A camera to leave out.
    late : (camera, frames)
        A camera to be taken so many frames later than the others.
    margin
        Frames left out at either end, at least the lateness.
    """
    camera, shift = late
    far: list[NDArray[np.float32]] = []
    for t in range(margin, len(seen) - margin):
        row = list(seen[t])
        if camera >= 0:
            row[camera] = seen[t + shift][camera]
        far += [
            _off(sight, c, row, without)
            for c, sight in enumerate(row)
            if sight is not None and c != without
        ]
    values = np.concatenate(far).astype(np.float64) if far else np.empty(0)
    return values[np.isfinite(values)]


def disagreement(seen: Sequence[Sequence[Sight | None]], without: int | None = None) -> float:
    """Return by how many pixels silhouettes contradict each other: a high quantile over lines.

    NaN where fewer than two cameras have silhouettes.
    """
    far = distances(seen, without=without)
    return float(np.quantile(far, _SHARE)) if len(far) else float("nan")


def find_culprit(seen: Sequence[Sequence[Sight | None]]) -> int | None:
    """Return the camera without which the others agree; None where that is no single one."""
    n = len(seen[0])
    if n < 3:
        return None  # of two, either may be wrong
    left = np.array([cost(distances(seen, without=c)) for c in range(n)])
    order = np.argsort(left)
    best, second = left[order[0]], left[order[1]]
    return int(order[0]) if best < _CLEARLY * second else None


@dataclass(frozen=True)
class Lateness:
    """A camera that, shown so many frames later, agrees better with the others."""

    camera: int
    frames: int
    """Positive where the camera's images come later than they should; 0: none does better."""
    mended: float
    """The share of the cameras' disagreement that taking it so mends."""


def find_lateness(seen: Sequence[Sequence[Sight | None]], most: int) -> list[Lateness]:
    """Return the cameras whose time may be off, and by how much; the likeliest first.

    Several where silhouettes cannot tell: of two opposite cameras, one that comes earlier is as
    good as the other that comes later.

    Parameters
    ----------
    seen
        Of successive frames, more than twice ``most``.
    most
        Largest lateness looked for, in frames.
    """
    unmoved = cost(distances(seen, margin=most))
    if not unmoved > 0:
        return []
    found = []
    for camera in range(len(seen[0])):
        shifts = sorted((s for s in range(-most, most + 1) if s), key=abs)
        costs = [cost(distances(seen, late=(camera, s), margin=most)) for s in shifts]
        best = int(np.argmin(costs))
        if costs[best] < unmoved:
            found.append(Lateness(camera, shifts[best], 1 - costs[best] / unmoved))
    found.sort(key=lambda late: -late.mended)
    return [late for late in found if late.mended > found[0].mended - _AS_GOOD]


def cost(far: Array) -> float:
    """Return the mean distance, lines that are far off counted as `_FAR`."""
    return float(np.minimum(far, _FAR).mean()) if len(far) else float("nan")


def _off(
    sight: Sight, c: int, row: Sequence[Sight | None], without: int | None
) -> NDArray[np.float32]:
    """Return each line's least distance, (n_lines,), from lying in all other silhouettes."""
    shape = sight.pixels[c].shape[:2]
    worst, unseen = np.full(shape, -1, dtype=np.float32), np.zeros(shape, dtype=np.bool_)
    for k, other in enumerate(row):
        if other is not None and k not in (c, without):
            hold_against_kernel(sight.pixels[k], other.outside, worst, unseen)
    unseen |= worst < 0  # nobody else looks
    least = np.empty(shape[0], dtype=np.float32)
    least_kernel(worst, unseen, least)
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


def middle_of(cameras: Sequence[Camera], frames: Sequence[tuple[Mask | None, ...]]) -> Array:
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
    return np.asarray(np.linalg.lstsq(a, b, rcond=None)[0], dtype=np.float64)
