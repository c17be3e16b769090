"""What several recordings show of a layout, together."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, MarkerStatistics
from kinesphere.geometry.signature import scale_of

DEVIATION_FLOOR = 0.005
"""Added to a deviation before its logarithm is taken, in scales of the body: 3 cm on a full layout.
With twice that a hand that hangs still is hardly told from a marker on the thigh."""


class Pool(NamedTuple):
    """What recordings show, in scales of the body; (n, n) each, NaN where none knows anything."""

    n: NDArray[np.int64]
    """Recordings that know the pair."""
    mean: Array
    squares: Array
    """Sum of the squares by which means differ from their mean."""
    mean_square: Array
    """Mean square of the deviation over time."""
    log_std: Array
    log_squares: Array
    size: float


def pooled(statistics: Sequence[MarkerStatistics], labels: tuple[str, ...]) -> Pool:
    """Return what recordings show together of these labels."""
    parts = [_taken(one, labels) for one in statistics]
    scales = _scales([mean for mean, _ in parts])
    mean = np.stack([m / scale for (m, _), scale in zip(parts, scales, strict=True)])
    std = np.stack([s / scale for (_, s), scale in zip(parts, scales, strict=True)])
    logs = np.log(std + DEVIATION_FLOOR)
    middle, log_middle = _mean(mean), _mean(logs)
    return Pool(
        n=np.isfinite(mean).sum(axis=0),
        mean=middle,
        squares=np.nansum((mean - middle) ** 2, axis=0),
        mean_square=_mean(std**2),
        log_std=log_middle,
        log_squares=np.nansum((logs - log_middle) ** 2, axis=0),
        size=float(np.mean(scales)),
    )


def _taken(statistics: MarkerStatistics, labels: tuple[str, ...]) -> tuple[Array, Array]:
    """Return mean and deviation of these labels, NaN where the recording has none."""
    at = {label: i for i, label in enumerate(statistics.labels)}
    here = [i for i, label in enumerate(labels) if label in at]
    there = [at[labels[i]] for i in here]
    found = np.full((2, len(labels), len(labels)), np.nan)
    found[0][np.ix_(here, here)] = statistics.mean[np.ix_(there, there)]
    found[1][np.ix_(here, here)] = statistics.deviation[np.ix_(there, there)]
    return found[0], found[1]


def _scales(means: Sequence[Array]) -> list[float]:
    """Return each recording's scale; one that lacks markers is measured by those it shares."""
    whole = [bool(np.isfinite(mean).all()) for mean in means]
    full = max(range(len(means)), key=lambda k: (np.isfinite(means[k]).sum(), -k))
    base = scale_of(means[full])
    scales = []
    for k, mean in enumerate(means):
        if whole[k] or k == full:
            scales.append(scale_of(mean))
            continue
        both = np.isfinite(mean) & np.isfinite(means[full]) & (means[full] > 0)
        ratio = float(np.median(mean[both] / means[full][both])) if both.any() else 1.0
        scales.append(base * ratio)
    return scales


def _mean(values: Array) -> Array:
    """Return the mean over recordings, NaN where none knows anything."""
    known = np.isfinite(values)
    n = known.sum(axis=0)
    total = np.where(known, values, 0.0).sum(axis=0)
    return np.where(n > 0, total / np.maximum(n, 1), np.nan)
