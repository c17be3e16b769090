"""A second-order low-pass run over quaternions, there and back."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

Array = NDArray[np.float64]


@kernel
def both_ways_kernel(section: Array, steady: Array, values: Array, padding: int) -> Array:
    """Return values, (n, 4), filtered forward and then backward.

    As SciPy's ``sosfiltfilt`` with one section does: at the ends values go on as they came, turned
    about the last one, for ``padding`` frames, and the filter begins as if it had been steady.

    Parameters
    ----------
    section : (6,)
        Coefficients b0, b1, b2, 1, a1, a2.
    steady : (2,)
        State of the filter after a long row of ones.
    values : (n, 4)
        n above ``padding``.
    """
    n = len(values)
    long = np.empty((n + 2 * padding, 4))
    long[padding : padding + n] = values
    for f in range(padding):
        for i in range(4):
            long[f, i] = 2.0 * values[0, i] - values[padding - f, i]
            long[padding + n + f, i] = 2.0 * values[n - 1, i] - values[n - 2 - f, i]
    _filter(section, steady, long)
    _filter(section, steady, long[::-1])
    return long[padding : padding + n]


@kernel
def _filter(section: Array, steady: Array, values: Array) -> None:
    """Filter values, (n, 4), in place: the transposed direct form II."""
    b0, b1, b2, _, a1, a2 = section
    first, second = steady[0] * values[0], steady[1] * values[0]
    for f in range(len(values)):
        for i in range(4):
            x = values[f, i]
            y = b0 * x + first[i]
            first[i] = b1 * x - a1 * y + second[i]
            second[i] = b2 * x - a2 * y
            values[f, i] = y
