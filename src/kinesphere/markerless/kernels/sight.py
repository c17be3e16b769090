"""Lines of sight held against silhouettes."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel


@kernel
def hold_against_kernel(
    pixels: NDArray[np.float32],
    outside: NDArray[np.float32],
    worst: NDArray[np.float32],
    unseen: NDArray[np.bool_],
) -> None:
    """Raise, for points along lines of sight, the distance from lying in every silhouette.

    Parameters
    ----------
    pixels : (n_lines, n_points, 2)
        Where the points appear in one other camera; NaN behind it.
    outside : (height, width) px
        Of that camera: distance from its silhouette, 0 inside.
    worst : (n_lines, n_points) px
        Updated: the largest distance over cameras so far.
    unseen : (n_lines, n_points)
        Set where the point lies outside the camera's image.
    """
    height, width = outside.shape
    for i in range(pixels.shape[0]):
        for j in range(pixels.shape[1]):
            x, y = pixels[i, j, 0], pixels[i, j, 1]
            if x > -0.5 and y > -0.5 and x < width - 0.5 and y < height - 0.5:
                off = outside[int(y + 0.5), int(x + 0.5)]
                worst[i, j] = max(worst[i, j], off)
            else:
                unseen[i, j] = True


@kernel
def least_kernel(
    worst: NDArray[np.float32], unseen: NDArray[np.bool_], least: NDArray[np.float32]
) -> None:
    """Write each line's least distance, (n_lines,) px.

    NaN where no point is seen by all cameras, and where the line may pass through the person at a
    point that one camera cannot see: it cannot deny it.
    """
    for i in range(worst.shape[0]):
        best = np.inf
        for j in range(worst.shape[1]):
            if unseen[i, j]:
                if worst[i, j] == 0.0:
                    best = np.nan
                    break
            elif worst[i, j] < best:
                best = worst[i, j]
        least[i] = best if best < np.inf else np.nan
