"""Where a marker leaves its path: where runs that stray may begin and end."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

FAST = 2.0
"""Times the marker's own step around: what moves by so much anyway does not stray. Real motion of
0.2 m from frame to frame, at 12 Hz, keeps below 0.7."""


@kernel
def find_steps_kernel(markers: NDArray[np.float64], least: float, steps: NDArray[np.bool_]) -> None:
    """Write which sightings may begin a run that strays by ``least`` m.

    Those that are not where the path before leads, by either of the speeds that it may have; and
    all with a gap just before.

    Parameters
    ----------
    markers : (n_frames, n_markers, 3) m
        NaN where not seen.
    least
        m
    steps : (n_frames, n_markers)
        Written.
    """
    for f in range(len(markers)):
        for m in range(markers.shape[1]):
            steps[f, m] = leaves_path(markers[:, m], f, least)


@kernel
def leaves_path(path: NDArray[np.float64], f: int, least: float) -> bool:
    """Return whether a sighting is off what the path before leads to, by ``least`` m or more."""
    if np.isnan(path[f, 0]):
        return False
    if f < 3:
        return True
    step = 0.0
    for k in range(3):
        step += (path[f, k] - path[f - 1, k]) ** 2
    if step < (least / FAST) ** 2:  # what moves by more leaves by `FAST` times that
        return False
    one = two = 0.0
    for k in range(3):
        off = path[f, k] - path[f - 1, k]
        one += (off - path[f - 1, k] + path[f - 2, k]) ** 2
        two += (off - (path[f - 1, k] - path[f - 3, k]) / 2) ** 2
    return not (one <= least * least and two <= least * least)
