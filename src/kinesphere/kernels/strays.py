"""Sightings that a marker's own path does not know: it is elsewhere for a moment and comes back."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel
from kinesphere.kernels.stray_steps import FAST, leaves_path

ROUGH = 5.0
"""Times the second difference that a quarter of those around keep below, which noise, cloth and
hard movements have: a sighting that strays leaves the path by more. Of white noise that is thirteen
times its deviation. A quarter, as four strays in seventeen frames spoil more than half."""
BACK = 4.0
"""Times what the path before and the path after miss each other by: a marker that comes back."""
WINDOW = 8
"""Frames on either side that the path is known by."""
ENOUGH = 4
"""Second differences that tell how rough a path is, of the fourteen around."""


@kernel
def judge_runs_kernel(
    markers: NDArray[np.float64],
    starts: NDArray[np.int64],
    columns: NDArray[np.int64],
    length: int,
    least: float,
    fastest: float,
    at_end: bool,
    strays: NDArray[np.bool_],
) -> int:
    """Mark the runs of ``length`` frames that stray, of those that start where it says.

    Returns
    -------
    int
        How many sightings were marked that were not before.

    Parameters
    ----------
    markers : (n_frames, n_markers, 3) m
    starts, columns : (n,)
        First frame and marker of each run.
    least
        m
    fastest
        m that anything moves from frame to frame at most.
    at_end
        True for runs that the path is known on one side of only, False for all others.
    strays : (n_frames, n_markers)
        Sightings of the runs that stray are set.
    """
    found = 0
    rough = np.empty(2 * WINDOW)
    for i in range(len(starts)):
        first, m = starts[i], columns[i]
        stop = first + length
        if stop > len(markers) or not leaves_path(markers[::-1, m], len(markers) - stop, least):
            continue
        if _strays(markers[:, m], first, stop, least, fastest, at_end, rough):
            for f in range(first, stop):
                if not np.isnan(markers[f, m, 0]) and not strays[f, m]:
                    strays[f, m] = True
                    found += 1
    return found


@kernel
def _strays(
    path: NDArray[np.float64],
    first: int,
    stop: int,
    least: float,
    fastest: float,
    at_end: bool,
    rough: NDArray[np.float64],
) -> bool:
    """Return whether a marker's sightings from ``first`` until ``stop`` are none of its path."""
    if np.isnan(path[first, 0]) or np.isnan(path[stop - 1, 0]):
        return False
    before, after = np.full(3, -1), np.full(3, -1)
    _nearest(path, first - 1, -1, before)
    _nearest(path, stop, 1, after)
    if at_end != (before[0] < 0 or after[0] < 0) or max(before[1], after[1]) < 0:
        return False
    usual = _usual_difference(path, first, stop, rough)
    if not usual >= 0.0:
        return False
    least = max(least, ROUGH * usual)
    if not at_end:
        return _leaves(path, first, stop, least, before, after)
    return _apart(path, first, stop, least, fastest, after if before[0] < 0 else before)


@kernel
def _leaves(
    path: NDArray[np.float64],
    first: int,
    stop: int,
    least: float,
    before: NDArray[np.int64],
    after: NDArray[np.int64],
) -> bool:
    """Return whether a run is off the path that what comes before and after it make one of."""
    # either side's speed comes from a neighbour that may stray itself: the pair that fits counts
    best = np.inf
    v, w = np.zeros(3), np.zeros(3)
    lasts = after[0] - before[0]
    for p in range(1, 3):
        for q in range(1, 3):
            if (before[p] < 0 and before[1] >= 0) or (after[q] < 0 and after[1] >= 0):
                continue
            a = b = path[after[0]] - path[before[0]]
            if before[p] >= 0:
                a = (path[before[0]] - path[before[p]]) / (before[0] - before[p])
            if after[q] >= 0:
                b = (path[after[q]] - path[after[0]]) / (after[q] - after[0])
            if before[p] < 0:  # one sighting at an end, which the other side leads to
                a = b
            if after[q] < 0:
                b = a
            miss = path[after[0]] - path[before[0]] - (a + b) / 2 * lasts
            if (miss * miss).sum() < best:
                best = (miss * miss).sum()
                v[:] = a
                w[:] = b
    speed = np.sqrt(max((v * v).sum(), (w * w).sum()))
    far = max(least, FAST * speed, BACK * np.sqrt(best))
    here, there = path[before[0]], path[after[0]]
    into = path[first] - here - v * (first - before[0])
    out = path[stop - 1] - there + w * (after[0] - stop + 1)
    if not min((into * into).sum(), (out * out).sum()) > far * far:
        return False
    for f in range(first, stop):
        if np.isnan(path[f, 0]):
            continue
        u = (f - before[0]) / lasts  # on the cubic that joins both sides
        s = u * u * (3 - 2 * u)
        off = path[f] - (1 - s) * here - s * there
        off -= lasts * u * (1 - u) * ((1 - u) * v - u * w)
        if not (off * off).sum() > far * far:
            return False
    return True


@kernel
def _apart(
    path: NDArray[np.float64],
    first: int,
    stop: int,
    least: float,
    fastest: float,
    near: NDArray[np.int64],
) -> bool:
    """Return whether a run with nothing on its other side is off the path that is on this one.

    It did not come back: it may have stopped there, so it must be where nothing goes so fast.
    """
    slowest = np.inf
    v = np.zeros(3)
    for q in range(1, 3):
        if near[q] >= 0:
            a = (path[near[q]] - path[near[0]]) / (near[q] - near[0])
            if (a * a).sum() < slowest:
                slowest = (a * a).sum()
                v[:] = a
    away = min(abs(first - near[0]), abs(stop - 1 - near[0]))
    far = max(least, FAST * np.sqrt(slowest), fastest * away)
    for f in range(first, stop):
        off = path[f] - path[near[0]] - v * (f - near[0])
        if not np.isnan(off[0]) and not (off * off).sum() > far * far:
            return False
    return True


@kernel
def _nearest(path: NDArray[np.float64], f: int, step: int, found: NDArray[np.int64]) -> None:
    """Write the nearest frames from ``f`` on in which the marker is seen, within the window."""
    n = 0
    for _ in range(WINDOW):
        if n == len(found) or f < 0 or f >= len(path):
            return
        if not np.isnan(path[f, 0]):
            found[n] = f
            n += 1
        f += step


@kernel
def _usual_difference(
    path: NDArray[np.float64], first: int, stop: int, rough: NDArray[np.float64]
) -> float:
    """Return the lower quartile of second differences beside the run, in m; NaN of too few."""
    n = 0
    for i in range(2, WINDOW + 1):
        for f in (first - i, stop - 1 + i):
            if f < 1 or f + 1 >= len(path):
                continue
            square = 0.0
            for k in range(3):
                square += (path[f - 1, k] - 2 * path[f, k] + path[f + 1, k]) ** 2
            if not np.isnan(square):
                rough[n] = np.sqrt(square)
                n += 1
    return np.sort(rough[:n])[n // 4] if n >= ENOUGH else np.nan
