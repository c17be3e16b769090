"""A person's labels held to their own distances: denied ones go, proved ones come.

The energy of an assignment weighs many loose distances against few tight ones, and may push a
marker to where it cannot be. Here the tight ones have the last word.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.labelling.problem import Labels, Problem
from kinesphere.labelling.same_person import ALIKE, SKIN
from kinesphere.labelling.seating import SEEN, places_of

DENIED = 0.5
"""Share of a marker's distances within segments from which on they deny its label."""
FEWEST = 3
"""Distances that prove a label: two leave a circle."""
RIVAL = 6.0
"""Squares of deviations by which a place of a segment may be worse and still be the true one."""
BETTER = 9.0
"""Squares of deviations by which another place must fit a segment better than where it is."""
CLEAR = 4.0
"""Nats by which one of them must fit the rest of the body better than the others."""


def held_to_distances(
    problem: Problem,
    mean: Array,
    labels: Labels,
    wanted: Array,
    rigid: NDArray[np.bool_],
    segments: Sequence[Sequence[int]],
) -> Labels:
    """Return labels without those that their own distances deny, and with those they prove.

    Parameters
    ----------
    problem
        Whose energy tells places apart that have the same distances, as mirrored ones do.
    mean : (n_points, n_points) m
        Mean distances of the points; NaN where never seen together.
    labels : (n_points,)
        −1 for none.
    wanted, rigid : (n_labels, n_labels)
        Distances of the labels in m, and which of them are kept.
    segments
        Labels of each segment.
    """
    before, labels = labels, labels.copy()
    denied = _drop(mean, labels, wanted, rigid)
    for segment in segments:
        gone = denied.intersection(segment)
        # three markers fit three points by chance, unless most of them have nowhere else to be
        if gone and (len(segment) > FEWEST or 2 * len(gone) > FEWEST):
            worst = _cost(mean, before, wanted, rigid, segment) - BETTER
            _seat_again(problem, mean, labels, wanted, rigid, np.array(segment), worst)
    _drop(mean, labels, wanted, rigid)
    _fill(mean, labels, wanted, rigid)
    return labels


def _drop(mean: Array, labels: Labels, wanted: Array, rigid: NDArray[np.bool_]) -> set[int]:
    """Take the most denied label away until none is; return those taken."""
    taken = set()
    while (labels >= 0).any():
        given = np.flatnonzero(labels >= 0)
        bears, points = np.ix_(labels[given], labels[given]), np.ix_(given, given)
        known = rigid[bears] & np.isfinite(mean[points])
        off = known & (np.abs(mean[points] - wanted[bears]) > ALIKE)
        share = off.sum(axis=1) / np.maximum(known.sum(axis=1), 1)
        worst = int(share.argmax())
        if share[worst] <= DENIED:
            break
        taken.add(int(labels[given[worst]]))
        labels[given[worst]] = -1
    return taken


def _seat_again(
    problem: Problem,
    mean: Array,
    labels: Labels,
    wanted: Array,
    rigid: NDArray[np.bool_],
    segment: Labels,
    worst: float,
) -> None:
    """Give a segment the place of least energy of those that its distances allow.

    Places must not cost more than ``worst``; if there is none, it stays where it is.
    """
    open_to = np.flatnonzero((labels < 0) | np.isin(labels, segment))
    places = places_of(mean[np.ix_(open_to, open_to)], wanted, rigid, SKIN, segment.tolist())
    places = [place for place in places if place.cost <= worst]
    if not places:
        return
    labels[np.isin(labels, segment)] = -1
    tried = []
    for place in places:
        if place.cost <= places[0].cost + RIVAL:
            there = place.points >= 0
            changed = labels.copy()
            changed[open_to[place.points[there]]] = place.labels[there]
            tried.append((problem.energy(changed), changed))
    least, best = min(tried, key=lambda one: one[0])
    near = [changed for energy, changed in tried if energy < least + CLEAR]
    same = np.all([changed == best for changed in near], axis=0)
    labels[same] = best[same]


def _cost(
    mean: Array, labels: Labels, wanted: Array, rigid: NDArray[np.bool_], segment: Sequence[int]
) -> float:
    """Return what a segment costs where it is, as places of it do."""
    points = np.flatnonzero(np.isin(labels, segment))
    bears = labels[points]
    off = (mean[np.ix_(points, points)] - wanted[np.ix_(bears, bears)]) / SKIN
    squares = np.where(rigid[np.ix_(bears, bears)], np.minimum(np.nan_to_num(off**2), SEEN), 0.0)
    return float(squares.sum() / 2 + SEEN * (len(segment) - len(points)))


def _fill(mean: Array, labels: Labels, wanted: Array, rigid: NDArray[np.bool_]) -> None:
    """Give a free label to the one free point that has its distances."""
    for label in np.setdiff1d(np.arange(len(wanted)), labels):
        given = np.flatnonzero((labels >= 0) & rigid[label][labels])
        if len(given) < FEWEST:
            continue
        free = np.flatnonzero(labels < 0)
        off = np.abs(mean[np.ix_(free, given)] - wanted[label, labels[given]])
        fitting = free[(off <= ALIKE).all(axis=1)]
        if len(fitting) == 1:
            labels[fitting[0]] = label
