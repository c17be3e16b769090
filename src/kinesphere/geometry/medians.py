"""Medians of columns with gaps. Arrays only."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def column_medians(values: Array, seen: NDArray[np.bool_] | None = None) -> Array:
    """Return the median of what is seen of each column, (n, m) → (m,); NaN where nothing is.

    All columns at once: `numpy.nanmedian` goes through them one by one.

    Parameters
    ----------
    values : (n, m)
        Anything where not seen.
    seen : (n, m)
        None where everything is.
    """
    n, m = values.shape
    if n == 0:
        return np.full(m, np.nan)
    if seen is None or seen.all():
        low, high = (n - 1) // 2, n // 2
        parted = np.partition(values.T, [low, high], axis=1)
        return np.asarray((parted[:, low] + parted[:, high]) / 2)
    count = seen.sum(axis=0)
    ordered = np.sort(np.where(seen, values, np.nan).T)  # what is NaN comes last
    at = np.stack([np.maximum(count - 1, 0) // 2, np.minimum(count // 2, n - 1)], axis=1)
    return np.asarray(np.take_along_axis(ordered, at, axis=1).sum(axis=1) / 2)
