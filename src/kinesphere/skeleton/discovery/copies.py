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
TOGETHER = 0.9
"""Least share of the frames of the one seen less that show both. One marker in two pieces that
overlap for some frames is no copy: either piece tells what the other does not."""


def find_copies(markers: Array, order: NDArray[np.intp]) -> dict[int, int]:
    """Return which trajectories are copies, and of which other one.

    A copy is seen hardly anywhere but where the other one is. Of each group the one that is seen
    most often is kept, of several the first in the file.

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
    seen = np.isfinite(markers).all(axis=2)
    often = seen.sum(axis=0)
    lone = _shared(seen) < TOGETHER * np.minimum(often[:, None], often)
    far = np.where(np.isfinite(apart) & ~lone, apart, 1e3)
    np.fill_diagonal(far, 0.0)
    group = fcluster(linkage(squareform(far, checks=False), "complete"), BESIDE, "distance")
    copies: dict[int, int] = {}
    for g in np.unique(group):
        members = np.flatnonzero(group == g)
        kept = min((int(m) for m in members), key=lambda m: (-often[m], order[m]))
        copies |= {int(m): kept for m in members if m != kept}
    return dict(sorted(copies.items()))


def _shared(seen: NDArray[np.bool_]) -> Array:
    """Return in how many frames two are seen together, (n, n); exact."""
    shown = seen.astype(np.float64)
    return np.asarray(shown.T @ shown)
