"""What pairs of points cost that bear pairs of labels."""

import numpy as np

from kinesphere.data import Array
from kinesphere.kernels.jit import kernel
from kinesphere.labelling.kernels.types import Indices, Single

_SOFT = 6.0
"""z / (1 + z / 6): no single pair, however wrong, outweighs six that fit."""


@kernel
def _share(log_std: float) -> float:
    """Return what the mean of a distance with this logarithm of its deviation may be off by."""
    std = max(np.exp(log_std) - 0.005, 0.0)
    return float(0.6 * std * std)


@kernel
def pair_costs(
    mean: Array,
    log_std: Array,
    variance: Array,
    weight: Array,
    expected: Array,
    expected_variance: Array,
    expected_log: Array,
    log_variance: Array,
    stiller: float,
    outlier: float,
    only: int,
    costs: Single,
) -> None:
    """Fill the cost of every two points bearing every two labels.

    Parameters
    ----------
    mean, log_std, variance, weight : (n_points, n_points)
        Of the recording: mean distance, log of its deviation, what the mean may be off by
        (squared), and how much the pair counts (0 where never seen together).
    expected, expected_variance, expected_log, log_variance : (n_labels, n_labels)
        Of the template; NaN where it knows nothing of a pair.
    stiller
        What a deviation below the expected one counts, beside one above it.
    outlier
        What a pair costs about which nothing is known: the zero of all costs.
    only
        The label whose costs are filled; −1 for all.
    costs : (n_points, n_labels, n_points, n_labels)
    """
    n, m = mean.shape[0], expected.shape[0]
    for k in range(n):
        for p in range(n):
            if k == p or not weight[k, p] > 0:
                continue
            for i in range(m):
                for j in range(m):
                    if only >= 0 and i != only and j != only:
                        continue
                    mu = expected[i, j]
                    if i == j or not np.isfinite(mu):
                        continue
                    v = expected_variance[i, j] + variance[k, p]
                    x = (mean[k, p] - mu) ** 2 / (2 * v)
                    y = (log_std[k, p] - expected_log[i, j]) ** 2 / (2 * log_variance[i, j])
                    if log_std[k, p] < expected_log[i, j]:
                        y *= stiller
                    usual = expected_variance[i, j] + _share(expected_log[i, j])
                    cost = x / (1 + x / _SOFT) + y / (1 + y / _SOFT) + 0.5 * np.log(v / usual)
                    costs[k, i, p, j] = weight[k, p] * (cost - outlier)


@kernel
def linear_terms(labels: Indices, costs: Single) -> Array:
    """Return (n_points, n_labels): what each point would cost with each label beside the others."""
    n, m = costs.shape[0], costs.shape[1]
    terms = np.zeros((n, m))
    for p in range(n):
        j = labels[p]
        if j >= 0:
            for k in range(n):
                for i in range(m):
                    terms[k, i] += costs[p, j, k, i]  # the same as [k, i, p, j], but in one row
    return terms


@kernel
def pair_energy(labels: Indices, costs: Single) -> float:
    """Return the cost of all pairs of labelled points."""
    total = 0.0
    n = labels.shape[0]
    for k in range(n):
        i = labels[k]
        if i >= 0:
            for p in range(k + 1, n):
                j = labels[p]
                if j >= 0:
                    total += costs[k, i, p, j]
    return total
