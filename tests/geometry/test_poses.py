"""Poses of one limb in many frames, against products of stacks."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from kinesphere.geometry.poses import misfits, place, relative_rotations
from kinesphere.geometry.rigid import fit_rigid, out_of_frame
from kinesphere.geometry.rotations import rotation_about, turned, turned_from

FRAMES, LIMBS, POINTS = 70, 5, 4
EXACT = 1e-14
"""m or a rotation's entries of about 1: rounding alone."""


@pytest.fixture
def motion(rng):
    """Return poses of all limbs as a motion holds them; limb 1 is unseen in frame 7."""
    rotations = Rotation.random(FRAMES * LIMBS, rng=rng).as_matrix()
    rotations = rotations.reshape(FRAMES, LIMBS, 3, 3)
    origins = rng.normal(size=(FRAMES, LIMBS, 3))
    rotations[7, 1] = origins[7, 1] = np.nan
    return rotations, origins


def test_a_point_is_placed_as_many_are(motion, rng):
    (rotations, origins), point = motion, rng.normal(size=3)
    rotations, origins = rotations[:, 1], origins[:, 1]
    there = out_of_frame(rotations, origins, point[None])[:, 0]
    assert_allclose(place(rotations, origins, point), there, atol=EXACT)
    assert np.isnan(place(rotations, origins, point)[7]).all()


def test_a_child_is_seen_from_its_parent(motion):
    rotations, _ = motion
    parents, children = rotations[:, 1], rotations[:, 4]
    relative = relative_rotations(parents, children)
    assert_allclose(relative, np.swapaxes(parents, 1, 2) @ children, atol=EXACT)
    assert_array_equal(np.isnan(relative).all(axis=(1, 2)), np.arange(FRAMES) == 7)


def test_one_parent_of_each_limb_serves_all_frames(motion):
    rotations, _ = motion
    means = rotations[3]
    for here in (rotations, rotations[:, ::2]):
        mean = means[: here.shape[1]]
        expected = np.swapaxes(mean, -1, -2) @ here
        assert_allclose(relative_rotations(mean, here), expected, atol=EXACT)


def test_misfits_are_the_rms_of_what_is_seen(motion, rng):
    (rotations, origins), shape = motion, rng.normal(size=(POINTS, 3))
    rotations, origins = rotations[:, 1], origins[:, 1]
    shape[2] = np.nan
    points = out_of_frame(rotations, origins, shape) + rng.normal(size=(FRAMES, POINTS, 3))
    points[rng.random((FRAMES, POINTS)) < 0.3, 1] = np.nan
    points[11] = np.nan
    found = misfits(rotations, origins, shape, points)
    for f in range(FRAMES):
        off = [points[f, p] - rotations[f] @ shape[p] - origins[f] for p in range(POINTS)]
        squares = [float(o @ o) for o in off if np.isfinite(o).all()]
        expected = np.sqrt(np.mean(squares)) if squares else np.nan
        assert_allclose(found[f], expected, atol=10 * EXACT)
    assert np.isnan(found[[7, 11]]).all()


def test_one_rotation_turned_is_a_stack_of_it_turned(rng):
    axis = np.array([0.6, 0.0, 0.8])
    rotation, angles = Rotation.random(rng=rng).as_matrix(), rng.uniform(-4, 4, FRAMES)
    angles[5] = np.nan
    found = turned_from(rotation, axis, angles)
    stack = np.broadcast_to(rotation, (FRAMES, 3, 3))
    assert_allclose(found, rotation_about(axis, angles) @ stack, atol=EXACT)
    assert_allclose(found, turned(stack, axis, angles), atol=EXACT)


def test_a_fit_writes_where_it_is_told(motion, rng):
    shape = rng.normal(size=(POINTS, 3))
    points = out_of_frame(motion[0][:, 2], motion[1][:, 2], shape)
    points[9, :2] = np.nan
    rotations, shifts = np.full((FRAMES, LIMBS, 3, 3), 5.0), np.full((FRAMES, LIMBS, 3), 5.0)
    fit = fit_rigid(shape, points, into=(rotations[:, 2], shifts[:, 2]))
    alone = fit_rigid(shape, points)
    fitted = np.arange(FRAMES) != 9
    assert_array_equal(fit.fitted, fitted)
    assert_array_equal(rotations[fitted, 2], alone.rotations[fitted])
    assert_array_equal(shifts[fitted, 2], alone.shifts[fitted])
    assert (rotations[9] == 5.0).all()
    assert (rotations[:, [0, 1, 3, 4]] == 5.0).all()
