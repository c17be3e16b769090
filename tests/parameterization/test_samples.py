"""Smoothing of rotations: zero phase, whatever the quaternion's sign, run by run."""

import numpy as np
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from kinesphere.geometry.rotations import rotation_angle
from kinesphere.parameterization.samples import runs, smooth_rotations


def apart(a, b):
    return rotation_angle(np.swapaxes(a, -1, -2) @ b)


def test_a_limb_that_turns_on_and_on_is_followed(rng):
    start = Rotation.random(rng=rng)
    angles = np.linspace(0, 20, 400)  # the quaternion's sign changes six times
    turning = (Rotation.from_rotvec(angles[:, None] * [0.6, 0.0, 0.8]) * start).as_matrix()
    smooth = smooth_rotations(turning, 100.0, 4.0)
    assert apart(smooth, turning)[30:-30].max() < 2e-3  # nothing lags behind


def test_noise_shrinks_and_slow_motion_stays(rng):
    t = np.arange(600) / 100
    slow = Rotation.from_rotvec(0.6 * np.sin(2 * np.pi * 0.5 * t)[:, None] * [0, 1.0, 0])
    noisy = (Rotation.from_rotvec(0.02 * rng.normal(size=(600, 3))) * slow).as_matrix()
    smooth = smooth_rotations(noisy, 100.0, 4.0)
    before, after = apart(noisy, slow.as_matrix()), apart(smooth, slow.as_matrix())
    assert after[40:-40].mean() < 0.4 * before[40:-40].mean()


def test_gaps_part_the_runs(rng):
    whole = Rotation.from_rotvec(0.1 * rng.normal(size=(60, 3)).cumsum(axis=0)).as_matrix()
    gappy = whole.copy()
    gappy[25:28] = np.nan
    gappy[30:] = np.nan  # two frames alone between two gaps
    smooth = smooth_rotations(gappy, 50.0, 4.0)
    assert_array_equal(np.isnan(smooth), np.isnan(gappy))
    assert_array_equal(smooth[28:30], whole[28:30])
    assert_allclose(smooth[:25], smooth_rotations(whole[:25], 50.0, 4.0))


def test_a_low_pass_that_the_rate_cannot_carry_filters_nothing(rng):
    rotations = Rotation.random(9, rng=rng).as_matrix()
    assert smooth_rotations(rotations, 8.0, 4.0) is rotations
    assert smooth_rotations(rotations, 100.0, 0.0) is rotations
    assert apart(smooth_rotations(rotations, 12.0, 4.0), rotations).max() > 0.1


def test_runs_are_counted_like_slices():
    assert runs(np.array([1, 1, 0, 1, 0, 0, 1], dtype=bool)) == ((0, 2), (3, 4), (6, 7))
    assert runs(np.zeros(0, dtype=bool)) == ()
