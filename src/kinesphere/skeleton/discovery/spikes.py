"""Single frames in which a marker is somewhere else altogether."""

import numpy as np

from kinesphere.data import Array
from kinesphere.skeleton.averages import mean_seen, median_seen

FAR = 4.0
"""Times the subject's rms extent, twice a person's height, that no marker goes in a frame and comes
back in the next."""


def without_spikes(markers: Array) -> Array:
    """Return the markers without sightings that are far from those before and after.

    One such frame would take up the sample that is spread over the way markers travel, and with it
    every mean. What goes far and stays there is left alone.

    Parameters
    ----------
    markers : (n_frames, n, 3) m
        NaN where not seen.
    """
    if len(markers) < 3:
        return markers
    off = np.linalg.norm(markers - mean_seen(markers, axis=1)[:, None], axis=2)
    far = FAR * float(median_seen(np.sqrt(mean_seen(off**2, axis=1))))
    gone = np.linalg.norm(np.diff(markers, axis=0), axis=2)
    apart = np.linalg.norm(markers[2:] - markers[:-2], axis=2)
    spike = np.zeros(markers.shape[:2], dtype=bool)
    spike[1:-1] = (gone[:-1] > far) & (gone[1:] > far) & (apart < far)
    return np.where(spike[..., None], np.nan, markers) if spike.any() else markers
