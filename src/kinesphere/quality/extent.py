"""How large what the markers are on is, whatever the unit and however many markers are missing."""

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.even_frames import even_frames

FRAMES = 100
"""Frames that are looked at, evenly spread."""


def usual_extent(markers: Array) -> float:
    """Return the median rms distance of the markers from their middle, in m.

    Parameters
    ----------
    markers : (n_frames, n, 3) m
        NaN where not seen.

    Returns
    -------
    float
        0.4 to 0.66 m of people, 0.05 m of a hand; 0 where no two markers are seen at once.
    """
    points = markers[even_frames(len(markers), FRAMES)]
    extents = []
    for frame in points:
        seen = frame[np.isfinite(frame).all(axis=1)]
        if len(seen) > 1:
            extents.append(float(np.sqrt(seen.var(axis=0).sum())))
    return float(np.median(extents)) if extents else 0.0
