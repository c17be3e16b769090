"""Principal components of stratified positions: the paper's first baseline (section 4.2)."""

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.axes.fit import moving_positions
from kinesphere.parameterization.axes.stratify import one_per_cell
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import AxesSettings


def pca(samples: JointSamples, n_axes: int, settings: AxesSettings) -> Array:
    """Find axes as ``(c − o) × d`` with the principal directions d of the positions.

    The components are orthogonal and of largest variance, which movement directions need not be:
    this is what the paper compares with, not what it recommends.

    Returns
    -------
    (n_found, 3)
    """
    points = moving_positions(samples)
    if len(points) < 3:
        return np.empty((0, 3))
    points = one_per_cell(points, np.deg2rad(settings.cell))
    centre = points.mean(axis=0)
    _, values, directions = np.linalg.svd(points - centre, full_matrices=False)
    axes = np.cross(centre, directions[: min(n_axes, 2)])
    length = np.linalg.norm(axes, axis=1)
    kept = (length > 1e-9) & (values[: len(axes)] > 1e-9)
    return np.asarray(axes[kept] / length[kept, None])
