"""Movement axes from the principal rotation axis of each movement phase. The default."""

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.axes.fit import phase_scatter, pooled_axes
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import AxesSettings


def phase_log_pca(samples: JointSamples, n_axes: int, settings: AxesSettings) -> Array:
    """Find movement axes from whole orientations, phase by phase.

    Rotations are taken relative to the mean of their phase; their logarithms lie along the axis
    the phase moves about, whatever angle the limb makes with it (a great circle is not assumed).
    Phases are told apart by their main axis, weighed by what they hold above isotropic noise, and
    each axis is the main eigenvector of the scatter of its phases together (isotropic noise
    does not turn it): the symmetric axis of rotation approach of Ehrig et al. 2007
    (doi:10.1016/j.jbiomech.2006.10.026), made local.

    Parameters
    ----------
    samples
        One joint.
    n_axes
        How many axes are wanted.
    settings
        Not used.

    Returns
    -------
    (n_found, 3)
    """
    del settings
    if not samples.phases:
        return np.empty((0, 3))
    found = phase_scatter(samples)
    noise = found.values[:, 1:].mean(axis=1)
    return pooled_axes(found.scatter, found.axes, found.values[:, 0] - noise, n_axes)
