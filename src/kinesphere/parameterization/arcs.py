"""How far a limb moves about its axes."""

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.axes.fit import Labels
from kinesphere.parameterization.samples import JointSamples, Phase

PERCENTILES = (5.0, 95.0)  # a range of motion leaves the extremes out


def arcs_about(samples: JointSamples, axes: Array, labels: Labels) -> tuple[Array, Array]:
    """Return the arc in rad and the cosine of the cone about each axis, (n_axes,) twice."""
    ranges, heights = np.zeros(len(axes)), np.full(len(axes), np.nan)
    for k, axis in enumerate(axes):
        mine = [samples.positions[a:b] for (a, b), at in labelled(samples, labels) if at == k]
        if mine:
            p = np.concatenate(mine)
            heights[k] = float(np.median(p @ axis))
            middle = p.mean(axis=0)
            azimuth = np.arctan2(
                np.cross(middle, p) @ axis, p @ middle - (p @ axis) * (middle @ axis)
            )
            # as an arc on the joint sphere: a full turn on a tiny circle is no movement
            arc = np.sqrt(max(0.0, 1 - heights[k] ** 2))
            ranges[k] = arc * float(np.diff(np.percentile(azimuth, PERCENTILES))[0])
    return ranges, heights


def labelled(samples: JointSamples, labels: Labels) -> list[tuple[Phase, int]]:
    """Return each phase with the axis it moves about."""
    return [(phase, int(label)) for phase, label in zip(samples.phases, labels, strict=True)]
