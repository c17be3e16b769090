"""Alternating nearest plane and refit: the paper's second baseline (section 4.2)."""

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.axes.fit import moving_positions, plane_normal
from kinesphere.parameterization.axes.pca import pca
from kinesphere.parameterization.axes.stratify import one_per_cell
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import AxesSettings

ROUNDS = 100
SEED = 20061  # the restarts are part of the method, not of the data: the same in every run


def em(samples: JointSamples, n_axes: int, settings: AxesSettings) -> Array:
    """Refine the principal components by expectation maximization, hard assignment.

    Returns
    -------
    (n_found, 3)
    """
    points = moving_positions(samples)
    start = pca(samples, n_axes, settings)
    if len(start) < n_axes or len(points) < 3:
        return start
    return _alternate(one_per_cell(points, np.deg2rad(settings.cell)), start)[0]


def em_restarts(samples: JointSamples, n_axes: int, settings: AxesSettings) -> Array:
    """Take the best of many random starts: the paper's argument against EM is its start.

    Returns
    -------
    (n_found, 3)
    """
    points = moving_positions(samples)
    if len(points) < 3:
        return np.empty((0, 3))
    points = one_per_cell(points, np.deg2rad(settings.cell))
    rng = np.random.default_rng(SEED)
    starts = rng.normal(size=(settings.restarts, min(n_axes, 2), 3))
    starts /= np.linalg.norm(starts, axis=2, keepdims=True)
    tried = [_alternate(points, start) for start in starts]
    return min(tried, key=lambda pair: pair[1])[0]


def _alternate(points: Array, axes: Array) -> tuple[Array, float]:
    """Return axes and the mean squared distance of the points to their planes."""
    labels = np.full(len(points), -1)
    for _ in range(ROUNDS):
        new = np.abs(points @ axes.T).argmin(axis=1)
        if (new == labels).all():
            break
        labels = new
        axes = np.array(
            [
                plane_normal(points[labels == k]) if (labels == k).sum() >= 2 else axis
                for k, axis in enumerate(axes)
            ]
        )
    return axes, float((np.abs(points @ axes.T).min(axis=1) ** 2).mean())
