"""Movement axes from positions alone, for limbs that are not perpendicular to their axes."""

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.axes.fit import pooled_axes
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import AxesSettings

ROUNDING = 1e-9  # of the largest eigenvalue


def small_circle(samples: JointSamples, n_axes: int, settings: AxesSettings) -> Array:
    """Find the axes of the circles that the limb's direction draws, phase by phase.

    A rotation keeps ``a·p`` constant, so the axis is the direction of least variance of the
    *centred* positions: the cone may have any opening. Needs no orientation, hence serves limbs
    whose twist nobody knows, and is blind to twist.

    Returns
    -------
    (n_found, 3)
    """
    del settings
    if not samples.phases:
        return np.empty((0, 3))
    scatter = np.empty((len(samples.phases), 3, 3))
    for i, (start, stop) in enumerate(samples.phases):
        centred = samples.positions[start:stop] - samples.positions[start:stop].mean(axis=0)
        scatter[i] = centred.T @ centred
    values, vectors = np.linalg.eigh(scatter)
    # the middle eigenvalue, the arc's sagitta, is what tells the axis from the tangent; where it is
    # rounding, as of two frames, any line across the movement is as good
    told = values[:, 1] > ROUNDING * values[:, 2]
    weights = (values[:, 1] - values[:, 0])[told]
    return pooled_axes(-scatter[told], vectors[told, :, 0], weights, n_axes)
