"""Axes made robust to twist: what a limb does about itself must not tilt what it moves about."""

from collections.abc import Iterator

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.axes.cone_and_twist import ConeAndTwist
from kinesphere.parameterization.axes.fit import phase_labels
from kinesphere.parameterization.axes.hinge import USUAL_COUPLING, off_by_probability
from kinesphere.parameterization.axes.likeliest import likeliest_axis
from kinesphere.parameterization.samples import JointSamples

MOST_FRAMES = 400  # of one axis; more change the axis by less than its uncertainty
ROUNDS = 12
USUAL_TWIST = 0.3  # rad for a rad of the angle, by which skin or limb turn about the limb: an upper
# arm's by a third to a half, whose axes are then 17 to 37° off


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
    refined = axes.copy()
    for k, errors in _errors(samples, axes):
        refined[k] = likeliest_axis(errors, axes[k], ROUNDS).axis
    return np.asarray(refined)


def other_readings(samples: JointSamples, axes: Array, wide: bool = False) -> Array:
    """Return how far each axis may be off for taking twist as error, (n_axes,) rad.

    As `kinesphere.parameterization.axes.hinge.other_reading`, but every phase has its own cone.

    Parameters
    ----------
    samples
        One joint.
    axes : (n_axes, 3)
        From `refine_axes`.
    wide
        Whether the limb is as wide as a trunk: such turn less about themselves with the angle.
    """
    usual = USUAL_COUPLING if wide else USUAL_TWIST
    off = np.zeros(len(axes))
    for k, errors in _errors(samples, axes):
        other = likeliest_axis(errors, axes[k], ROUNDS, coupling=usual)
        off[k] = off_by_probability(other, axes[k], usual)
    return off


def _errors(samples: JointSamples, axes: Array) -> Iterator[tuple[int, ConeAndTwist]]:
    """Yield what each axis leaves unexplained of its own phases; nothing where it has none."""
    labels = phase_labels(samples, axes)
    for k in range(len(axes)):
        mine = tuple(phase for phase, at in zip(samples.phases, labels, strict=True) if at == k)
        if mine:
            yield k, ConeAndTwist.of(samples, mine, MOST_FRAMES)
