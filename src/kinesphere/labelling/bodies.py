"""How many bodies are in one volume: points that keep near each other's distances are one.

Along a body every marker has a neighbour whose distance hardly varies, from the foot to the head;
between two bodies that move about, no two markers are so steady.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components, minimum_spanning_tree

from kinesphere.data import Array
from kinesphere.geometry.pair_distances import pair_distances
from kinesphere.geometry.signature import FRAMES, evenly_spread

HALF = 0.5
"""Share of a layout's labels from which on a group of points is a body."""
APART = 2.0
"""How many times steadier the loosest link within a body is than the steadiest between two."""
EXACT = 1e-9
"""Least deviation: a link of zero would be none."""


def bodies_of(points: Array, n_labels: int) -> list[NDArray[np.intp]]:
    """Return the points of each body; none, if there are not clearly several.

    The links of the minimum spanning tree of deviations are cut, the loosest first, until two
    groups of half a layout are left.

    Parameters
    ----------
    points : (n_frames, n_points, 3)
        NaN where not seen.
    n_labels
        Of the layout.
    """
    least = max(2, round(HALF * n_labels))
    n = points.shape[1]
    if n < 2 * least:
        return []
    found = pair_distances(points[evenly_spread(len(points), FRAMES)]).std
    links = np.where(np.isfinite(found), np.maximum(found, EXACT), 0.0)
    np.fill_diagonal(links, 0.0)
    tree = minimum_spanning_tree(links)
    rest = tree.copy()
    for at in np.argsort(-tree.data, kind="stable"):
        rest.data[at] = 0.0
        kept = rest.copy()
        kept.eliminate_zeros()
        _, group = connected_components(kept, directed=False)
        large = np.flatnonzero(np.bincount(group) >= least)
        if len(large) > 1:
            inner = kept.tocoo()
            loosest = inner.data[np.isin(group[inner.row], large)].max(initial=0.0)
            if tree.data[at] < APART * loosest:
                return []
            return [np.flatnonzero(group == number) for number in large]
    return []
