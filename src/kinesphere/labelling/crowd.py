"""Points that have no identity from frame to frame: followed, before anything is recognised."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from kinesphere.data import Array
from kinesphere.geometry.signature import evenly_spread
from kinesphere.kernels.jit import kernel

REACH = 0.04
"""m, farthest a point may lie from where it is expected, beside what acceleration adds."""
ACCELERATION = 150.0
"""m/s², of feet that strike and fists: from step to step a marker strays by it times dt²."""
FAR = 10.0
"""m, stands for never in the assignment."""
CLEAR = 2.0
"""How many times farther the next candidate must be, for a point to be taken for one before."""
SURE = 0.003
"""m, distance that counts as at least: what lies nearer is as sure."""
LOOKED_AT = 100
"""Frames looked at to tell whether columns mean anything."""
JUMPING = 0.2
"""Share of the steps that jump to where another column's were, from which on they do not."""


def reach_at(rate: float) -> float:
    """Return how far a marker may be from where it is expected, m, at ``rate`` Hz."""
    return REACH + ACCELERATION / rate**2


def followed(frames: Sequence[Array], rate: float) -> NDArray[np.int64]:
    """Return which point of each frame each trajectory is.

    A trajectory ends where a point is lost, or where two would do; the body decides later what
    continues it.

    Parameters
    ----------
    frames
        The points of each frame, (n_points, 3) m, in any order; NaN is no point.
    rate
        Hz.

    Returns
    -------
    (n_frames, n_columns) index into the frame's points, −1 where there is none: between two
    trajectories in one column one frame at least.
    """
    reach = reach_at(rate)
    here, step = np.empty((0, 3)), np.empty((0, 3))
    columns = np.empty(0, dtype=np.int64)
    free_since: dict[int, int] = {}
    rows: list[tuple[NDArray[np.int64], NDArray[np.intp]]] = []
    width = 0
    for t, frame in enumerate(frames):
        points = np.ascontiguousarray(frame, dtype=np.float64).reshape(-1, 3)
        seen = np.flatnonzero(np.isfinite(points).all(axis=1))
        points = points[seen]
        before, now = _continued(here, step, points, reach)
        new = np.full(len(points), -1, dtype=np.int64)
        new[now] = columns[before]
        moved = np.zeros_like(points)
        moved[now] = points[now] - here[before]
        for column in np.setdiff1d(columns, new):
            free_since[int(column)] = t
        for k in np.flatnonzero(new < 0):
            old = next((c for c in sorted(free_since) if free_since[c] < t), width)
            width = max(width, old + 1)
            free_since.pop(old, None)
            new[k] = old
        here, step, columns = points, moved, new
        rows.append((new, seen))
    found = np.full((len(frames), width), -1, dtype=np.int64)
    for t, (new, seen) in enumerate(rows):
        found[t, new] = seen
    return found


def taken(frames: Sequence[Array], source: NDArray[np.int64]) -> Array:
    """Return the points that ``followed`` names, (n_frames, n_columns, 3), NaN for none."""
    found = np.full((*source.shape, 3), np.nan)
    for t, (frame, of) in enumerate(zip(frames, source, strict=True)):
        found[t, of >= 0] = np.asarray(frame)[of[of >= 0]]
    return found


def is_crowd(markers: Array, rate: float) -> bool:
    """Tell whether columns mean nothing: points jump where another column goes on.

    Parameters
    ----------
    markers : (n_frames, n_columns, 3) m
    rate
        Hz.
    """
    frames = evenly_spread(max(len(markers) - 1, 0), LOOKED_AT)
    reach = reach_at(rate)
    jumps = steps = 0
    for t in frames:
        apart = np.linalg.norm(markers[t][:, None] - markers[t + 1], axis=2)
        own = np.diagonal(apart)
        known = np.isfinite(own)
        nearest = np.where(np.isfinite(apart), apart, np.inf).min(axis=1, initial=np.inf)
        steps += int(known.sum())
        jumps += int((known & (own > reach) & (nearest <= reach)).sum())
    return jumps > JUMPING * steps


def _continued(
    here: Array, step: Array, points: Array, reach: float
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return which points before are which now, the clear cases only."""
    none = np.empty(0, dtype=np.intp)
    if not len(here) or not len(points):
        return none, none
    apart = np.empty((len(here), len(points)))
    expected_distances(here, step, points, reach, FAR, apart)
    rows, columns = linear_sum_assignment(apart)
    near = apart[rows, columns]
    others = apart.copy()
    others[rows, columns] = FAR
    next_best = np.minimum(others[rows].min(axis=1), others[:, columns].min(axis=0))
    clear = (near < FAR) & (next_best >= CLEAR * np.maximum(near, SURE))
    return rows[clear], columns[clear]


@kernel
def expected_distances(
    here: Array, step: Array, points: Array, reach: float, far: float, apart: Array
) -> None:
    """Fill how far each point is from where each marker is expected, ``far`` beyond reach."""
    for i in range(here.shape[0]):
        for k in range(points.shape[0]):
            square = 0.0
            for x in range(3):
                square += (points[k, x] - here[i, x] - step[i, x]) ** 2
            apart[i, k] = np.sqrt(square) if square <= reach * reach else far
