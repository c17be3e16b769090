"""Movement too slow for the usual threshold: told from rest by what noise alone moves the limb."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Array, Mask
from kinesphere.geometry.even_frames import even_frames
from kinesphere.geometry.vectors import lengths
from kinesphere.parameterization.movement_filter import Movement, moving_frames, sample_speeds
from kinesphere.parameterization.samples import runs
from kinesphere.parameterization.settings import ParameterizationSettings
from kinesphere.parameterization.speed_threshold import LOG_RANGE

CLEAR = 3.0  # times the median speed of noise: of two components 0.2 % go beyond
LITTLE = 0.2  # of all that a limb swings: noise on a slow movement passes the usual threshold too
LONGEST = 2.0  # s, of a window
COMPARED = 200  # poses, every one with every other


def widest_swing(positions: Array) -> float:
    """Return the largest angle between two directions of a limb, (n, 3) unit vectors → rad."""
    if len(positions) == 0:
        return 0.0
    some = positions[even_frames(len(positions), COMPARED)]
    return float(np.arccos(np.clip((some @ some.T).min(), -1, 1)))


def slow_movement(
    positions: Array,
    rate: float,
    calibration: Mask,
    moving: Mask,
    settings: ParameterizationSettings,
) -> Movement | None:
    """Return the phases of a limb that goes far but hardly ever fast; None where it does not.

    A movement as wide as an axis needs, slower than the threshold, takes ``smallest_range /
    fallback`` or longer: about a second, over which speeds are taken here. The threshold is three
    times the median speed that noise alone makes over that window, told from the differences of
    successive steps, in which a slow movement cancels and noise does not.

    Parameters
    ----------
    positions : (n_frames, 3)
        Smoothed unit vectors; NaN where unseen.
    rate
        Hz.
    calibration : (n_frames,)
        Frames by which noise and range are told.
    moving : (n_frames,)
        Those of them that pass the usual threshold. Where a run of them is as wide as an axis
        needs, or a fifth of all, there is nothing to mend.
    settings
        The filter's, and the least range.
    """
    known = np.asarray(np.isfinite(positions[:, 0]) & calibration)
    far = np.deg2rad(settings.axes.smallest_range)
    usual = settings.filter.fallback
    if settings.filter.method == "paper" or usual <= 0:
        return None
    fast = max((widest_swing(positions[a:b]) for a, b in runs(moving)), default=0.0)
    if fast >= far or (swing := widest_swing(positions[known])) < far or fast > LITTLE * swing:
        return None
    window = min(LONGEST, max(settings.filter.window, settings.axes.smallest_range / usual))
    noise = noise_speed(np.where(known[:, None], positions, np.nan), rate, window)
    threshold = max(CLEAR * noise, LOG_RANGE[0])
    if not threshold < np.deg2rad(usual):
        return None
    speeds = sample_speeds(positions, rate, window)
    calmer = replace(
        settings.filter,
        window=window,
        bridge=max(settings.filter.bridge, window),
        shortest=max(settings.filter.shortest, window),
    )
    moving = moving_frames(speeds, threshold, rate, calmer)
    return Movement(moving, runs(moving), speeds, threshold, valley=False, slow=True)


def noise_speed(positions: Array, rate: float, window: float) -> float:
    """Return the median speed in rad/s that noise alone makes over a window in s; NaN if unknown.

    From second differences over half a window: noise without memory makes them the square root of
    three times as large as the step over the whole window.

    Parameters
    ----------
    positions : (n_frames, 3)
        Unit vectors; NaN where they do not count.
    rate, window
        Hz and s.
    """
    half = max(1, round(window * rate / 2))
    if len(positions) <= 2 * half:
        return np.nan
    before, here, after = (
        positions[: -2 * half],
        positions[half:-half],
        positions[2 * half :],
    )
    bends = lengths(before - 2 * here + after)
    bends = bends[np.isfinite(bends)]
    return float(np.median(bends) / np.sqrt(3) * rate / (2 * half)) if len(bends) else np.nan
