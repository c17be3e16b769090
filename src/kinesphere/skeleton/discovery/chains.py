"""A body that is two: limbs in a row that the clustering took for one."""

import numpy as np
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.spatial.distance import squareform

from kinesphere.data import Array
from kinesphere.geometry.spectral import renumbered
from kinesphere.skeleton.discovery.clustering import Labels


def split_chains(labels: Labels, wander: Array, noise: float, ratio: float) -> Labels:
    """Split bodies that are two in a row, hinged at one of their markers.

    A knee's marker is steady with thigh and shank and chains them into one body, though the first
    is not steady with the last. A body is such a chain if two overlapping ones, which share a
    marker, have a least steady distance ``ratio`` times steadier than its own. Splitting a body
    that merely wobbles gains nothing, so the test needs no idea of how much wobble there is.

    Parameters
    ----------
    labels : (n,)
    wander : (n, n) m
        NaN where nothing is known of a pair.
    noise
        m; steadier than that counts as that.
    """
    bodies, todo = [], [np.flatnonzero(labels == c) for c in np.unique(labels)]
    while todo:
        members = todo.pop()
        if len(members) > 2:
            a, b = _halves(members, wander)
            if widest(wander, members) > ratio * max(noise, _hinged(wander, a, b)):
                todo += [a, b]
                continue
        bodies.append(members)
    split = np.empty_like(labels)
    for c, members in enumerate(bodies):
        split[members] = c
    return renumbered(split)


def _halves(members: Labels, wander: Array) -> tuple[Labels, Labels]:
    """Return the two parts that complete linkage joins last."""
    inner = wander[np.ix_(members, members)]
    known = np.isfinite(inner)
    inner = np.where(known, inner, inner[known].max(initial=0.0))
    np.fill_diagonal(inner, 0.0)
    merges = linkage(squareform(inner, checks=False), "complete")
    merges[:, 2] = np.arange(1, len(merges) + 1)  # equal heights would make one part of two
    first = fcluster(merges, 2, "maxclust") == 1
    return members[first], members[~first]


def _hinged(wander: Array, a: Labels, b: Labels) -> float:
    """Return the least steady distance in two bodies of which one lends the other a marker, m."""
    lent = [max(widest(wander, a), widest(wander, np.append(b, marker))) for marker in a]
    lent += [max(widest(wander, b), widest(wander, np.append(a, marker))) for marker in b]
    return min(lent)


def widest(wander: Array, members: Labels) -> float:
    """Return the least steady distance within a body, m."""
    inner = wander[np.ix_(members, members)]
    return float(inner[np.isfinite(inner)].max(initial=0.0))
