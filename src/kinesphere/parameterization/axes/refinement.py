"""Axes made robust to twist: what a limb does about itself must not tilt what it moves about."""

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.axes.cone_and_twist import ConeAndTwist
from kinesphere.parameterization.axes.fit import phase_labels
from kinesphere.parameterization.axes.likeliest import likeliest_axis
from kinesphere.parameterization.samples import JointSamples

MOST_FRAMES = 400  # of one axis; more change the axis by less than its uncertainty
ROUNDS = 12


def refine_axes(samples: JointSamples, axes: Array) -> Array:
    """Refine each axis in its own phases, weighing what cone and twist tell.

    Where the limb twists while it moves, the twist loses its weight by itself; where it does not,
    orientations count in full; see `ConeAndTwist`. A movement may be done in several postures, so
    every phase has a cone of its own.

    Parameters
    ----------
    samples
        One joint.
    axes : (n_axes, 3)
        Start; within some 40° of the truth.

    Returns
    -------
    (n_axes, 3)
    """
    labels = phase_labels(samples, axes)
    refined = axes.copy()
    for k in range(len(axes)):
        mine = tuple(phase for phase, at in zip(samples.phases, labels, strict=True) if at == k)
        if mine:
            errors = ConeAndTwist.of(samples, mine, MOST_FRAMES)
            refined[k] = likeliest_axis(errors, axes[k], ROUNDS).axis
    return np.asarray(refined)
