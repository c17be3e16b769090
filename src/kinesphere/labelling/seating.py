"""A person's segments found one by one, by their distances, and seated together on the points.

Where distances within a segment are known to the millimetre, random exchanges of two labels seldom
find it: all its markers must be right before any fits. So each segment is grown marker by marker
over the points that have its distances, and the choice of places is an assignment of segments.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.labelling.problem import Labels, Problem

FEWEST = 3
"""Markers of a segment that is looked for: two have one distance, and many pairs have that."""
BEAM = 300
"""Places of a part of a segment that are kept while it grows."""
PLACES = 40
"""Places of a whole segment that are tried."""
SEEN = 9.0
"""Square of deviations that a marker which is not there costs, and a distance at most."""


class Place(NamedTuple):
    """Where a segment may be."""

    labels: Labels
    points: Labels
    """The point of each label, −1 for one that is not there."""
    cost: float
    """Sum of the squares of deviations."""


def seated(
    problem: Problem,
    mean: Array,
    wanted: Array,
    rigid: NDArray[np.bool_],
    deviation: float,
    segments: Sequence[Sequence[int]],
) -> Labels:
    """Return the labels of points when every segment is where the energy is least.

    Parameters
    ----------
    mean : (n_points, n_points)
        Mean distances of the points; NaN where never seen together.
    wanted, rigid : (n_labels, n_labels)
        Distances of the labels, and which of them hold to ``deviation``.
    segments
        Labels of each segment; a label may be in several.
    """
    places = [
        place
        for labels in segments
        if len(labels) >= FEWEST
        for place in places_of(mean, wanted, rigid, deviation, labels)
    ]
    seats = np.full(problem.n_points, -1, dtype=np.int64)
    energy = 0.0
    while True:
        best = None
        for labels, points, _ in places:
            changed = seats.copy()
            changed[np.isin(changed, labels)] = -1
            there = points >= 0
            changed[points[there]] = labels[there]
            reached = problem.energy(changed)
            if reached < energy - 1e-6 and (best is None or reached < best[0]):
                best = reached, changed
        if best is None:
            return seats
        energy, seats = best


def places_of(
    mean: Array, wanted: Array, rigid: NDArray[np.bool_], deviation: float, labels: Sequence[int]
) -> list[Place]:
    """Return where a segment may be, by its distances alone, the best place first."""
    order = _linked_first(np.array(labels, dtype=np.int64), rigid)
    n = len(mean)
    # each row is a place so far: the points of the labels up to here
    rows = np.append(np.arange(n), -1)[:, None]
    costs = np.where(rows[:, 0] < 0, SEEN, 0.0)
    for k in range(1, len(order)):
        squares = np.zeros((len(rows), n))
        for earlier in range(k):
            if not rigid[order[k], order[earlier]]:
                continue
            points = rows[:, earlier]
            off = (mean[points] - wanted[order[k], order[earlier]]) / deviation
            part = np.minimum(np.nan_to_num(off**2, nan=SEEN), SEEN)
            squares += np.where(points[:, None] < 0, 0.0, part)
        absent = SEEN if rigid[order[k], order[:k]].any() else 0.0
        for column in range(k):
            taken = rows[:, column]
            held = taken >= 0
            squares[held, taken[held]] = np.inf
        total = np.concatenate([costs[:, None] + squares, costs[:, None] + absent], axis=1)
        kept = np.argsort(total, axis=None, kind="stable")[: BEAM if k + 1 < len(order) else PLACES]
        kept = kept[np.isfinite(total.ravel()[kept])]
        row, point = np.divmod(kept, n + 1)
        point = np.where(point == n, -1, point)
        rows, costs = np.column_stack([rows[row], point]), total.ravel()[kept]
    enough = (rows >= 0).sum(axis=1) >= FEWEST
    return [Place(order, row, float(c)) for row, c in zip(rows[enough], costs[enough], strict=True)]


def _linked_first(labels: Labels, rigid: NDArray[np.bool_]) -> Labels:
    """Return a segment's labels so that each has as many distances to earlier ones as can be."""
    inner = rigid[np.ix_(labels, labels)]
    order = [int(inner.sum(axis=1).argmax())]
    while len(order) < len(labels):
        links = inner[:, order].sum(axis=1).astype(float)
        links[order] = -1.0
        order.append(int(links.argmax()))
    return labels[order]
