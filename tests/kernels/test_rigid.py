"""The rigid fit against SciPy, and where shapes are flat, nearly flat or a line."""

from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.rigid import fit_rigid_batched
from kinesphere.kernels.rigid import COLLINEAR, FITTED, TOO_FEW, fit_rigid_kernel

FRAMES, POINTS = 7, 5
EXACT = 1e-12  # rounding on coordinates of about a metre
SCIPY = 1e-7  # align_vectors and we round differently where a set is nearly planar


@pytest.fixture(params=[fit_rigid_kernel, fit_rigid_batched], ids=["kernel", "batched"])
def fit(request):
    """Return either way of fitting: they must not be told apart."""
    return partial(fit_with, request.param)


def fit_with(way, shape, points, weights=None, min_spread=1e-4):
    weights = np.ones(points.shape[:2]) if weights is None else weights
    rotations = np.full((len(points), 3, 3), np.nan)
    shifts = np.full((len(points), 3), np.nan)
    status = np.zeros(len(points), dtype=np.uint8)
    way(shape, points, weights, min_spread, rotations, shifts, status)
    return rotations, shifts, status


def placed(rng, shape, noise=0.0):
    rotations = Rotation.random(FRAMES, rng=rng).as_matrix()
    shifts = rng.normal(size=(FRAMES, 3))
    points = shape @ np.swapaxes(rotations, 1, 2) + shifts[:, None]
    return (
        points + rng.normal(scale=noise, size=points.shape) if noise else points,
        rotations,
        shifts,
    )


@pytest.mark.parametrize("flatness", [1.0, 1e-3, 0.0])
def test_exact_data_give_the_pose_back_however_flat_the_shape(fit, rng, flatness):
    shape = rng.normal(scale=0.1, size=(POINTS, 3)) * [1, 1, flatness]
    points, rotations, shifts = placed(rng, shape)
    found_r, found_t, status = fit(shape, points)
    assert (status == FITTED).all()
    assert_allclose(found_r, rotations, atol=EXACT)
    assert_allclose(found_t, shifts, atol=EXACT)


@pytest.mark.parametrize("flatness", [1.0, 1e-2])
def test_noisy_weighted_fits_agree_with_scipy(fit, rng, flatness):
    shape = rng.normal(scale=0.1, size=(POINTS, 3)) * [1, 1, flatness]
    points, _, _ = placed(rng, shape, noise=0.01)
    weights = rng.uniform(0.2, 2.0, size=(FRAMES, POINTS))
    found, shifts, _ = fit(shape, points, weights)
    for f in range(FRAMES):
        a = np.average(shape, axis=0, weights=weights[f])
        b = np.average(points[f], axis=0, weights=weights[f])
        expected, _ = Rotation.align_vectors(points[f] - b, shape - a, weights=weights[f])
        assert_allclose(found[f], expected.as_matrix(), atol=SCIPY)
        assert_allclose(shifts[f], b - expected.as_matrix() @ a, atol=SCIPY)


def test_a_mirrored_shape_is_met_by_a_rotation_never_a_reflection(fit, rng):
    shape = rng.normal(scale=0.1, size=(POINTS, 3))
    found, _, _ = fit(shape, np.ascontiguousarray(np.tile(shape * [1, 1, -1], (FRAMES, 1, 1))))
    assert_allclose(np.linalg.det(found), 1.0, atol=EXACT)


def test_a_point_of_no_weight_may_be_nan(fit, rng):
    shape = rng.normal(scale=0.1, size=(POINTS, 3))
    points, rotations, _ = placed(rng, shape)
    weights = np.ones((FRAMES, POINTS))
    weights[2, 1] = 0.0
    points[2, 1] = np.nan
    found, _, status = fit(shape, points, weights)
    assert (status == FITTED).all()
    assert_allclose(found, rotations, atol=EXACT)


def test_two_points_and_points_on_a_line_have_no_fit_and_leave_others_alone(fit, rng):
    shape = np.outer(np.linspace(-1, 1, POINTS), [0.1, 0.2, -0.1])
    shape[0, 0] += 0.05  # without this point the rest lie on a line
    points, rotations, _ = placed(rng, shape)
    weights = np.ones((FRAMES, POINTS))
    weights[1, 0] = 0.0
    weights[3, 2:] = 0.0
    found, shifts, status = fit(shape, points, weights)
    assert status[1] == COLLINEAR
    assert status[3] == TOO_FEW
    assert np.isnan(found[[1, 3]]).all()
    assert np.isnan(shifts[[1, 3]]).all()
    others = [0, 2, 4, 5, 6]
    assert_allclose(found[others], rotations[others], atol=1e-9)
