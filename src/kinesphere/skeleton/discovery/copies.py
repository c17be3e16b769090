"""Trajectories that are there twice: one marker under two numbers."""

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.spatial.distance import squareform

from kinesphere.data import Array
from kinesphere.geometry.even_frames import even_frames
from kinesphere.skeleton.averages import median_seen

BESIDE = 0.003
"""m, at a person's size: two that are usually no farther apart are one marker. Those worn on people
are 6 mm thick and more; of the recordings at hand no two are nearer than 7 mm."""
FRAMES = 100
"""Frames that are looked at, spread over the recording."""


def find_copies(markers: Array, order: NDArray[np.intp]) -> dict[int, int]:
    """Return which trajectories are copies, and of which other one.

    Of each group the one that is seen most often is kept, of several the first in the file.

    Parameters
    ----------
    markers : (n_frames, n, 3) m
        At a person's size; NaN where not seen.
    order : (n,)
        Their places in the file.

    Returns
    -------
    Column of a copy → column that is kept.
    """
    few = markers[even_frames(len(markers), FRAMES)]
    n = few.shape[1]
    apart = np.full((n, n), np.inf)
    for i in range(n):
        usual = median_seen(np.linalg.norm(few - few[:, i : i + 1], axis=2))
        apart[i] = np.nan_to_num(usual, nan=np.inf)
    if n < 2 or (apart + np.diag(np.full(n, np.inf)) > BESIDE).all():
        return {}
    far = np.where(np.isfinite(apart), apart, 1e3)
    np.fill_diagonal(far, 0.0)
    group = fcluster(linkage(squareform(far, checks=False), "complete"), BESIDE, "distance")
    seen = np.isfinite(markers).all(axis=2).sum(axis=0)
    copies: dict[int, int] = {}
    for g in np.unique(group):
        members = np.flatnonzero(group == g)
        kept = min((int(m) for m in members), key=lambda m: (-seen[m], order[m]))
        copies |= {int(m): kept for m in members if m != kept}
    return dict(sorted(copies.items()))
