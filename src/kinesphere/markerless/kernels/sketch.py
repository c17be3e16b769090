"""What small drawings of a body are worth against small silhouettes."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

Values = NDArray[np.float32]


@kernel
def worth_kernel(drawn: NDArray[np.bool_], values: Values) -> float:
    """Return the sum of the values of what is drawn."""
    total = 0.0
    for row in range(drawn.shape[0]):
        for col in range(drawn.shape[1]):
            if drawn[row, col]:
                total += values[row, col]
    return total
