"""Rotations as matrices, vectors and quaternions, against SciPy's."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.rotations import (
    carried,
    quaternions_from_rotations,
    rotation_about,
    rotation_exp,
    rotation_log,
    turned,
)

EXACT = 1e-14


@pytest.fixture
def vectors(rng):
    """Return rotation vectors of all sizes, 0 to π, about all kinds of axes, (40, 3) rad."""
    axes = np.concatenate([rng.normal(size=(34, 3)), np.eye(3), -np.eye(3)])
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    angles = np.concatenate([[0.0, 1e-12, 1e-5, 9e-4, 2e-3], rng.uniform(0, np.pi, 35)])
    return axes * rng.permutation(angles)[:, None]


def test_quaternions_are_those_of_scipy_up_to_sign(vectors):
    turns = Rotation.from_rotvec(vectors)
    found, wanted = quaternions_from_rotations(turns.as_matrix()), turns.as_quat()
    signs = np.sign((found * wanted).sum(axis=1, keepdims=True))
    assert_allclose(found * signs, wanted, atol=EXACT)


def test_logarithm_and_exponential_undo_each_other(vectors):
    turns = rotation_exp(vectors)
    assert_allclose(turns, Rotation.from_rotvec(vectors).as_matrix(), atol=EXACT)
    assert_allclose(rotation_log(turns), vectors, atol=1e-13)


def test_half_turns_have_a_logarithm(rng):
    half = Rotation.from_rotvec(np.pi * np.eye(3)).as_matrix()
    assert_allclose(np.abs(rotation_log(half)), np.pi * np.eye(3), atol=EXACT)


def test_gaps_and_shapes_are_kept(vectors):
    turns = rotation_exp(vectors).reshape(8, 5, 3, 3)
    turns[3, 2] = np.nan
    logs, quaternions = rotation_log(turns), quaternions_from_rotations(turns)
    assert logs.shape == (8, 5, 3)
    assert quaternions.shape == (8, 5, 4)
    for found in (logs, quaternions):
        missing = np.isnan(found)
        assert missing[3, 2].all()
        assert missing.sum() == missing[3, 2].sum()
    assert rotation_log(np.eye(3)).tolist() == [0.0, 0.0, 0.0]


def test_about_an_axis(rng):
    axis = np.array([0.6, 0.0, -0.8])
    angles = rng.uniform(-4, 4, size=(3, 7))
    angles[1, 4] = np.nan
    found = rotation_about(axis, angles)
    assert np.isnan(found[1, 4]).all()
    known = np.isfinite(angles)
    wanted = Rotation.from_rotvec(angles[known][:, None] * axis).as_matrix()
    assert_allclose(found[known], wanted, atol=EXACT)
    assert rotation_about(axis, np.float64(0.3)).shape == (3, 3)


def test_turned_and_carried_are_what_products_give(rng, vectors):
    rotations = rotation_exp(vectors)
    axis = np.array([0.6, 0.0, -0.8])
    angles = rng.uniform(-4, 4, size=len(rotations))
    angles[3] = np.nan
    rotations[5] = np.nan
    given = rotations.copy()
    assert_allclose(
        turned(rotations, axis, angles), rotation_about(axis, angles) @ rotations, atol=EXACT
    )
    fixed = np.broadcast_to(rotations[0], rotations.shape)
    assert_allclose(turned(fixed, axis, angles), rotation_about(axis, angles) @ fixed, atol=EXACT)
    vector = rng.normal(size=3)
    assert_allclose(carried(rotations, vector), rotations @ vector, atol=EXACT)
    strided = np.stack([fixed, rotations], axis=1)[:, 1]
    assert_allclose(carried(strided, vector), rotations @ vector, atol=EXACT)
    assert_allclose(rotations, given, rtol=0)
