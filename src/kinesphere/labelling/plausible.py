"""Which points may be markers of a body at all, and whether anything moves."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, TopologicalModel
from kinesphere.geometry.pair_distances import pair_distances
from kinesphere.geometry.signature import FRAMES, Signature, evenly_spread, scale_of

LOOSE = (4.0, 0.04)
"""A point is rigid with nothing if its second-steadiest distance varies by more than this many
times what is usual, and by more than this share of the scale."""
SPARE = 1.5
"""Most points looked at, as a multiple of the labels: the longest seen ones."""
STILL = 0.0005
"""Median deviation of distances, in scales, below which nothing moves: 3 mm on a full layout.
Standing quietly is less, any movement ten times as much."""
MOVING = (4.0, 0.1)
"""Somebody who rests but for a limb moves: this share of the distances varies by so many times
that. One arm of a full layout moves 0.24 of them, both arms 0.45, a standing trial none."""


def is_still(found: Signature) -> bool:
    """Tell whether nothing moves against anything else, be it a limb alone."""
    return _still(found.mean, found.std)


def learnt_standing(model: TopologicalModel) -> bool:
    """Tell whether nothing moves in any of the recordings a model was learnt from."""
    return all(_still(one.mean, one.deviation) for one in model.statistics)


def _still(mean: Array, deviation: Array) -> bool:
    known = np.isfinite(mean).sum(axis=1) > 1
    pairs = deviation[np.triu_indices(len(deviation), 1)]
    pairs = pairs[np.isfinite(pairs)]
    limit = STILL * scale_of(mean[np.ix_(known, known)]) if known.any() else 0.0
    if not len(pairs):
        return True
    moving = float((pairs > MOVING[0] * limit).mean()) > MOVING[1]
    return float(np.median(pairs)) < limit and not moving


def plausible(points: Array, seen: NDArray[np.bool_], n_labels: int) -> NDArray[np.intp]:
    """Return the points that may be markers of a body: seen long, and steady beside others."""
    count = seen.sum(axis=0)
    kept = np.flatnonzero(count >= 2)
    if len(kept) <= n_labels:
        return kept
    most = int(SPARE * n_labels) + 4
    if len(kept) > most:
        kept = np.sort(kept[np.argsort(-count[kept], kind="stable")[:most]])
    found = _deviations(points[:, kept])
    steady = np.sort(np.where(np.isnan(found), np.inf, found), axis=1)[:, 2]
    limit = max(LOOSE[0] * float(np.median(steady)), LOOSE[1])
    return kept[steady <= limit]


def in_own_order(points: Array, kept: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return these points in an order that does not depend on theirs: by their distances.

    The search draws exchanges at random; so the same points give the same labels in any order.
    """
    mean = pair_distances(points[evenly_spread(len(points), FRAMES)][:, kept]).mean
    ranked = np.sort(np.where(np.isfinite(mean), mean, np.inf), axis=1)
    n = len(kept)
    return kept[np.lexsort((ranked[:, n // 4], ranked[:, n // 2]))]


def _deviations(points: Array) -> Array:
    """Return deviations of distances in scales, NaN where never seen together; (n, n)."""
    found = pair_distances(points[evenly_spread(len(points), FRAMES)])
    return np.asarray(found.std / scale_of(found.mean))
