"""Where several cameras' keypoints are in space, wrong ones left out."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from kinesphere.data import Array, Camera

_TOLERANCE = 0.02
"""Share of an image's longer side by which a keypoint may miss its point: 13 px of 640."""


@dataclass(frozen=True, eq=False)
class Triangulated:
    """Keypoints in space."""

    points: Array
    """(n, 3) m; NaN where no two cameras agree."""
    seen: int
    """Keypoints that two cameras at least see."""


def triangulated(cameras: Sequence[Camera], pixels: Array, confidence: Array) -> Triangulated:
    """Return where keypoints are.

    Each pair of cameras proposes a point, the one nearest to its two lines of sight; the one with
    which most cameras agree wins (Fischler and Bolles 1981, doi:10.1145/358669.358692, all samples
    drawn) and is found anew from all of these, weighted by confidence and by how near they are.

    Parameters
    ----------
    pixels, confidence
        (n_cameras, n, 2) px and (n_cameras, n); 0 where a camera does not see one.
    """
    use = (confidence > 0) & np.isfinite(pixels).all(axis=-1)
    rays = np.array([c.rays(p) for c, p in zip(cameras, pixels, strict=True)])
    use &= np.isfinite(rays).all(axis=-1)
    rays = np.where(use[..., None], rays, 0.0)
    weights = np.where(use, confidence, 0.0)
    n = pixels.shape[1]
    best, most, least = np.zeros(use.shape, dtype=bool), np.zeros(n), np.full(n, np.inf)
    for pair in combinations(range(len(cameras)), 2):
        both = use[list(pair)].all(axis=0)
        only = np.zeros(use.shape)
        only[list(pair)] = both
        points = _nearest(cameras, rays, only)
        off = _misses(cameras, points, pixels)
        agree = use & (off < _TOLERANCE)
        votes = agree.sum(axis=0)
        cost = np.where(agree, off, 0.0).sum(axis=0)
        # a pair whose own keypoints miss its point, or lie behind a camera, proposes nothing
        own = both & agree[list(pair)].all(axis=0)
        better = own & ((votes > most) | ((votes == most) & (cost < least)))
        best[:, better], most[better], least[better] = agree[:, better], votes[better], cost[better]
    points = _nearest(cameras, rays, weights * best)
    for _ in range(2):  # a pixel is worth more on a near camera
        depth = np.array([c.depths(points) for c in cameras])
        near = np.where(best, 1 / np.maximum(np.nan_to_num(depth, nan=1.0), 0.1) ** 2, 0.0)
        points = _nearest(cameras, rays, weights * near)
    return Triangulated(points, int((use.sum(axis=0) >= 2).sum()))


def _nearest(cameras: Sequence[Camera], rays: Array, weights: Array) -> Array:
    """Return the points nearest to weighted lines of sight, (n, 3); NaN for fewer than two."""
    across = np.eye(3) - rays[..., :, None] * rays[..., None, :]  # (n_cameras, n, 3, 3)
    total = np.einsum("cn,cnij->nij", weights, across)
    centres = np.array([c.centre for c in cameras])
    right = np.einsum("cn,cnij,cj->ni", weights, across, centres)
    told = (weights > 0).sum(axis=0) >= 2
    # lines that are nearly parallel meet nowhere in particular
    told &= np.linalg.eigvalsh(total)[:, 0] > 1e-4 * np.trace(total, axis1=1, axis2=2)
    points = np.full(right.shape, np.nan)
    points[told] = np.linalg.solve(total[told], right[told][..., None])[..., 0]
    return points


def _misses(cameras: Sequence[Camera], points: Array, pixels: Array) -> Array:
    """Return how far points miss their keypoints, (n_cameras, n) as a share of the image."""
    out = np.full(pixels.shape[:2], np.inf)
    for i, camera in enumerate(cameras):
        off = np.linalg.norm(camera.project(points) - pixels[i], axis=-1)
        out[i] = np.nan_to_num(off / max(camera.width, camera.height), nan=np.inf)
    return out
