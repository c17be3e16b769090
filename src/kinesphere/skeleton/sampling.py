"""Which frames to measure on: as many poses, and as different ones, as the time allows."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array

JUMP = 0.05
"""m, most a marker's step between frames counts: a ghost's jump is no motion."""


def spread_frames(markers: Array, count: int) -> NDArray[np.intp]:
    """Return frames spread evenly over the way the markers travel relative to each other.

    Rests are thinned, movements are not; the first and the last pose are among them.

    Parameters
    ----------
    markers : (n_frames, n_markers, 3) m
        NaN where not seen: such steps count as none.
    count
        Most frames to return.

    Returns
    -------
    (n,) increasing frame indices, all of them where there are no more than ``count``.
    """
    n_frames = len(markers)
    if n_frames <= count:
        return np.arange(n_frames)
    known = np.asarray(np.isfinite(markers).all(axis=2))
    steps = np.diff(np.where(known[..., None], markers, 0.0), axis=0)
    both = known[1:] & known[:-1]
    seen = np.maximum(both.sum(axis=1), 1)
    shift = (steps * both[..., None]).sum(axis=1) / seen[:, None]
    length = np.minimum(np.linalg.norm(steps - shift[:, None], axis=2), JUMP)
    way = np.concatenate([[0.0], np.cumsum((length * both).sum(axis=1) / seen)])
    # a little of plain time keeps a recording without motion evenly sampled
    way += np.linspace(0.0, 0.05 * way[-1] + 1e-9, n_frames)
    wanted = np.linspace(0.0, way[-1], count)
    after = np.searchsorted(way, wanted).clip(1, n_frames - 1)
    # the nearest, not the next: the same frames when time runs backwards
    nearest = np.where(way[after] - wanted < wanted - way[after - 1], after, after - 1)
    return np.unique(nearest)
