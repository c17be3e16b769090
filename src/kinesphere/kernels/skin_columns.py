"""How a joint's residuals follow skin that goes with it."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel


@kernel
def skin_columns_kernel(
    seeing: NDArray[np.float64],
    own: NDArray[np.float64],
    modes: NDArray[np.float64],
    columns: NDArray[np.float64],
) -> None:
    """Write the derivatives of residuals by the maps from a joint's rotation to poses' errors.

    Parameters
    ----------
    seeing : (n, 3, 6)
        By the error of the seeing limb's pose.
    own : (3, 6)
        By that of the turning limb's, the same in every frame.
    modes : (n, k)
        What the errors go with.
    columns : (n, 3, 12 k)
        Written: mode by mode of the seeing limb, then of the turning one.
    """
    k = modes.shape[1]
    for i in range(3):  # over frames: in plain Python hardly slower than compiled
        for m in range(k):
            for j in range(6):
                columns[:, i, 6 * m + j] = seeing[:, i, j] * modes[:, m]
                columns[:, i, 6 * (k + m) + j] = own[i, j] * modes[:, m]
