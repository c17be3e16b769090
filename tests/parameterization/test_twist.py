"""The twist about the limb: closed form against sampling."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.rotations import rotation_about
from kinesphere.parameterization.kernels import twist_between
from kinesphere.parameterization.twist import closed_twist, sampled_twist


def frames(rng, n, tilt):
    """Model and actual orientations a twist and a tilt of some rad apart, and the limb."""
    long_axis = Rotation.random(rng=rng).apply([0, 1, 0])
    model = Rotation.random(n, rng=rng)
    twist = rng.uniform(-np.pi, np.pi, n)
    across = np.cross(long_axis, rng.normal(size=(n, 3)))
    across *= tilt / np.linalg.norm(across, axis=1, keepdims=True)
    off = Rotation.from_rotvec(across)
    actual = model * off * Rotation.from_rotvec(twist[:, None] * long_axis)
    return model.as_matrix(), actual.as_matrix(), long_axis, twist


def test_a_pure_twist_comes_back(rng):
    model, actual, long_axis, twist = frames(rng, 40, 0.0)
    assert_allclose(closed_twist(model, actual, long_axis), twist, atol=1e-12)


def test_twisting_further_adds_up(rng):
    model, actual, long_axis, _ = frames(rng, 40, 0.4)
    plain = closed_twist(model, actual, long_axis)
    limb = (model @ long_axis)[0]
    more = closed_twist(rotation_about(limb, np.array(-0.3)) @ model[:1], actual[:1], long_axis)
    assert_allclose(np.angle(np.exp(1j * (more - plain[:1] - 0.3))), 0, atol=1e-12)


def test_turning_both_frames_changes_nothing(rng):
    model, actual, long_axis, _ = frames(rng, 40, 0.4)
    turn = Rotation.random(rng=rng).as_matrix()
    assert_allclose(
        closed_twist(turn @ model, turn @ actual, long_axis),
        closed_twist(model, actual, long_axis),
        atol=1e-12,
    )


def test_swapping_the_frames_turns_the_sign(rng):
    model, actual, long_axis, _ = frames(rng, 40, 0.3)
    forward = closed_twist(model, actual, long_axis)
    assert_allclose(closed_twist(actual, model, long_axis), -forward, atol=1e-12)


@pytest.mark.parametrize("tilt", [0.0, 0.15])
def test_sampling_comes_within_a_step(rng, tilt):
    model, actual, long_axis, _ = frames(rng, 25, tilt)
    step = np.deg2rad(1.0)
    off = sampled_twist(model, actual, long_axis, step) - closed_twist(model, actual, long_axis)
    # the paper's sum of three angles has its minimum a little aside once the limb is tilted
    assert np.abs(np.angle(np.exp(1j * off))).max() <= step / 2 + tilt / 4 + 1e-9


def test_the_kernel_is_the_same_formula(rng):
    model, actual, long_axis, _ = frames(rng, 7, 0.5)
    one_by_one = [twist_between(a, b, long_axis) for a, b in zip(model, actual, strict=True)]
    assert_allclose(one_by_one, closed_twist(model, actual, long_axis), atol=1e-12)
