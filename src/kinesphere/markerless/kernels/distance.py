"""Signed distances near the edge of a mask, exact, at a cost that grows with the edge."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

Ints = NDArray[np.int32]


@kernel
def _along_columns(mask: NDArray[np.bool_], reach: int, off: Ints) -> None:
    """Write how far up or down a pixel of the other kind is, at most ``reach``."""
    height, width = mask.shape
    for col in range(width):
        off[0, col] = reach
    for row in range(1, height):
        above, here, old, new = mask[row - 1], mask[row], off[row - 1], off[row]
        for col in range(width):
            new[col] = min(old[col] + 1, reach) if above[col] == here[col] else 1
    for row in range(height - 2, -1, -1):
        below, here, old, new = mask[row + 1], mask[row], off[row + 1], off[row]
        for col in range(width):
            new[col] = min(new[col], old[col] + 1 if below[col] == here[col] else 1)


@kernel
def near_distance_kernel(mask: NDArray[np.bool_], reach: int, phi: NDArray[np.float32]) -> None:
    """Write the distance to a mask's edge, positive inside; ±``reach`` from there on.

    First along columns, then along rows (Felzenszwalb & Huttenlocher 2012,
    doi:10.4086/toc.2012.v008a019), of both sides at once; only what is near the edge is searched.

    Parameters
    ----------
    mask : (height, width)
    reach
        px.
    phi : (height, width) px
        Written. An edge lies between two pixels, half a pixel from either.
    """
    height, width = mask.shape
    off = np.empty((height, width), dtype=np.int32)
    _along_columns(mask, reach, off)
    since = np.empty(width, dtype=np.int32)
    most = reach * reach
    for row in range(height):
        here, up, line = mask[row], off[row], phi[row]
        # how many columns off the nearest is that knows of an edge: none nearer can be the foot
        last = -reach
        for col in range(width):
            if up[col] < reach or (col > 0 and here[col] != here[col - 1]):
                last = col
            since[col] = col - last
        following = width + reach
        for col in range(width - 1, -1, -1):
            if up[col] < reach or (col < width - 1 and here[col] != here[col + 1]):
                following = col
            d = min(since[col], following - col)
            best = most
            while d * d < best:
                for side in (col - d, col + d):
                    if 0 <= side < width:
                        foot = up[side] if here[side] == here[col] else 0
                        best = min(best, d * d + foot * foot)
                d += 1
            far = np.float32(reach)
            if best < most:
                far = np.float32(np.sqrt(best)) - np.float32(0.5)
            line[col] = far if here[col] else -far
