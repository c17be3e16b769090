"""What distances and ways are like where trajectories end and begin."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.kernels.pair_moments import pair_moments

STATISTICS = 12.0
"""Hz, about: how often distances are looked at."""
TOGETHER = 0.5
"""s that two must be seen together before their distance is known to be steady."""
NEAR, ENOUGH = 0.5, 0.1
"""s at either side of a break in which distances are compared; for so long they must be seen."""
PACE = 0.08
"""s over which a pace is measured."""


def stray_of(
    points: Array,
    end: tuple[NDArray[np.intp], NDArray[np.intp]],
    start: tuple[NDArray[np.intp], NDArray[np.intp]],
    beside: Array,
    rate: float,
) -> Array:
    """Return how far apart both are where they would meet midway, m, seen from the best fellow."""
    fellow = beside.argmin(axis=1)
    some = max(2, round(PACE * rate))
    half = (start[1] - end[1]) / 2
    meet = []
    for (m, at), way in ((end, -1), (start, 1)):
        steps = np.arange(some + 1)
        frames = at[:, None] + way * steps
        inside = ((frames >= 0) & (frames < len(points)))[:, :, None]
        frames = np.clip(frames, 0, len(points) - 1)
        path = np.where(
            inside, points[frames, m[:, None]] - points[frames, fellow[:, None]], np.nan
        )
        off = steps - steps.mean()
        pace = np.einsum("k,mki->mi", off / (off @ off), path)
        meet.append(path.mean(axis=1) - pace * (half + some / 2)[:, None])
    stray: Array = np.linalg.norm(meet[0] - meet[1], axis=1)
    stray[np.isinf(beside.min(axis=1))] = np.nan
    return stray


def wander_of(points: Array, rate: float) -> Array:
    """Return how much each distance wanders, (n, n) m; NaN where seen too briefly."""
    step = max(1, round(rate / STATISTICS))
    few = np.ascontiguousarray(points[::step])
    n = points.shape[1]
    count, total, _ = pair_moments(few, np.zeros((n, n)))
    mean = total / np.maximum(count, 1)
    count, total, squares = pair_moments(few, mean)
    count[count * step < TOGETHER * rate] = np.nan
    out: Array = np.sqrt(np.maximum(squares / count, 0))
    np.fill_diagonal(out, np.nan)
    return out


def near_of(
    points: Array, at: NDArray[np.intp], rate: float, way: int, of: NDArray[np.intp]
) -> Array:
    """Return the mean distances just before (-1) or after (1) a frame of each, (n, n) m."""
    n_frames, n = points.shape[:2]
    reach, step = round(NEAR * rate), max(1, round(rate / 25))
    out = np.full((n, n), np.nan)
    for m in of:
        low, high = (at[m] - reach, at[m] + 1) if way < 0 else (at[m], at[m] + reach + 1)
        part = points[max(low, 0) : min(high, n_frames) : step]
        gap = part - part[:, m : m + 1]
        away = np.sqrt(np.einsum("tni,tni->tn", gap, gap))
        shown = np.isfinite(away)
        often = shown.sum(axis=0)
        sums = np.where(shown, away, 0).sum(axis=0)
        enough = often * step >= ENOUGH * rate
        out[m, enough] = sums[enough] / often[enough]
    np.fill_diagonal(out, np.nan)
    return out


def least_of(values: Array) -> Array:
    """Return the least of each row that is known; inf where none is."""
    return np.asarray(np.where(np.isnan(values), np.inf, values).min(axis=1))
