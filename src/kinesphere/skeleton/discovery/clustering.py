"""Markers into bodies, and how sure their number is: two ways, by name."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.spatial.distance import squareform

from kinesphere.data import Array
from kinesphere.geometry.spectral import k_means, renumbered, self_tuning_affinity, spectrum

Labels = NDArray[np.intp]

NEIGHBOUR = 2
"""Which neighbour sets a marker's scale: bodies have three markers or, with a joint's, two."""
SEED = 2005
"""Of k-means' starts: the same input gives the same bodies."""


@dataclass(frozen=True, eq=False)
class Clustering:
    """Which body each marker is of."""

    labels: Labels
    """(n,) numbered in the order of their first markers."""
    gaps: Mapping[int, float]
    """Number of bodies → how much it is preferred; the method's own measure."""

    @property
    def n_bodies(self) -> int:
        """How many bodies there are."""
        return int(self.labels.max()) + 1

    @property
    def count_confidence(self) -> float:
        """0…1: how far the number of bodies stands out against the second best."""
        ordered = sorted(self.gaps.values(), reverse=True)
        if len(ordered) < 2 or ordered[0] <= 0:
            return 1.0
        return float(np.clip(1 - ordered[1] / ordered[0], 0.0, 1.0))


def spectral(unlikeness: Array, bodies: int | None) -> Clustering:
    """Group by self-tuning spectral clustering, the number of bodies by the largest eigengap.

    Huang & Xia (2010, eq. 1) cluster so; with the second neighbour as scale rather than the fifth,
    which in a body of three or four markers lies outside it.

    Parameters
    ----------
    unlikeness : (n, n)
        NaN where nothing is known of a pair.
    bodies
        How many; None to find out.
    """
    n = len(unlikeness)
    found = spectrum(self_tuning_affinity(unlikeness, NEIGHBOUR))
    high = _most_bodies(n)
    drops = found.values[:high] - found.values[1 : high + 1]
    gaps = {k: float(drops[k - 1]) for k in range(2, high + 1)}
    k = bodies or found.eigengap(2, high)
    k = min(k, n)
    labels = k_means(found.embedding(k), k, np.random.default_rng(SEED))
    return Clustering(labels, gaps)


def by_linkage(unlikeness: Array, bodies: int | None) -> Clustering:
    """Group by average linkage, cut where the next merger is worst against the one before.

    Parameters
    ----------
    unlikeness : (n, n)
        NaN where nothing is known of a pair: as unlike as any.
    bodies
        How many; None to find out.
    """
    n = len(unlikeness)
    merges = linkage(_condensed(unlikeness), "average")
    heights = np.maximum(merges[:, 2], 1e-3 * np.median(merges[:, 2]) + 1e-12)
    high = _most_bodies(n)
    # before merger i there are n - i bodies
    gaps = {k: float(np.log(heights[n - k] / heights[n - k - 1])) for k in range(2, high + 1)}
    k = bodies or max(gaps, key=lambda count: gaps[count], default=1)
    labels = fcluster(merges, min(k, n), "maxclust").astype(np.intp)
    return Clustering(renumbered(labels), gaps)


METHODS: Mapping[str, Callable[[Array, int | None], Clustering]] = {
    "spectral": spectral,
    "linkage": by_linkage,
}


def merge_curve(unlikeness: Array, wander: Array, most: int) -> dict[int, float]:
    """Return number of bodies → rms wander in m within bodies, merging the likest ones in turn.

    What a person looks at to judge the number of bodies: it rises where two bodies that move become
    one.
    """
    n = len(unlikeness)
    merges = linkage(_condensed(unlikeness), "average")
    curve = {}
    for k in range(1, min(most, n - 1) + 1):
        labels = fcluster(merges, k, "maxclust")
        within = wander[(labels[:, None] == labels) & ~np.eye(n, dtype=bool)]
        within = within[np.isfinite(within)]
        curve[k] = float(np.sqrt(np.mean(within**2))) if len(within) else 0.0
    return curve


def _most_bodies(n: int) -> int:
    """Return up to how many bodies ``n`` markers may be: bodies have two or more on average."""
    return min(max(2, n // 2), n - 1)


def _condensed(unlikeness: Array) -> Array:
    known = np.isfinite(unlikeness)
    largest = float(unlikeness[known].max(initial=0.0))
    full = np.where(known, unlikeness, largest)
    np.fill_diagonal(full, 0.0)
    return np.asarray(squareform((full + full.T) / 2, checks=False))
