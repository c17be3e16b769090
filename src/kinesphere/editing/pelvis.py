"""The pelvis goes down where legs are too short for where the feet stand."""

import numpy as np
from scipy.ndimage import convolve1d, maximum_filter1d

from kinesphere.data import Array
from kinesphere.geometry.vectors import lengths

SMOOTH = 0.3
"""s, over which the pelvis goes down and up again."""


def pelvis_drop(hips: Array, goals: Array, reach: Array, rate: float) -> Array:
    """Return how far the pelvis goes down for every ankle's goal to be in reach, (n_frames,) m.

    Smooth: the least that is needed, its largest within a window, and the mean of that over the
    same window, which is never less than needed. A goal beside the leg farther away than the leg
    is long cannot be reached by going down and asks for nothing.

    Parameters
    ----------
    hips, goals : (n_frames, n_legs, 3) m
    reach : (n_frames, n_legs) m
        How far from the hip the ankle may be.
    """
    across = lengths((goals - hips)[..., [0, 0, 2]] * [0.0, 1.0, 1.0])
    down = hips[..., 1] - goals[..., 1]
    room = np.sqrt(np.maximum(reach**2 - across**2, 0.0))
    needed = np.where(across < reach, np.maximum(down - room, 0.0), 0.0).max(axis=1)
    if not needed.any():
        return np.asarray(needed)
    half = max(1, round(SMOOTH * rate / 2))
    window = np.hanning(2 * half + 3)[1:-1]
    highest = maximum_filter1d(needed, 2 * half + 1, mode="nearest")
    return np.asarray(convolve1d(highest, window / window.sum(), mode="nearest"))
