"""Points that stay where they are while others move: props more likely than markers.

A table, a plate on the floor, a wand laid down. A standing person's feet rest as well, so this is
a guess to start from: what rests is set aside, and comes in where the body lacks it.
"""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.geometry.signature import FRAMES, Signature, evenly_spread, signature
from kinesphere.labelling.kernels import linear_terms
from kinesphere.labelling.layout import Layout, Solved
from kinesphere.labelling.problem import Labels, problem_of
from kinesphere.labelling.solving import scale_by_labels, solve
from kinesphere.labelling.template import LEAST_LABELS

RESTING = 0.03
"""A point rests if it spreads over less than this share of what the middle point spreads over in
the same frames: props have 0.01 and less, feet that stand 0.005 to 0.2, what walks 0.8 and more."""

FITTING = 1.8
"""Nats a pair by which a resting point must fit its label better than nothing: feet that stand have
2.0 to 2.8, props in a missing marker's place 0.5 to 2.4."""
FEWEST = 3
"""Resting points that must fit for any to come in, or all of them where they are fewer: a foot that
stands rests as a whole."""
COMPANY = (4, 2, 0.15)
"""Nearest labels that a label of a resting point is seen beside, those of them whose points must
stay about where they are as well, and what these may spread over, as above."""


def resting(points: Array) -> NDArray[np.bool_]:
    """Return which points rest in the room while most others move, (n_points,).

    Parameters
    ----------
    points : (n_frames, n_points, 3)
        NaN where not seen.
    """
    return np.asarray(np.diag(spreads(points)) < RESTING)


def spreads(points: Array) -> Array:
    """Return how far points spread while others are seen, as shares of the middle point's spread.

    Returns
    -------
    (n_points, n_points)
        Of the second point, in the frames that show the first; NaN where fewer than two show both.
    """
    some = points[evenly_spread(len(points), FRAMES)]
    seen = np.asarray(np.isfinite(some).all(axis=2))
    n = some.shape[1]
    found = np.full((n, n), np.nan)
    for i in range(n):
        there = some[seen[:, i]]
        both = seen[seen[:, i]].sum(axis=0) >= 2
        if both.sum() < 2:
            continue
        spread = np.sqrt(np.nanvar(there[:, both], axis=0).sum(axis=1))
        middle = float(np.median(spread))
        if middle > 0:
            found[i, both] = spread / middle
    return found


def solved_apart(
    points: Array, found: Signature, layout: Layout
) -> tuple[Solved, NDArray[np.intp]]:
    """Search for labels with what rests set aside, which then gets the labels it fits beside them.

    Props join the shortest tree that scales are measured by, and may fit a foot as well as the
    foot does. Where labels of what moves do not come out, all points are searched at once.

    Parameters
    ----------
    points : (n_frames, n_points, 3)
        NaN where not seen.
    found
        Their statistics.

    Returns
    -------
    solved
    some
        The points it is about: the others are no markers.
    """
    every = np.arange(points.shape[1])
    rests = resting(points)
    moving = np.flatnonzero(~rests)
    # one marker of a foot may rest for two seconds; nothing says it is a prop
    few = len(every) <= layout.template.n and rests.sum() < FEWEST
    if not rests.any() or few or len(moving) < LEAST_LABELS:
        return solve(found, layout), every
    alone = solve(signature(points[:, moving]), layout)
    if alone.converged == 0:
        return solve(found, layout), every
    labels = np.full(len(every), -1, dtype=np.int64)
    labels[moving] = alone.labels
    joined = _joined(points, found, layout, labels, np.flatnonzero(rests))
    if (joined == labels).all():
        return alone, moving
    return solve(found, layout, joined), every


def _joined(
    points: Array, found: Signature, layout: Layout, labels: Labels, rest: NDArray[np.intp]
) -> Labels:
    """Return labels with those that nobody bears on the resting points that fit them."""
    free = np.setdiff1d(np.arange(layout.template.n), labels)
    if not len(free):
        return labels
    scale = scale_by_labels(found, labels, layout.template)
    problem = problem_of(found, scale, layout.template)
    joined = problem.descend(labels, nullable=True, points=rest, targets=free)
    came = rest[joined[rest] >= 0]
    fit = -linear_terms(joined, problem.costs)[came, joined[came]] / max((joined >= 0).sum() - 1, 1)
    alone = ~accompanied(points, joined, layout.near)[came]
    joined[came[(fit < FITTING) | alone]] = -1
    # where most of what rests are props, one of them fits by chance
    return joined if (joined[rest] >= 0).sum() >= min(FEWEST, len(rest)) else labels


def accompanied(points: Array, labels: Labels, near: Labels) -> NDArray[np.bool_]:
    """Return which points do not rest, or rest as their neighbours do: a limb rests as a whole.

    Parameters
    ----------
    points : (n_frames, n_points, 3)
        NaN where not seen.
    labels : (n_points,)
        −1 for none.
    near : (n_labels, n_labels)
        For each label all labels, itself and the nearest first.
    """
    spread = spreads(points)
    nearest, fewest, far = COMPANY
    fine = np.ones(len(labels), dtype=bool)
    for i in np.flatnonzero((np.diag(spread) < RESTING) & (labels >= 0)):
        beside = np.isin(labels, near[labels[i], 1 : nearest + 1])
        fine[i] = (spread[i, beside] < far).sum() >= fewest
    return fine
