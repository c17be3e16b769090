"""An angle that leaps from one frame to the next is flagged on both sides of the leap."""

import numpy as np

from kinesphere.parameterization.angles import JointAngles
from kinesphere.parameterization.joint_flags import leaps


def solved(angles, twists):
    n = len(angles)
    return JointAngles(angles=angles, twists=twists, excess=np.zeros(n), sines=np.ones(n))


def test_both_sides_of_a_leap_and_nothing_else():
    angles = np.full((9, 3), np.nan)
    angles[:, 0] = np.linspace(0.1, 0.9, 9)
    angles[:, 1] = [3.0, 3.1, -3.1, -3.0, -2.9, -0.9, -0.8, -0.7, -0.6]  # a wrap, then a leap
    twists = np.zeros(9)
    assert np.flatnonzero(leaps(solved(angles, twists))).tolist() == [4, 5]
    twists[8:] = 2.0
    assert np.flatnonzero(leaps(solved(angles, twists))).tolist() == [4, 5, 7, 8]


def test_what_is_not_known_does_not_leap():
    angles = np.full((5, 3), np.nan)
    angles[[0, 1, 3, 4], 0] = [0.0, 0.1, 3.0, 3.1]
    assert not leaps(solved(angles, np.full(5, np.nan))).any()
