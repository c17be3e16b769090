"""One joint as the whole recording shows it: samples, movement, calibration."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array, Mask
from kinesphere.parameterization.movement_filter import Movement, find_movement
from kinesphere.parameterization.samples import JointSamples, runs, smooth_rotations
from kinesphere.parameterization.settings import ParameterizationSettings


@dataclass(frozen=True, eq=False)
class JointView:
    """One joint as the whole recording shows it."""

    name: str
    rotations: Array
    """(n_frames, 3, 3) ``parent_from_child``; NaN where unseen."""
    long_axis: Array
    """(3,) in the child."""
    twist_known: Mask
    """(n_frames,) False where the orientation about the limb is arbitrary."""
    samples: JointSamples
    """Smoothed, with the movement phases inside the calibration window."""
    movement: Movement
    calibration: Mask
    """(n_frames,) seen frames that axes and rest are taken from."""

    @property
    def gravity(self) -> Array:
        """(3,) centre of gravity of the samples; the limb aligned with its parent without any."""
        p = self.samples.positions[self.calibration]
        return np.asarray(p.mean(axis=0)) if len(p) else self.long_axis


def view_joint(
    name: str,
    rotations: Array,
    long_axis: Array,
    twist_known: Mask,
    rate: float,
    calibration: Mask,
    settings: ParameterizationSettings,
) -> JointView:
    """Smooth one joint's rotations and find its movement phases; arguments as in `JointView`."""
    literal = settings.filter.method == "paper"
    smooth = rotations if literal else smooth_rotations(rotations, rate, settings.filter.cutoff)
    positions = smooth @ long_axis
    movement = find_movement(positions, rate, settings.filter, calibration)
    seen = np.asarray(np.isfinite(positions).all(axis=1) & calibration)
    samples = JointSamples(smooth, positions, runs(movement.moving & seen), rate, long_axis)
    return JointView(name, rotations, long_axis, twist_known, samples, movement, seen)
