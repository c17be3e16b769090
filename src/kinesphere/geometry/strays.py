"""Markers that are elsewhere for a moment: what of a trajectory cannot be the marker's."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.strays import find_steps_kernel, judge_runs_kernel

LONGEST = 0.1
"""s; what is away for longer may have moved there and back: a fist does in 0.15 s."""
RUN = (3, 10)
"""Frames that `LONGEST` is at least and at most."""
PASSES = 8
"""Times that paths are looked at again: what strayed beside other strays shows when they are gone.
Of 5 % strays none is left after four."""

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


def find_strays(markers: Array, rate: float, least: float) -> Mask:
    """Return which sightings are off their marker's own path for a moment, (n_frames, n).

    A run of frames strays if the marker steps into and out of it, and is off the cubic between what
    comes before and after in all of it, by more than `least`, than the usual second difference
    around, than its own speed and than what both sides miss each other by: a marker that leaves and
    comes back by steps that its path does not know. Short runs are looked for first. Who leaves and
    stays, or leaves in a movement, does not stray; nor does what the markers beside do matter.

    Parameters
    ----------
    markers : (n_frames, n, 3) m
        NaN where not seen.
    rate
        Hz
    least
        m, above 0; what is nearer to the path is noise.
    """
    strays: Mask = np.zeros(markers.shape[:2], dtype=bool)
    steps: Mask = np.empty_like(strays)
    # the speed is at most half of what a stray leaves by, so its step is half of it at least
    find_steps_kernel(markers, least / 2, steps)
    starts, columns = np.nonzero(steps)
    longest = int(np.clip(round(LONGEST * rate), *RUN))
    for _ in range(PASSES):
        if len(starts) == 0:
            break
        found = 0
        for length in range(1, longest + 1):
            if new := judge_runs_kernel(markers, starts, columns, length, least, strays):
                markers = np.where(strays[..., None], np.nan, markers)
                found += new
        if not found:
            break
        again = np.flatnonzero(strays.any(axis=0))
        keep = np.isin(columns, again) & ~strays[starts, columns]
        starts, columns = starts[keep], columns[keep]
    return strays
