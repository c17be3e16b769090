"""Points that have no identity from frame to frame: followed, before anything is recognised."""

from collections.abc import Sequence

import numpy as np
from scipy.optimize import linear_sum_assignment

from kinesphere.data import Array
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


def reach_at(rate: float) -> float:
    """Return how far a marker may be from where it is expected, m, at ``rate`` Hz."""
    return REACH + ACCELERATION / rate**2


def followed(frames: Sequence[Array], rate: float) -> Array:
    """Return points as trajectories: each keeps its column as long as it can be followed.

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
    (n_frames, n_columns, 3) m, NaN where not seen; between two trajectories in one column a frame
    at least is empty.
    """
    reach = reach_at(rate)
    here, step = np.empty((0, 3)), np.empty((0, 3))
    columns = np.empty(0, dtype=np.intp)
    free_since: dict[int, int] = {}
    placed: list[tuple[np.ndarray, Array]] = []
    width = 0
    for t, frame in enumerate(frames):
        points = np.ascontiguousarray(frame, dtype=np.float64).reshape(-1, 3)
        points = points[np.isfinite(points).all(axis=1)]
        before, now = _continued(here, step, points, reach)
        new = np.full(len(points), -1, dtype=np.intp)
        new[now] = columns[before]
        moved = np.zeros_like(points)
        moved[now] = points[now] - here[before]
        for column in np.setdiff1d(columns, new):
            free_since[int(column)] = t
        for k in np.flatnonzero(new < 0):
            old = next((c for c in sorted(free_since) if free_since[c] < t), width)
            if old == width:
                width += 1
            free_since.pop(old, None)
            new[k] = old
        here, step, columns = points, moved, new
        placed.append((new, points))
    found = np.full((len(frames), width, 3), np.nan)
    for t, (new, points) in enumerate(placed):
        found[t, new] = points
    return found


def _continued(
    here: Array, step: Array, points: Array, reach: float
) -> tuple[np.ndarray, np.ndarray]:
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
