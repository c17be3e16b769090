"""Three angles about coordinate axes, against SciPy and against the rotations themselves."""

import warnings
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.euler import continuous_angles, euler_angles, swing_angles
from kinesphere.geometry.rotations import rotation_about

EXACT = 1e-12  # rad; rounding of a few products
ORDERS = ["".join(order) for order in permutations("xyz")]


def product(angles, order):
    """Return R_first(a) R_second(b) R_third(c), the definition written out."""
    a, b, c = (
        rotation_about(np.eye(3)["xyz".index(letter)], angles[..., k])
        for k, letter in enumerate(order)
    )
    return a @ b @ c


@pytest.mark.parametrize("order", ORDERS)
def test_same_as_scipy_away_from_the_singularity(rng, order):
    angles = rng.uniform((-np.pi, -1.5, -np.pi), (np.pi, 1.5, np.pi), (50, 3))
    rotations = product(angles, order)
    assert_allclose(euler_angles(rotations, order), angles, atol=1e-10)
    theirs = Rotation.from_matrix(rotations).as_euler(order.upper())
    assert_allclose(euler_angles(rotations, order), theirs, atol=1e-10)


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("off", [0.0, 1e-16, 1e-12, 1e-8, 1e-4])
def test_the_product_is_exact_at_the_singularity(rng, order, off):
    angles = rng.uniform(-np.pi, np.pi, (40, 3))
    angles[:, 1] = np.where(rng.random(40) < 0.5, 1, -1) * (np.pi / 2 - off)
    rotations = product(angles, order)
    assert_allclose(product(euler_angles(rotations, order), order), rotations, atol=EXACT)


@given(seed=st.integers(0, 2**32 - 1), order=st.sampled_from(ORDERS))
@settings(deadline=None, max_examples=30)
def test_continuous_angles_are_the_same_rotations(seed, order):
    rotations = Rotation.random(31, rng=np.random.default_rng(seed)).as_matrix()
    angles = continuous_angles(euler_angles(rotations, order))
    assert_allclose(product(angles, order), rotations, atol=EXACT)


@pytest.mark.parametrize("order", ORDERS)
def test_a_smooth_course_through_the_singularity_comes_back_smooth(order):
    t = np.linspace(0, 1, 400)
    course = np.stack([5 * t, 4.1 * np.sin(5 * t), 0.3 - 7 * t], axis=1)  # middle: far past 90°
    rotations = product(course, order)
    bounded = euler_angles(rotations, order)
    assert np.abs(np.diff(bounded, axis=0)).max() > 3  # the task is not idle
    found = continuous_angles(bounded)
    assert_allclose(np.diff(found, axis=0), np.diff(course, axis=0), atol=1e-9)


def test_nan_stays_nan_and_harms_no_other_frame():
    rotations = np.tile(np.eye(3), (4, 1, 1))
    rotations[2] = np.nan
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        angles = euler_angles(rotations, "zyx")
    assert np.isnan(angles[2]).all()
    assert_allclose(angles[[0, 1, 3]], 0.0)


def test_swing_angles_are_scipys_away_from_the_singularity(rng):
    angles = rng.uniform((-np.pi, -3.0, -np.pi), (np.pi, -0.1, np.pi), (50, 3))
    rotations = Rotation.from_euler("YXY", angles).as_matrix()
    assert_allclose(swing_angles(rotations), angles, atol=1e-10)


@pytest.mark.parametrize("off", [0.0, 1e-16, 1e-12, 1e-8, 1e-4])
@pytest.mark.parametrize("end", [0.0, -np.pi])
def test_swing_angles_rebuild_the_rotation_at_the_singularity(rng, off, end):
    angles = rng.uniform(-np.pi, np.pi, (40, 3))
    angles[:, 1] = end - off if end == 0 else end + off
    rotations = (
        rotation_about(np.eye(3)[1], angles[:, 0])
        @ rotation_about(np.eye(3)[0], angles[:, 1])
        @ rotation_about(np.eye(3)[1], angles[:, 2])
    )
    a, b, c = swing_angles(rotations).T
    rebuilt = (
        rotation_about(np.eye(3)[1], a)
        @ rotation_about(np.eye(3)[0], b)
        @ rotation_about(np.eye(3)[1], c)
    )
    assert_allclose(rebuilt, rotations, atol=EXACT)
    assert (b <= 0).all()
    assert np.isnan(swing_angles(np.full((2, 3, 3), np.nan))).all()
