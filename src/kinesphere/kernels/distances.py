"""Distances between markers, frame by frame, and how far they go."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

BLOCK = 256
"""Frames at a time: so many stay in the processor's cache, however many markers there are."""


@kernel
def pair_distances_kernel(
    markers: NDArray[np.float64], pairs: NDArray[np.intp], distances: NDArray[np.float64]
) -> None:
    """Write the distances between pairs of markers.

    Parameters
    ----------
    markers : (n_frames, n_markers, 3) m
        NaN gives NaN.
    pairs : (n_pairs, 2)
    distances : (n_frames, n_pairs) m
        Written.
    """
    for i in range(len(pairs)):  # over frames: in plain Python hardly slower than compiled
        one, other = markers[:, pairs[i, 0]], markers[:, pairs[i, 1]]
        distances[:, i] = np.sqrt(
            (one[:, 0] - other[:, 0]) ** 2
            + (one[:, 1] - other[:, 1]) ** 2
            + (one[:, 2] - other[:, 2]) ** 2
        )


@kernel
def distance_ways_kernel(
    markers: NDArray[np.float64],
    ones: NDArray[np.intp],
    others: NDArray[np.intp],
    most: float,
    ways: NDArray[np.float64],
) -> None:
    """Add up how far the distances between two limbs' markers go from each frame to the next.

    Parameters
    ----------
    markers : (n_frames, n_markers, 3) m
        NaN where not seen: such steps count as none.
    ones, others : (n,), (m,)
        Columns of the two limbs.
    most
        m, most a step counts.
    ways : (n_frames,) m
        Steps are added: each to the frame it arrives at.
    """
    for start in range(0, len(ways) - 1, BLOCK):
        block, arrived = markers[start : start + BLOCK + 1], ways[start + 1 : start + BLOCK + 1]
        for a in ones:
            for b in others:  # over frames: in plain Python hardly slower than compiled
                one, other = block[:, a], block[:, b]
                apart = np.sqrt(
                    (one[:, 0] - other[:, 0]) ** 2
                    + (one[:, 1] - other[:, 1]) ** 2
                    + (one[:, 2] - other[:, 2]) ** 2
                )
                steps = np.minimum(np.abs(apart[1:] - apart[:-1]), most)
                arrived += np.where(np.isnan(steps), 0.0, steps)
