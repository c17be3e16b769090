"""Which frames belong to a movement: a threshold on the limb's speed (paper section 4.1)."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array, Mask
from kinesphere.geometry.vectors import lengths
from kinesphere.parameterization.samples import Phase, mask_from_runs, run_ends, runs
from kinesphere.parameterization.settings import FilterSettings
from kinesphere.parameterization.speed_threshold import speed_threshold


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
