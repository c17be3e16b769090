"""The angles of one joint about axes that are given, and which side of each is positive."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.anatomy import declared_n_axes
from kinesphere.parameterization.angles import JointAngles, solve_angles
from kinesphere.parameterization.arcs import PERCENTILES
from kinesphere.parameterization.per_joint import parse_counts
from kinesphere.parameterization.settings import ParameterizationSettings
from kinesphere.parameterization.view import JointView


def solve_joint(
    view: JointView, axes: Array, rest: Array, settings: ParameterizationSettings
) -> JointAngles:
    """Return angles and twist of every frame, never smoothed."""
    options = settings.angles
    if len(axes) == 2 and declared_n_axes(view.name, parse_counts(settings.axes.counts)) == 1:
        # a second axis was added to a hinge: it takes what the hinge leaves, never a half turn,
        # and forearms twist too far for the least twist to tell the branches apart
        options = replace(options, branch="default-sign")
    return solve_angles(
        view.rotations,
        axes,
        rest,
        view.long_axis,
        view.twist_known,
        options,
        settings.twist,
        view.samples.rate,
    )


def larger_excursion_positive(
    view: JointView, axes: Array, rest: Array, settings: ParameterizationSettings
) -> Array:
    """Return axes turned so that the limb goes farther to the positive side of each."""
    angles = solve_joint(view, axes, rest, settings).angles[:, : len(axes)]
    signs = np.ones(len(axes))
    for k, column in enumerate(angles.T):
        known = column[np.isfinite(column)]
        if len(known) and np.percentile(known, PERCENTILES).sum() < 0:
            signs[k] = -1.0
    return axes * signs[:, None]
