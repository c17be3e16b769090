"""The axis methods by name."""

from collections.abc import Mapping

from kinesphere.data import Array
from kinesphere.parameterization.axes.direction_joining import direction_joining
from kinesphere.parameterization.axes.em import em, em_restarts
from kinesphere.parameterization.axes.fit import AxesMethod
from kinesphere.parameterization.axes.hinge import hinge_axis
from kinesphere.parameterization.axes.pca import pca
from kinesphere.parameterization.axes.phase_log_pca import phase_log_pca
from kinesphere.parameterization.axes.refinement import refine_axes
from kinesphere.parameterization.axes.sara import sara
from kinesphere.parameterization.axes.small_circle import small_circle
from kinesphere.parameterization.axes.universal_joint import universal_joint
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import AxesSettings

AXES: Mapping[str, AxesMethod] = {
    "phase-log-pca": phase_log_pca,
    "direction-joining": direction_joining,
    "pca": pca,
    "em": em,
    "em-restarts": em_restarts,
    "sara": sara,
    "small-circle": small_circle,
    "universal-joint": universal_joint,
}

BY_ORIENTATION = frozenset({"phase-log-pca", "sara"})
"""Methods that whole orientations serve, hence twist disturbs."""


def find_axes(samples: JointSamples, n_axes: int, settings: AxesSettings) -> Array:
    """Return up to ``n_axes`` axes by the method the settings name, (n_found, 3) unit vectors."""
    axes = AXES[settings.method](samples, n_axes, settings)
    if settings.refine and settings.method in BY_ORIENTATION and len(axes):
        return hinge_axis(samples, axes) if n_axes == 1 else refine_axes(samples, axes)
    return axes
