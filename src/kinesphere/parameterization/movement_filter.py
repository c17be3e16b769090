"""Which frames belong to a movement: a threshold on the limb's speed (paper section 4.1)."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from kinesphere.data import Array, Mask
from kinesphere.geometry.vectors import lengths
from kinesphere.parameterization.samples import Phase, mask_from_runs, run_ends, runs
from kinesphere.parameterization.settings import FilterSettings

BINS = 100  # of the speed histogram (paper section 4.1)
SMALL_BAR = 0.05  # of the highest bar: the paper's "small bars"
BLUR = 3.0  # bins, standard deviation
LOG_RANGE = (np.deg2rad(0.05), np.deg2rad(2000.0))  # rad/s, from sensor noise to a whip
DEPTH = 0.16  # least drop from the lower peak to the valley: daily motion has 0-0.13 by chance,
# functional trials 0.27-0.51, calibrations under 3 deg of correlated noise 0.19-0.37
SIDE = 0.02  # least share of the samples on each side of the valley


@dataclass(frozen=True, eq=False)
class Movement:
    """Movement phases of one joint, and what they were told from."""

    moving: Mask
    """(n_frames,)"""
    phases: tuple[Phase, ...]
    speeds: Array
    """(n_frames,) rad/s; NaN where unknown."""
    threshold: float
    """rad/s."""
    valley: bool
    """Whether the histogram had a valley to put the threshold in."""
    slow: bool = False
    """Whether hardly anything passed the usual threshold: `slow_movement.slow_movement`."""


def find_movement(
    positions: Array, rate: float, settings: FilterSettings, calibration: Mask | None = None
) -> Movement:
    """Partition samples into movement and stationary phases.

    Parameters
    ----------
    positions : (n_frames, 3)
        Unit vectors; NaN where unseen.
    rate
        Hz.
    settings
        Method and its windows.
    calibration : (n_frames,), optional
        Frames whose speeds make the histogram; all by default.

    Returns
    -------
    Movement
        Unseen frames never move. Without a valley the threshold is ``settings.fallback`` and
        ``valley`` is False; nothing is raised.
    """
    return movement_of(limb_speeds(positions, rate, settings), rate, settings, calibration)


def limb_speeds(positions: Array, rate: float, settings: FilterSettings) -> Array:
    """Return the speeds that movement is told by; arguments as `find_movement` takes them."""
    return sample_speeds(positions, rate, 0.0 if settings.method == "paper" else settings.window)


def movement_of(
    speeds: Array, rate: float, settings: FilterSettings, calibration: Mask | None = None
) -> Movement:
    """Return `find_movement` of a limb with these speeds, (n_frames,) rad/s."""
    known = np.isfinite(speeds) if calibration is None else np.isfinite(speeds) & calibration
    threshold, valley = speed_threshold(speeds[known], settings)
    if settings.method == "paper":
        with np.errstate(invalid="ignore"):
            moving = np.asarray(speeds > threshold)
    else:
        moving = moving_frames(speeds, threshold, rate, settings)
    return Movement(moving, runs(moving), speeds, threshold, valley)


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


def moving_frames(speeds: Array, threshold: float, rate: float, settings: FilterSettings) -> Mask:
    """Return which frames belong to a movement, (n_frames,): fast runs, bridged and trimmed.

    ``speeds``, (n_frames,) rad/s, are NaN where unknown.
    """
    with np.errstate(invalid="ignore"):
        moving = hysteresis(speeds, threshold, threshold / 2)
        moving = bridge(moving, np.isfinite(speeds), round(settings.bridge * rate))
        moving = trim(moving, max(1, round(settings.window * rate / 2)))
        return drop_short(moving, round(settings.shortest * rate))


def sample_speeds(positions: Array, rate: float, window: float) -> Array:
    """Return angular speeds, (n_frames, 3) → (n_frames,) rad/s; NaN where an end is unseen.

    ``window`` in s is centred and shortened at the ends of the recording; 0 takes the step from
    the frame before (frame 0 then has none), as the paper does.
    """
    n = len(positions)
    at = np.arange(n)
    half = max(1, round(window * rate / 2))
    before = np.maximum(at - (half if window else 1), 0)
    after = np.minimum(at + half, n - 1) if window else at
    with np.errstate(invalid="ignore", divide="ignore"):
        chord = lengths(positions[after] - positions[before])
        speeds = 2 * np.arcsin(np.minimum(chord / 2, 1.0)) * rate / (after - before)
    return np.asarray(speeds)


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


def hysteresis(speeds: Array, high: float, low: float) -> Mask:
    """Return runs above ``low`` that rise above ``high`` somewhere; NaN ends a run."""
    starts, stops = run_ends(np.asarray(speeds > low))
    fast = np.concatenate([[0], np.cumsum(speeds > high)])
    rises = fast[stops] > fast[starts]
    return mask_from_runs(starts[rises], stops[rises], len(speeds))


def trim(moving: Mask, frames: int) -> Mask:
    """Shorten every run at both ends by what a centred window sees too early and too late.

    A run at the first or last frame ends there because the recording does: it is kept.
    """
    starts, stops = run_ends(moving)
    starts = np.where(starts > 0, starts + frames, starts)
    stops = np.where(stops < len(moving), stops - frames, stops)
    return mask_from_runs(starts, stops, len(moving))


def bridge(moving: Mask, known: Mask, longest: int) -> Mask:
    """Close rests of up to ``longest`` known frames between two movements."""
    starts, stops = run_ends(~moving)
    unknown = np.concatenate([[0], np.cumsum(~known)])
    inside = (starts > 0) & (stops < len(moving)) & (unknown[stops] == unknown[starts])
    closed = inside & (stops - starts <= longest)
    return moving | mask_from_runs(starts[closed], stops[closed], len(moving))


def drop_short(moving: Mask, shortest: int) -> Mask:
    """Forget movements of fewer than ``shortest`` frames."""
    starts, stops = run_ends(moving)
    long = stops - starts >= shortest
    return mask_from_runs(starts[long], stops[long], len(moving))
