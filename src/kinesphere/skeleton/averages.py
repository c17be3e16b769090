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
    ranked = np.sort(np.where(np.isfinite(flat), flat, np.nan), axis=0)  # NaN last
    count = np.isfinite(ranked).sum(axis=0)
    column = np.arange(flat.shape[1])
    low = ranked[np.maximum(count - 1, 0) // 2, column]
    high = ranked[np.minimum(count // 2, len(flat) - 1), column]
    middle: Array = np.where(count % 2 == 1, low, (low + high) / 2)
    return middle.reshape(values.shape[1:])
