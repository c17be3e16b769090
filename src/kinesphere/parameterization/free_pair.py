"""Two axes found in free motion, both moved about at once: how far, and why they may be wrong."""

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.even_frames import even_frames
from kinesphere.geometry.rotations import rotation_angle
from kinesphere.parameterization.angles import two_axis_angles
from kinesphere.parameterization.arcs import PERCENTILES
from kinesphere.parameterization.axes.spectra import spread_of_axes
from kinesphere.parameterization.axes.universal_joint import (
    SHORTEST,
    free_motion_of,
    reference_rotation,
)
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import AngleSettings, AxesSettings
from kinesphere.parameterization.view import JointView

CLOSEST = 30.0  # deg: about closer axes, large angles that cancel each other rebuild any motion
FARTHER = 1.25  # times the range of the whole joint: right axes 70 to 110° apart go up to 1.11
SHARED = 3.0  # times the spread that waves leave: errors are 2.1 times as large (rms) where the
# angles have rhythms of their own, 3.3 where they share one
COMPARED = 200  # poses, every one with every other


def in_free_motion(n_axes: int, options: AxesSettings) -> bool:
    """Return whether the method needs no main movements."""
    return options.method == "universal-joint" and n_axes == 2


def too_short(samples: JointSamples) -> str:
    """Return that free motion is too short to tell axes, a clause; empty where it is not."""
    moving = sum(b - a for a, b in samples.phases) / samples.rate
    if moving >= SHORTEST:
        return ""
    return f"free motion of {moving:.0f} s tells no axes: {SHORTEST:.0f} s are needed"


def free_ranges(view: JointView, axes: Array) -> tuple[Array, str]:
    """Return how far a joint moves about two axes at once, (2,) rad, and what speaks against it.

    No range counts for more than the joint's own: angles about axes that nearly coincide grow
    and cancel each other, which makes them no better known. Where they do so, a clause says it.
    """
    angles = two_axis_angles(
        view.samples.rotations,
        axes,
        reference_rotation(view.samples),
        view.long_axis,
        view.twist_known[view.calibration],
        AngleSettings(),
    ).angles[:, :2]
    low, high = np.percentile(angles, PERCENTILES, axis=0)
    ranges, most = np.asarray(high - low), own_range(view.samples)
    said = ""
    if ranges.max() > FARTHER * most:
        said = (
            f"an angle about these axes covers {np.rad2deg(ranges.max()):.0f}°, all the joint's "
            f"rotation {np.rad2deg(most):.0f}°"
        )
    return np.minimum(ranges, most), said


def shared_rhythm(samples: JointSamples, axes: Array) -> Array:
    """Return how far two axes may be off for rhythms that their angles share, (2,) rad."""
    return SHARED * spread_of_axes(free_motion_of(samples).thinned(), axes)


def own_range(samples: JointSamples) -> float:
    """Return the largest rotation between two poses of a joint, rad."""
    some = samples.rotations[even_frames(len(samples.rotations), COMPARED)]
    apart = rotation_angle(np.einsum("nji,mjk->nmik", some, some))
    return float(apart.max())
