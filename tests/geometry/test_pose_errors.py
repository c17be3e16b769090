"""How far a rigid fit's pose may be off, by the points that each frame shows."""

import numpy as np
import pytest

from kinesphere.geometry.pose_errors import (
    mean_pose_covariance,
    point_covariance,
    pose_covariance,
    usual_pose_covariance,
)
from kinesphere.geometry.rigid import fit_rigid, into_frame

NOISE = 1e-3
FAR = np.array([0.3, 0.0, 0.0])


@pytest.fixture
def shape():
    """Return three points nearly on a line and one off it: without that one the line turns."""
    return np.array([[-0.05, 0, 0], [0.0, 0, 0.004], [0.05, 0, 0], [0.0, 0.06, 0.01]])


def test_all_points_in_all_frames_are_one_fit(shape):
    noise = np.full(4, NOISE)
    seen = np.ones((9, 4), dtype=bool)
    whole = pose_covariance(shape, noise)
    np.testing.assert_array_equal(mean_pose_covariance(shape, noise, seen), whole)
    none = np.zeros((9, 4), dtype=bool)
    np.testing.assert_array_equal(mean_pose_covariance(shape, noise, none), whole)


def test_frames_count_by_the_points_they_show(shape):
    noise = np.full(4, NOISE)
    seen = np.ones((4, 4), dtype=bool)
    seen[0, 3] = False
    seen[1, 1:] = False  # no pose
    expected = (pose_covariance(shape[:3], noise[:3]) + 2 * pose_covariance(shape, noise)) / 3
    np.testing.assert_allclose(mean_pose_covariance(shape, noise, seen), expected, rtol=1e-9)


def test_usual_poses_are_those_that_tell_most(shape):
    noise = np.full(4, NOISE)
    seen = np.ones((8, 4), dtype=bool)
    whole, three = pose_covariance(shape, noise), pose_covariance(shape[:3], noise[:3])
    np.testing.assert_allclose(usual_pose_covariance(shape, noise, seen), whole, rtol=1e-9)
    seen[0, 3] = False  # the others are nearly on a line
    usual = usual_pose_covariance(shape, noise, seen)
    told = (np.linalg.inv(three) + 7 * np.linalg.inv(whole)) / 8
    np.testing.assert_allclose(usual @ told, np.eye(6), atol=1e-6)
    mean = mean_pose_covariance(shape, noise, seen)
    assert np.trace(whole[:3, :3]) < np.trace(usual[:3, :3]) < 0.2 * np.trace(mean[:3, :3])


def test_what_is_told_is_what_fits_to_some_of_the_points_err_by(shape, rng):
    """Carried to a point far off, as to a joint: the rms over fits with three of four points."""
    n = 4000
    seen = rng.random((n, 4)) < 0.75
    seen = seen[seen[:, 3] & (seen.sum(axis=1) >= 3)]
    points = shape + rng.normal(scale=NOISE, size=(len(seen), 4, 3))
    points[~seen] = np.nan
    fit = fit_rigid(shape, points)
    off = into_frame(fit.rotations, fit.shifts, np.broadcast_to(FAR, (len(seen), 1, 3)))[:, 0] - FAR
    told = point_covariance(mean_pose_covariance(shape, np.full(4, NOISE), seen), FAR)
    assert np.sqrt(np.trace(told)) == pytest.approx(
        np.sqrt(np.nanmean((off**2).sum(axis=1))), rel=0.05
    )
    as_if_all = point_covariance(pose_covariance(shape, np.full(4, NOISE)), FAR)
    assert np.trace(told) > 1.2 * np.trace(as_if_all)
