"""The speed that parts movement from rest: a valley of the histogram of speeds."""

import numpy as np
from scipy.ndimage import gaussian_filter1d

from kinesphere.data import Array
from kinesphere.parameterization.settings import FilterSettings

BINS = 100  # of the speed histogram (paper section 4.1)
SMALL_BAR = 0.05  # of the highest bar: the paper's "small bars"
BLUR = 3.0  # bins, standard deviation
LOG_RANGE = (np.deg2rad(0.05), np.deg2rad(2000.0))  # rad/s, from sensor noise to a whip
DEPTH = 0.16  # least drop from the lower peak to the valley: daily motion has 0-0.13 by chance,
# functional trials 0.27-0.51, calibrations under 3 deg of correlated noise 0.19-0.37
SIDE = 0.02  # least share of the samples on each side of the valley


def speed_threshold(speeds: Array, settings: FilterSettings) -> tuple[float, bool]:
    """Return the speed in rad/s that parts movement from rest, and whether a valley told it.

    ``speeds``, (n,) rad/s, are without NaN.
    """
    find = {"paper": paper_threshold, "log-speed": persistence_threshold}.get(settings.method)
    if find is None:
        bounds = np.deg2rad(settings.slowest), np.deg2rad(settings.fastest)
        found = valley_threshold(speeds, *bounds)
    else:
        found = find(speeds)
    return float(np.deg2rad(settings.fallback)) if found is None else found, found is not None


def paper_threshold(speeds: Array) -> float | None:
    """Return the first gap after the peak once bars below 5 % of it are gone, in rad/s.

    100 uniform bins over the whole range of speeds (paper section 4.1); None if no bar is
    eliminated behind the peak.
    """
    if len(speeds) == 0 or not speeds.max() > 0:
        return None
    bars, edges = np.histogram(speeds, BINS, (0.0, float(speeds.max())))
    peak = int(bars.argmax())
    gaps = np.flatnonzero(bars[peak:] < SMALL_BAR * bars[peak])
    return float(edges[peak + gaps[0]]) if len(gaps) else None


def log_histogram(speeds: Array) -> tuple[Array, Array]:
    """Return smoothed bar heights and bin centres (rad/s) of 100 logarithmic bins."""
    low, high = np.log(LOG_RANGE)
    logs = np.clip(np.log(np.maximum(speeds, LOG_RANGE[0])), low, high)
    bars, edges = np.histogram(logs, BINS, (low, high))
    heights: Array = gaussian_filter1d(bars.astype(float), BLUR, mode="constant")
    return heights, np.exp((edges[1:] + edges[:-1]) / 2)


def persistence_threshold(speeds: Array) -> float | None:
    """Return the valley below the second most persistent peak of the log-speed histogram, rad/s.

    Zero-dimensional persistence of the superlevel sets (Edelsbrunner, Letscher & Zomorodian 2002);
    None if there is one peak only.
    """
    if len(speeds) == 0:
        return None
    heights, centres = log_histogram(speeds)
    owner = np.full(BINS, -1)
    best, valley = 0.0, None
    for i in np.argsort(-heights, kind="stable"):
        left = owner[i - 1] if i > 0 else -1
        right = owner[i + 1] if i < BINS - 1 else -1
        if left >= 0 and right >= 0:  # two components meet: the lower peak dies here
            dying, stays = sorted((left, right), key=lambda peak: heights[peak])
            if (persistence := heights[dying] - heights[i]) > best:
                best, valley = persistence, int(i)
            owner[owner == dying] = stays
            owner[i] = stays
        else:
            owner[i] = max(left, right) if max(left, right) >= 0 else i
    return None if valley is None else float(centres[valley])


def valley_threshold(speeds: Array, slowest: float, fastest: float) -> float | None:
    """Return the deepest valley of the log-speed histogram between two speeds, all in rad/s.

    A valley counts if it drops at least 16 % below the lower of the highest peaks on its two
    sides, and at least 2 % of the samples lie on each side; None otherwise.
    """
    if len(speeds) == 0:
        return None
    heights, centres = log_histogram(speeds)
    left, right = np.maximum.accumulate(heights), np.maximum.accumulate(heights[::-1])[::-1]
    lower = np.minimum(left, right)
    depth = 1 - heights / np.maximum(lower, 1e-300)
    slow_share = np.searchsorted(np.sort(speeds), centres) / len(speeds)
    allowed = (centres >= slowest) & (centres <= fastest) & (depth >= DEPTH)
    allowed &= (slow_share >= SIDE) & (slow_share <= 1 - SIDE)
    if not allowed.any():
        return None
    deepest = depth[allowed].max()
    # a flat floor has many deepest bins: the middle one is farthest from both sides
    floor = np.flatnonzero(allowed & (depth >= deepest - 1e-3))
    return float(centres[floor[len(floor) // 2]])
