"""Axes from a joint's own movement: the phases that tell them best."""

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.range_of_motion import range_of_motion
from kinesphere.parameterization.axes import find_axes
from kinesphere.parameterization.axes.fit import phase_labels
from kinesphere.parameterization.free_pair import in_free_motion
from kinesphere.parameterization.judged_axes import MovementAxes, judged
from kinesphere.parameterization.main_movements import SHORTER, long_phases, main_movements
from kinesphere.parameterization.one_of_two import REPEATED
from kinesphere.parameterization.repeats import repeats
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import ParameterizationSettings
from kinesphere.parameterization.slow_movement import widest_swing
from kinesphere.parameterization.view import JointView


def movement_axes(view: JointView, n_axes: int, settings: ParameterizationSettings) -> MovementAxes:
    """Return axes from the movement, how good they are, and what speaks against them."""
    options = settings.axes
    if options.method == "body":
        return MovementAxes(np.empty((0, 3)), None, ())

    def find(half: JointSamples) -> Array:
        return find_axes(half, n_axes, options)

    free = in_free_motion(n_axes, options)

    def search(among: JointSamples) -> tuple[JointSamples, Array]:
        once = None
        for phases in (among.phases,) if free else main_movements(among, options):
            if once is not None and phases == among.phases:
                break  # phases of any kind repeat nothing
            samples = among.with_phases(phases)
            axes = find(samples)
            if len(axes) == n_axes:
                if repeats(samples, axes, phase_labels(samples, axes)).min() >= REPEATED:
                    return samples, axes
                once = once or (samples, axes)
        return once or (samples, axes)

    samples, axes = search(view.samples)
    if len(axes) == 0:
        return MovementAxes(axes, None, (_why_nothing(view, settings),))
    found = judged(view, samples, axes, n_axes, find, search, settings)
    long = long_phases(samples)
    if found.doubtful(options) and not free and 0 < len(long) < len(samples.phases):
        calmer = samples.with_phases(long)
        again = find(calmer)
        if len(again) == n_axes:
            second = judged(view, calmer, again, n_axes, find, search, settings)
            if not second.doubtful(options):
                return second
    if n_axes == 2 and found.doubts and found.told is None and not free:
        shorter = view.samples.with_phases(next(main_movements(view.samples, options, SHORTER)))
        again = find(shorter)
        if len(again):
            second = judged(view, shorter, again, n_axes, find, search, settings)
            if second.often_told(options):
                return second
    return found


def _why_nothing(view: JointView, settings: ParameterizationSettings) -> str:
    """Return why a joint has no movement to find axes in, as a clause."""
    if not view.calibration.any():
        return "it is never seen"
    enough = np.deg2rad(settings.axes.smallest_range)
    if widest_swing(view.samples.positions) < enough:
        if range_of_motion(view.samples.rotations) >= enough:
            return "the limb turns about its own length alone"
        return "the limb hardly moves"
    return "the limb moves too slowly to be told from noise"
