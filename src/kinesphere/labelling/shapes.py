"""Labels by the mean shape of a body: where to start searching from.

Mean distances over time are nearly those of points in space, the body's mean shape [1]_. Laid on
the layout's own, turned to each side and mirrored, every point is nearest to some label [2]_.

References
----------
.. [1] de Leeuw (1977), Recent Developments in Statistics, 133-145: stress by majorisation.
.. [2] Besl & McKay (1992), IEEE Trans. Pattern Anal. Mach. Intell. 14(2), 239-256: closest points.
"""

from itertools import permutations, product

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.sparse.csgraph import shortest_path

from kinesphere.data import Array
from kinesphere.labelling.kernels.types import Indices as Labels

MAJORISED = 30
"""Steps of the shape: it is a start, no more."""
LAID = 12
"""Most steps of laying one shape on the other."""
NEAR = 0.15
"""Distance in shares of the largest extent from which on a point is held by its label less."""
FREE = 3
"""Steps before that."""


def alike(mean: Array, expected: Array, twin: Labels) -> list[Labels]:
    """Return the labels that points have where their shape lies on the layout's, once each.

    Parameters
    ----------
    mean : (n_points, n_points)
        Mean distances; NaN where never seen together.
    expected : (n_labels, n_labels)
        The layout's, in the same unit.
    twin : (n_labels,)
        The label of the other side: shapes know no handedness, so both are returned.
    """
    points, places = shape_of(mean), shape_of(expected)
    found = {}
    for turn in _turns():
        labels = _laid(points @ turn, places, NEAR * float(np.ptp(places[:, 0])))
        for either in (labels, np.where(labels >= 0, twin[labels], -1)):
            found[either.tobytes()] = either
    return list(found.values())


def shape_of(mean: Array) -> Array:
    """Return points (n, 3) that have about these distances, their longest extent along the first.

    Near ones count more: they are the steadier ones.
    """
    known = np.isfinite(mean) & (mean > 0)
    paths = shortest_path(np.where(known, mean, 0.0), directed=False)
    joined = np.isfinite(paths)
    whole = np.where(known, mean, np.where(joined, paths, paths[joined].max(initial=0.0)))
    np.fill_diagonal(whole, 0.0)
    centred = whole**2 - (whole**2).mean(axis=0)
    centred -= centred.mean(axis=1, keepdims=True)
    values, vectors = np.linalg.eigh(-centred / 2)
    points = vectors[:, -3:] * np.sqrt(np.maximum(values[-3:], 0.0))
    weights = np.where(known, 1 / np.where(known, whole, 1.0) ** 2, 0.0)
    back = np.linalg.pinv(np.diag(weights.sum(axis=1)) - weights)
    for _ in range(MAJORISED):
        apart = np.linalg.norm(points[:, None] - points[None], axis=2)
        ratio = np.divide(weights * whole, apart, out=np.zeros_like(apart), where=apart > 0)
        points = back @ (np.diag(ratio.sum(axis=1)) - ratio) @ points
    points = points - points.mean(axis=0)
    return np.asarray(points @ np.linalg.svd(points, full_matrices=False)[2].T)


def _turns() -> list[Array]:
    """Return all ways to lay three axes on three axes, mirrored ones as well, (48, 3, 3)."""
    return [
        np.eye(3)[list(order)] * signs
        for order in permutations(range(3))
        for signs in product((1.0, -1.0), repeat=3)
    ]


def _laid(points: Array, places: Array, near: float) -> Labels:
    """Return the place of each point after laying them on their nearest places, −1 for none."""
    labels = np.full(len(points), -1, dtype=np.int64)
    for step in range(LAID):
        off = ((points[:, None] - places[None]) ** 2).sum(axis=2)
        if step >= FREE:
            off = off / (1 + off / near**2)
        rows, columns = linear_sum_assignment(off)
        if (labels[rows] == columns).all():
            break
        labels[:] = -1
        labels[rows] = columns
        ours, theirs = points[rows], places[columns]
        here, there = ours.mean(axis=0), theirs.mean(axis=0)
        u, _, v = np.linalg.svd((ours - here).T @ (theirs - there))
        if np.linalg.det(u @ v) < 0:  # mirrored they were before, if at all
            u[:, -1] *= -1
        points = (points - here) @ u @ v + there
    return labels
