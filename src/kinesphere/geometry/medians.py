"""Medians of columns with gaps. Arrays only."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def column_medians(values: Array, seen: NDArray[np.bool_] | None = None) -> Array:
    """Return the median of what is seen of each column, (n, m) → (m,); NaN where nothing is.

    Sorting all columns at once takes a fraction of the time of `numpy.median`, let alone of
    `numpy.nanmedian`, on some hundred rows.

    Parameters
    ----------
    values : (n, m)
        Anything where not seen.
    seen : (n, m)
        None where everything is.
    """
    n, m = values.shape
    count = np.full(m, n)
    if seen is not None:
        values, count = np.where(seen, values, np.nan), seen.sum(axis=0)
    if not count.all():
        some = count > 0
        medians = np.full(m, np.nan)
        if some.any():
            medians[some] = column_medians(values[:, some], np.isfinite(values[:, some]))
        return medians
    ordered = np.sort(values.T)  # what is NaN comes last
    middle = np.take_along_axis(ordered, np.stack([(count - 1) // 2, count // 2], axis=1), 1)
    return np.asarray(middle.sum(axis=1) / 2)
