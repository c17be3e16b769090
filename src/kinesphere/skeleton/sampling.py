"""Which frames to measure on: as many poses, and as different ones, as the time allows."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.geometry.vectors import is_seen

JUMP = 0.05
"""m, most a marker's step between frames counts: a ghost's jump is no motion."""

BLOCK = 16384
"""Frames looked at at a time."""


def spread_frames(
    markers: Array, count: int, columns: Sequence[int] | None = None
) -> NDArray[np.intp]:
    """Return frames spread evenly over the way the markers travel relative to each other.

    Rests are thinned, movements are not; the first and the last pose are among them.

    Parameters
    ----------
    markers : (n_frames, n_markers, 3) m
        NaN where not seen: such steps count as none.
    count
        Most frames to return.
    columns
        Which markers count; all where there are none given.

    Returns
    -------
    (n,) increasing frame indices, all of them where there are no more than ``count``.
    """
    n_frames = len(markers)
    if n_frames <= count:
        return np.arange(n_frames)
    if columns is not None and list(columns) == list(range(markers.shape[1])):
        columns = None  # all of them: no copies
    steps = np.zeros(n_frames)
    for start in range(0, n_frames - 1, BLOCK):
        block = markers[start : start + BLOCK + 1]
        block = block if columns is None else block[:, columns]
        steps[start + 1 : start + len(block)] = _step_lengths(block)
    way = np.cumsum(steps)
    # a little of plain time keeps a recording without motion evenly sampled
    way += np.linspace(0.0, 0.05 * way[-1] + 1e-9, n_frames)
    wanted = np.linspace(0.0, way[-1], count)
    after = np.searchsorted(way, wanted).clip(1, n_frames - 1)
    # the nearest, not the next: the same frames when time runs backwards
    nearest = np.where(way[after] - wanted < wanted - way[after - 1], after, after - 1)
    return np.unique(nearest)


def _step_lengths(markers: Array) -> Array:
    """Return the mean step of the markers, less what they have in common, (n, m, 3) → (n-1,) m."""
    steps = np.diff(markers, axis=0)
    both = is_seen(steps)
    if not both.all():
        steps = np.where(both[..., None], steps, 0.0)
    seen = np.maximum(both.sum(axis=1), 1)
    off = steps - (steps.sum(axis=1) / seen[:, None])[:, None]
    length = np.minimum(np.sqrt(np.einsum("nmi,nmi->nm", off, off)), JUMP)
    mean: Array = (length * both).sum(axis=1) / seen
    return mean
