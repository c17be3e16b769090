"""The rest orientation, against the pose we called rest."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.rotations import rotation_angle
from kinesphere.parameterization.rest import paper_rest, rest_target, robust_rest
from kinesphere.parameterization.settings import RestSettings


def angle(a, b):
    return np.rad2deg(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b))


@pytest.mark.parametrize("cone", [60.0, 90.0, 110.0])
def test_both_circles_meet_at_rest(rng, calibration, cone):
    joint = calibration(rng, cone=cone)
    direction = joint.rest @ joint.long_axis
    target, unique = rest_target(joint.axes, joint.axes @ direction, direction, None)
    assert unique
    assert_allclose(target, direction, atol=1e-9)


def test_great_circles_are_the_papers_planes(rng, calibration):
    joint = calibration(rng)
    normal = np.cross(*joint.axes)
    normal /= np.linalg.norm(normal)
    for side in (1, -1):
        target, _ = rest_target(joint.axes, np.zeros(2), side * normal, None)
        assert_allclose(target, side * normal, atol=1e-12)


def test_circles_that_miss_give_the_nearest_direction():
    axes = np.eye(3)[:2]
    target, unique = rest_target(axes, np.array([0.8, 0.8]), np.array([0.5, 0.5, 0.1]), None)
    assert unique
    assert_allclose(target, np.array([1, 1, 0]) / np.sqrt(2), atol=1e-12)


def test_one_axis_rests_on_its_cone_where_the_limb_is_straight():
    axis = np.array([0.0, 0.0, 1.0])
    gravity = np.array([0.6, 0.6, 0.2])
    straight = np.array([0.0, -1.0, 0.0])
    target, _ = rest_target(axis[None], np.array([0.28]), gravity, straight)
    assert_allclose(target, [0, -0.96, 0.28], atol=1e-12)
    target, _ = rest_target(axis[None], np.array([0.28]), gravity, None)
    assert_allclose(target, [0.96 / np.sqrt(2), 0.96 / np.sqrt(2), 0.28], atol=1e-12)


def test_where_two_axes_are_one_gravity_decides():
    gravity = np.array([0.9, 1e-5, 0])
    axes = np.array([[1.0, 0, 0], [1.0, 1e-9, 0]])
    target, unique = rest_target(axes, np.zeros(2), gravity, None)
    assert not unique
    assert_allclose(target, [1, 0, 0], atol=1e-4)


@pytest.mark.parametrize("straight", [None, [1.0, 0.0, 0.0]])
@pytest.mark.parametrize("height", [-0.6, 0.0, 0.8])
def test_a_limb_that_goes_all_round_rests_on_its_cone_all_the_same(height, straight):
    """After whole turns the centre of gravity is on the axis, where the limb never is."""
    axes, gravity = np.eye(3)[:1], np.array([height, 1e-5, 0.0])
    straight = None if straight is None else np.array(straight)
    target, unique = rest_target(axes, np.array([height]), gravity, straight)
    assert not unique
    assert target[0] == pytest.approx(height, abs=1e-12)
    assert np.linalg.norm(target) == pytest.approx(1.0, abs=1e-12)


def test_the_mean_of_slow_samples_beats_one_sample(rng, calibration):
    joint = calibration(rng, independent=2.0)
    positions = joint.rotations @ joint.long_axis
    target = joint.rest @ joint.long_axis
    slow = ~joint.moving
    mean = robust_rest(joint.rotations, positions, slow, joint.axes, target, RestSettings())
    single = paper_rest(joint.rotations, positions, target)
    assert np.rad2deg(rotation_angle(mean.T @ joint.rest)) < 0.5
    assert rotation_angle(mean.T @ joint.rest) < rotation_angle(single.T @ joint.rest)
    assert (np.abs(joint.rotations - single).max(axis=(1, 2)) == 0).sum() == 1


def test_moving_samples_serve_only_where_slow_ones_are_missing(rng):
    axes, long_axis = np.eye(3)[:2], np.eye(3)[2]
    twists = np.repeat([0.1, 0.5], 8)
    rotations = Rotation.from_rotvec(twists[:, None] * long_axis).as_matrix()
    positions = rotations @ long_axis
    for slow, expected in (
        (np.repeat([True, False], 8), 0.1),
        (np.repeat([True, False], [3, 13]), 0.3),
    ):
        rest = robust_rest(rotations, positions, slow, axes, long_axis, RestSettings())
        assert_allclose(np.arctan2(rest[1, 0], rest[0, 0]), expected, atol=1e-9)


def test_a_knee_never_straight_has_a_straight_zero(rng):
    axis, long_axis = np.array([0.0, 0.0, -1.0]), np.array([0.0, -1.0, 0.0])
    bent = rng.uniform(0.6, 1.2, 50)
    rotations = Rotation.from_rotvec(bent[:, None] * axis).as_matrix()
    positions = rotations @ long_axis
    slow = rng.random(50) > 0.5
    rest = robust_rest(rotations, positions, slow, axis[None], long_axis, RestSettings())
    assert_allclose(rest, np.eye(3), atol=1e-9)


def test_the_nearest_sample_is_turned_where_none_is_near(rng):
    axes = np.eye(3)[:2]
    rotations = Rotation.from_rotvec([[0.5, 0, 0], [0.9, 0, 0]]).as_matrix()
    long_axis = np.array([0.0, 0.0, 1.0])
    slow = np.ones(2, dtype=bool)
    rest = robust_rest(
        rotations, rotations @ long_axis, slow, axes, long_axis, RestSettings(radius=1.0)
    )
    assert_allclose(rest, np.eye(3), atol=1e-12)
    assert angle(rest @ long_axis, long_axis) < 1e-6
