"""Shapes from frames with gaps and swaps; what a pose's uncertainty does to points."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.pose_errors import point_covariance, pose_covariance
from kinesphere.geometry.rigid import (
    fit_rigid,
    fit_shape,
    into_frame,
    left_by_fit,
    line_spread,
    out_of_frame,
)

FRAMES, POINTS = 80, 5
EXACT = 1e-9  # m
NOISE = 1e-3  # m


def moving(rng, shape, frames=FRAMES):
    rotations = Rotation.random(frames, rng=rng).as_matrix()
    shifts = rng.normal(size=(frames, 3))
    return out_of_frame(rotations, shifts, shape), rotations, shifts


def distances(shape):
    return np.linalg.norm(shape[:, None] - shape, axis=2)


@given(seed=st.integers(0, 2**32 - 1))
@settings(deadline=None, max_examples=10)
def test_shape_is_found_through_gaps_in_any_place_and_order(seed):
    rng = np.random.default_rng(seed)
    shape = rng.normal(scale=0.1, size=(POINTS, 3))
    points, _, _ = moving(rng, shape)
    points[rng.random((FRAMES, POINTS)) < 0.25] = np.nan
    found = fit_shape(points, min_spread=1e-4)
    assert_allclose(distances(found), distances(shape), atol=EXACT)
    order = rng.permutation(POINTS)
    assert_allclose(fit_shape(points[:, order], min_spread=1e-4), found[order], atol=1e-6)
    assert_allclose(
        distances(fit_shape(points[::-1], min_spread=1e-4)), distances(shape), atol=EXACT
    )


def test_markers_never_seen_all_at_once_still_make_one_shape(rng):
    shape = rng.normal(scale=0.1, size=(POINTS, 3))
    points, _, _ = moving(rng, shape)
    points[: FRAMES // 2, 0] = np.nan
    points[FRAMES // 2 :, 1] = np.nan
    assert_allclose(distances(fit_shape(points)), distances(shape), atol=EXACT)


def test_swapped_markers_do_not_bend_the_shape(rng):
    shape = rng.normal(scale=0.1, size=(POINTS, 3))
    points, _, _ = moving(rng, shape)
    swapped = np.arange(0, FRAMES, 10)
    points[swapped[:, None], [0, 1]] = points[swapped[:, None], [1, 0]]
    assert_allclose(distances(fit_shape(points)), distances(shape), atol=NOISE)


def test_a_line_has_no_shape(rng):
    points, _, _ = moving(rng, np.outer(np.arange(4), [0.1, 0.0, 0.0]))
    assert fit_shape(points) is None
    assert line_spread(points[0]) < EXACT


def test_into_frame_undoes_out_of_frame(rng):
    shape = rng.normal(size=(POINTS, 3))
    points, rotations, shifts = moving(rng, shape)
    assert_allclose(
        into_frame(rotations, shifts, points), np.tile(shape, (FRAMES, 1, 1)), atol=EXACT
    )


def test_pose_covariance_is_what_noise_does_to_carried_points(rng):
    shape = np.array([[0.0, 0, 0], [0.3, 0, 0], [0.1, 0.04, 0], [0.2, 0.0, 0.02]])
    noise = np.array([1.0, 2.0, 1.5, 1.0]) * NOISE
    n = 4000
    points = shape + rng.normal(size=(n, 4, 3)) * noise[:, None]
    fit = fit_rigid(shape, points, 1 / noise**2, min_spread=1e-4)
    far = np.array([0.15, 0.1, -0.2])
    carried = out_of_frame(fit.rotations, fit.shifts, far[None])[:, 0]
    predicted = point_covariance(pose_covariance(shape, noise), far)
    # a covariance of 4000 samples is known to about 3 %; ten sigma leave room for linearising
    assert_allclose(np.cov(carried.T), predicted, atol=0.15 * np.trace(predicted))


def test_noise_is_known_from_what_fits_leave_however_many_points_hide(rng):
    shape = rng.normal(scale=0.08, size=(POINTS, 3))
    points = moving(rng, shape, 2000)[0] + NOISE * rng.normal(size=(2000, POINTS, 3))
    for hidden in (0.0, 0.45):
        some = np.where(rng.random(points.shape[:2])[..., None] < hidden, np.nan, points)
        fit = fit_rigid(shape, some)
        left = (into_frame(fit.rotations, fit.shifts, some) - shape)[fit.fitted]
        found = np.sqrt(np.nanmean(left**2)) * left_by_fit(np.isfinite(left[..., 0]))
        assert_allclose(found, NOISE, rtol=0.05)
