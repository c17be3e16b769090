"""A motion cut into stretches that have waves of their own, all of the same frequencies."""

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.axes.free_motion import FLATTEST, FLOOR, FreeMotion
from kinesphere.parameterization.axes.joint_kernels import angles_and_loads
from kinesphere.parameterization.axes.waves import Stretch

STRETCH = 20.0  # s that have waves of their own; longer ones cost more than they tell
LONGEST_REST = 2.0  # s; nobody keeps time over more, so longer ones count as that
FASTEST = 2.0  # Hz; what is faster counts as error
PER_WAVE = 2.5  # frames at least
FINENESS = 1.5  # waves per resolvable frequency: a rhythm may lie between two


def stretches_of(motion: FreeMotion, axes: Array) -> tuple[list[Stretch], Array]:
    """Cut the motion; return its stretches and the frequencies, (n_waves,) Hz, of all of them."""
    gaps = np.minimum(np.diff(motion.times), LONGEST_REST)
    times = np.concatenate([[0.0], np.cumsum(gaps)])
    gap = float(np.median(gaps))
    whole = float(times[-1]) + gap
    count = max(1, round(whole / STRETCH))
    length = whole / count
    fastest = min(FASTEST, 1 / (PER_WAVE * gap))
    frequencies = np.arange(1, int(fastest * length * FINENESS) + 1) / (length * FINENESS)
    angles, *_ = angles_and_loads(
        motion.rotations, axes[0], axes[1], motion.reference, motion.long_axis, FLATTEST
    )
    spread = np.clip(angles.var(axis=0), FLOOR**2, 1.0)
    sizes = np.repeat(spread[:, None] / len(frequencies), len(frequencies), axis=1)
    inside = np.minimum((times / length).astype(int), count - 1)
    stretches = []
    for i in np.unique(inside):
        at = inside == i
        turns = 2 * np.pi * np.outer(times[at] - (i + 0.5) * length, frequencies)
        waves = np.concatenate([np.cos(turns), np.sin(turns)], axis=1)
        stretches.append(Stretch(motion.rotations[at], waves, angles[at], sizes.copy()))
    return stretches, frequencies
