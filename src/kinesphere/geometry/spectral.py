"""Spectral clustering from distances: self-tuning affinity, embedding, eigengap, k-means.

Ng, Jordan & Weiss, "On spectral clustering", NIPS 2001; the affinity's local scale after
Zelnik-Manor & Perona, "Self-tuning spectral clustering", NIPS 2004.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Labels = NDArray[np.intp]


class Spectrum(NamedTuple):
    """Eigenvalues and eigenvectors of a normalised affinity, the largest first."""

    values: Array
    """(n,) 1 … −1; as many ones as there are parts that nothing connects."""
    vectors: Array
    """(n, n), one a column."""

    def embedding(self, k: int) -> Array:
        """Return (n, k) unit rows: points of one cluster lie together, clusters at right angles."""
        rows = self.vectors[:, :k]
        length = np.linalg.norm(rows, axis=1, keepdims=True)
        return np.asarray(rows / np.where(length > 0, length, 1.0))

    def eigengap(self, low: int, high: int) -> int:
        """Return the number of clusters from low to high after which the values drop most."""
        high = min(high, len(self.values) - 1)
        if high < low:
            return min(low, len(self.values))
        drop = self.values[low - 1 : high] - self.values[low : high + 1]
        return low + int(drop.argmax())


def self_tuning_affinity(distances: Array, neighbour: int = 2, least: float = 0.0) -> Array:
    """Return exp(−d² / (2 s_i s_j)), s the distance to a point's own ``neighbour``-th nearest.

    Parameters
    ----------
    distances : (n, n)
        Symmetric; NaN where nothing is known of a pair, whose affinity then is zero.
    neighbour
        Which neighbour sets the scale, from 1: at most the others in the smallest cluster.
    least
        The smallest scale, in the unit of the distances: their noise. Without it two points that
        agree by chance, or coincide, part from all others.

    Returns
    -------
    (n, n) 0…1, zero on the diagonal.
    """
    n = len(distances)
    d = np.array(distances, dtype=np.float64)
    np.fill_diagonal(d, np.nan)
    known = np.sort(d, axis=1)  # NaN goes last
    reach = np.minimum(np.isfinite(d).sum(axis=1), neighbour) - 1
    scale = np.where(reach >= 0, known[np.arange(n), np.maximum(reach, 0)], np.nan)
    widest = np.nanmax(d) if np.isfinite(d).any() else 0.0
    scale = np.maximum(scale, max(least, 1e-6 * widest) or 1.0)  # copies have none of their own
    affinity = np.exp(-(d**2) / (2 * scale[:, None] * scale[None, :]))
    return np.where(np.isfinite(affinity), affinity, 0.0)


def spectrum(affinity: Array) -> Spectrum:
    """Return the spectrum of D^(−1/2) A D^(−1/2), (n, n) symmetric and not negative.

    A point that nothing connects to gets a part of its own.
    """
    degree = affinity.sum(axis=1)
    alone = degree <= 0
    root = np.where(alone, 1.0, np.sqrt(np.where(alone, 1.0, degree)))
    normalised = affinity / root[:, None] / root[None, :] + np.diag(alone.astype(float))
    values, vectors = np.linalg.eigh((normalised + normalised.T) / 2)
    return Spectrum(values[::-1], vectors[:, ::-1])


def k_means(points: Array, k: int, rng: np.random.Generator, restarts: int = 15) -> Labels:
    """Return which of k clusters each point belongs to, the best of several starts.

    The first start is Ng, Jordan & Weiss's own: every next centre the point farthest from those
    before; the others draw them (k-means++, Arthur & Vassilvitskii 2007).

    Parameters
    ----------
    points : (n, d)
        Finite.
    k
        1 to n.

    Returns
    -------
    (n,) clusters numbered in the order of their first points; k of them, unless there are fewer
    distinct points.
    """
    if not 1 <= k <= len(points):
        raise ValueError(f"{len(points)} points cannot make {k} clusters")
    best, least = np.zeros(len(points), dtype=np.intp), np.inf
    for start in range(restarts + 1):
        labels, cost = _lloyd(points, _first_centres(points, k, rng if start else None))
        if cost < least - 1e-12:
            best, least = labels, cost
    return renumbered(best)


def renumbered(labels: Labels) -> Labels:
    """Return cluster numbers in the order of their first members, (n,) → (n,)."""
    _, first, inverse = np.unique(labels, return_index=True, return_inverse=True)
    return np.asarray(np.argsort(np.argsort(first))[inverse])


def _first_centres(points: Array, k: int, rng: np.random.Generator | None) -> Array:
    off_middle = ((points - points.mean(axis=0)) ** 2).sum(axis=1)
    first = int(off_middle.argmin()) if rng is None else int(rng.integers(len(points)))
    centres = [points[first]]
    nearest = ((points - centres[0]) ** 2).sum(axis=1)
    for _ in range(1, k):
        total = nearest.sum()
        if rng is None or total <= 0:
            chosen = int(nearest.argmax())
        else:
            chosen = int(rng.choice(len(points), p=nearest / total))
        centres.append(points[chosen])
        nearest = np.minimum(nearest, ((points - centres[-1]) ** 2).sum(axis=1))
    return np.array(centres)


def _lloyd(points: Array, centres: Array) -> tuple[Labels, float]:
    labels = np.full(len(points), -1, dtype=np.intp)
    for _ in range(100):
        square = ((points[:, None] - centres[None]) ** 2).sum(axis=2)
        nearest = square.argmin(axis=1)
        if (nearest == labels).all():
            break
        labels = nearest
        for c in range(len(centres)):
            if (own := labels == c).any():
                centres[c] = points[own].mean(axis=0)
    return labels, float(square.min(axis=1).sum())
