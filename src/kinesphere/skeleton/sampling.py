"""Which frames to measure on: as many poses, and as different ones, as the time allows."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.geometry.even_frames import even_frames
from kinesphere.geometry.vectors import is_seen
from kinesphere.kernels.distances import distance_ways_kernel

JUMP = 0.05
"""m, most a marker's step between frames counts: a ghost's jump is no motion."""

TINY = 1e-3
"""m, way of a joint that does nothing but round."""
DENSE = 20
"""Frames that ways are measured on, for each that is wanted: hours cost no more than minutes."""

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
    return _spread_over(steps, count)


def spread_over_joints(
    markers: Array, count: int, joints: Sequence[tuple[Sequence[int], Sequence[int]]]
) -> NDArray[np.intp]:
    """Return frames half of which are spread evenly over time, half over what joints do.

    Each joint has an equal share of the second half, over the way of the distances between the two
    limbs' markers: an ankle moves them by centimetres, a hip by a metre. Time keeps what the
    many other joints do meanwhile, which skin follows, as long as it lasts.

    Parameters
    ----------
    markers : (n_frames, n_markers, 3) m
        NaN where not seen: such steps count as none.
    count
        Most frames to return.
    joints
        Of each, the columns of the markers of either limb.

    Returns
    -------
    (n,) increasing frame indices, all of them where there are no more than ``count``.
    """
    n_frames = len(markers)
    if n_frames <= count:
        return np.arange(n_frames)
    looked_at = even_frames(n_frames, DENSE * count)
    few = markers if len(looked_at) == n_frames else markers[looked_at]
    steps = np.zeros(len(few))
    for limbs in joints:
        ways = np.zeros(len(few))
        one, other = (np.array(columns, dtype=np.intp) for columns in limbs)
        distance_ways_kernel(few, one, other, JUMP, ways)
        steps += ways / max(float(ways.sum()), TINY)
    half = count // 2
    spread = looked_at[_spread_over(steps, count - half)]
    return np.union1d(spread, even_frames(n_frames, half))


def _spread_over(steps: Array, count: int) -> NDArray[np.intp]:
    """Return frames spread evenly over a way of so many steps, the first of which is none."""
    n_frames = len(steps)
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
