"""How joints turn, against turns we made."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.geometry import joint_turns as joint_turns_module
from kinesphere.geometry.centres import Turning
from kinesphere.geometry.joint_turns import (
    crowds,
    has_one_axis,
    joint_modes,
    joint_turns,
    main_axis,
    nearest_poses,
)
from kinesphere.geometry.rotations import rotation_exp

AXIS = np.array([0.0, 0.6, 0.8])
ACROSS = np.array([1.0, 0.0, 0.0])


def bent(angles_deg, about=AXIS):
    return rotation_exp(np.deg2rad(angles_deg)[:, None] * about)


def turning(rotations):
    return Turning(rotations, np.zeros((len(rotations), 3)), np.eye(6), 1e-3)


def test_turns_are_small_rotations_about_their_mean():
    angles = np.array([-3.0, 0.0, 3.0])
    assert_allclose(joint_turns(bent(angles)), np.deg2rad(angles)[:, None] * AXIS, atol=1e-12)
    assert (joint_modes(bent(angles)) ** 2).sum(axis=1).mean() == pytest.approx(3.0)


def test_the_main_axis_is_told_in_the_seeing_limb(rng):
    turn = rotation_exp(rng.normal(size=3))
    axis, strays = main_axis(turning(turn @ bent(np.linspace(0, 90, 50))))
    assert abs(axis @ turn @ AXIS) == pytest.approx(1.0)
    assert strays == pytest.approx(0.0, abs=1e-12)


def test_single_rotations_stray_from_the_axis_by_a_second_movement(rng):
    first, second = 10.0 * rng.normal(size=(2, 20000)) * [[1.0], [0.2]]
    _, strays = main_axis(
        turning(rotation_exp(np.deg2rad(np.outer(first, AXIS) + np.outer(second, ACROSS))))
    )
    assert strays == pytest.approx(0.04, rel=0.05)


def test_what_never_turns_has_no_main_axis():
    assert main_axis(turning(bent(np.zeros(20))))[1] == 1.0


@pytest.mark.parametrize(
    ("second", "blur", "single"),
    [(0.0, 1.0, True), (2.0, 1.0, False), (2.0, 3.0, True), (15.0, 90.0, False)],
)
def test_a_second_axis_is_what_noise_and_skin_cannot_feign(second, blur, single):
    t = np.linspace(0, 40, 400)
    rotations = bent(30 * np.sin(t)) @ bent(np.sqrt(2) * second * np.sin(0.7 * t), ACROSS)
    assert has_one_axis(joint_turns(rotations), np.deg2rad(blur) ** 2) == single


def test_a_pose_that_is_held_is_a_crowd():
    crowd = crowds(bent(np.concatenate([np.zeros(70), [40.0, 80.0]])))
    assert_allclose(crowd[:70], 70.0, rtol=1e-6)
    assert_allclose(crowd[70:], 1.0, rtol=1e-6)


def test_the_nearest_pose_is_another_one():
    assert_allclose(nearest_poses(bent(np.array([0.0, 50.0, 2.0, 51.0]))), [2, 3, 0, 1])


def test_a_pose_that_is_held_is_nearest_to_itself_seen_again():
    near = nearest_poses(bent(np.array([10.0, 10.0, 10.0, 40.0])))
    assert (near != np.arange(4)).all()
    assert set(near[:3]) <= {0, 1, 2}


def test_crowds_are_counted_the_same_in_blocks(rng, monkeypatch):
    rotations = rotation_exp(0.2 * rng.normal(size=(50, 3)))
    whole = crowds(rotations)
    monkeypatch.setattr(joint_turns_module, "BLOCK", 7)
    assert_allclose(crowds(rotations), whole, rtol=1e-12)
