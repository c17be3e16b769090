"""Movement axes from the resultant of each phase's rotations: no logarithm needed."""

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.axes.fit import pooled_axes
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import AxesSettings


def sara(samples: JointSamples, n_axes: int, settings: AxesSettings) -> Array:
    """Find the directions that each phase's rotations leave in place.

    With ``B = Σ Qᵢ`` over a phase, ``B Bᵀ/n²`` has eigenvalue 1 along an axis that every rotation
    shares and less across; the matrices are pooled by axis (Ehrig et al. 2007,
    doi:10.1016/j.jbiomech.2006.10.026, in the joint's own frame).

    Returns
    -------
    (n_found, 3)
    """
    del settings
    if not samples.phases:
        return np.empty((0, 3))
    parts = np.empty((len(samples.phases), 3, 3))
    for i, (start, stop) in enumerate(samples.phases):
        n = stop - start
        b = samples.rotations[start:stop].sum(axis=0)
        parts[i] = b @ b.T / n
    values, vectors = np.linalg.eigh(parts)
    # what the rotations spread across the axis, less what they spread about it
    weights = np.maximum(values[:, 2] - values[:, :2].mean(axis=1), 0)
    return pooled_axes(parts, vectors[:, :, 2], weights, n_axes)
