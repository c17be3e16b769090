"""Principal axes of every frame, against LAPACK's."""

import numpy as np
from numpy.testing import assert_allclose

from kinesphere.kernels.eigenvectors import LANES
from kinesphere.kernels.principal_axes import principal_axes_kernel


def found_of(covariances):
    axes, variances = np.empty_like(covariances), np.empty(covariances.shape[:2])
    principal_axes_kernel(covariances, axes, variances)
    return axes, variances


def test_axes_and_variances_are_those_of_lapack(rng):
    points = rng.normal(size=(LANES + 7, 6, 3)) * rng.permuted([1.0, 0.3, 0.05])
    covariances = np.swapaxes(points, 1, 2) @ points / 6
    axes, variances = found_of(covariances)
    values, vectors = np.linalg.eigh(covariances)
    assert_allclose(variances, values[:, ::-1], atol=1e-14)
    alike = np.abs(np.einsum("fik,fik->fk", axes, vectors[:, :, ::-1]))
    assert_allclose(alike, 1.0, atol=1e-12)


def test_variances_fall_whatever_the_order_of_the_axes():
    orders = [(0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0)]
    covariances = np.array([np.diag(np.array([4.0, 2.0, 1.0])[list(order)]) for order in orders])
    axes, variances = found_of(covariances)
    assert_allclose(variances, np.tile([4.0, 2.0, 1.0], (6, 1)))
    for order, each in zip(orders, axes, strict=True):
        assert_allclose(np.abs(each), np.eye(3)[:, np.argsort(order)])


def test_a_plane_has_no_variance_across(rng):
    points = rng.normal(size=(1, 8, 3)) * [1.0, 1.0, 0.0]
    axes, variances = found_of(np.swapaxes(points, 1, 2) @ points / 8)
    assert 0 <= variances[0, 2] < 1e-16
    assert_allclose(np.abs(axes[0, :, 2]), [0, 0, 1], atol=1e-15)


def test_points_in_one_place_have_any_orthogonal_axes():
    axes, variances = found_of(np.zeros((2, 3, 3)))
    assert_allclose(variances, 0.0)
    assert_allclose(np.swapaxes(axes, 1, 2) @ axes, np.tile(np.eye(3), (2, 1, 1)))
