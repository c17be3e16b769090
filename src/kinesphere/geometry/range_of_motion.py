"""How far a joint turns: the widest angle between its orientations."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.even_frames import even_frames
from kinesphere.geometry.rotations import mean_rotation, rotation_angle

Array = NDArray[np.float64]
RANGE_SAMPLE = 300
"""Most orientations compared pair by pair for a range of motion."""


def range_of_motion(relative: Array) -> float:
    """Return the largest angle between two relative orientations, the oddest 5 % left out, in rad.

    Parameters
    ----------
    relative : (n_frames, 3, 3)
        NaN where unknown.

    Returns
    -------
    float
        0 where fewer than two are known.
    """
    known = relative[np.isfinite(relative).all(axis=(1, 2))]
    if len(known) < 2:
        return 0.0
    known = known[even_frames(len(known), RANGE_SAMPLE)]
    off = rotation_angle(mean_rotation(known).T @ known)
    usual = known[off <= np.quantile(off, 0.95)]
    flat = usual.reshape(-1, 9)
    trace = flat @ flat.T
    return float(np.arccos(np.clip((trace.min() - 1) / 2, -1.0, 1.0)))
