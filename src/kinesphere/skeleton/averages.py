"""Averages over what is seen: NaN left out, NaN where nothing is left, and no warnings."""

import numpy as np

from kinesphere.data import Array


def mean_seen(values: Array, axis: int = 0) -> Array:
    """Return the mean along an axis, NaN left out; NaN where all are NaN."""
    known = np.isfinite(values)
    count = known.sum(axis=axis)
    total = np.where(known, values, 0.0).sum(axis=axis)
    mean: Array = np.where(count > 0, total / np.maximum(count, 1), np.nan)
    return mean


def median_seen(values: Array) -> Array:
    """Return the median along the first axis, NaN left out; NaN where all are NaN."""
    flat = values.reshape(len(values), -1)
    columns = [column[np.isfinite(column)] for column in flat.T]
    medians = [float(np.median(column)) if len(column) else np.nan for column in columns]
    return np.array(medians).reshape(values.shape[1:])
