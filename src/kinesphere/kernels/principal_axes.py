"""Principal axes of a handful of points in every frame."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.eigenvectors import LANES, diagonalize
from kinesphere.kernels.jit import kernel


@kernel
def principal_axes_kernel(
    covariances: NDArray[np.float64], axes: NDArray[np.float64], variances: NDArray[np.float64]
) -> None:
    """Turn the covariances of every frame into principal axes, by falling variance.

    Parameters
    ----------
    covariances : (n_frames, 3, 3) m²
        Symmetric, finite.
    axes : (n_frames, 3, 3)
        Written: axes in the columns, of either sign.
    variances : (n_frames, 3) m²
        Written: along each of them, not below zero.
    """
    # a row and a column of zeros beside: nothing ever turns into them
    m, v = np.zeros((4, 4, LANES)), np.empty((4, 4, LANES))
    for start in range(0, len(covariances), LANES):
        n = min(LANES, len(covariances) - start)
        m[:3, :3, n:] = 0.0
        for f in range(n):
            m[:3, :3, f] = covariances[start + f]
        diagonalize(m, v)
        for f in range(n):
            first, second, third = 0, 1, 2
            if m[second, second, f] > m[first, first, f]:
                first, second = second, first
            if m[third, third, f] > m[second, second, f]:
                second, third = third, second
            if m[second, second, f] > m[first, first, f]:
                first, second = second, first
            for column, at in enumerate((first, second, third)):
                axes[start + f, :, column] = v[:3, at, f]
                variances[start + f, column] = max(m[at, at, f], 0.0)
