"""Moments of distances between points that come and go."""

import numpy as np

from kinesphere.kernels.pair_moments import pair_moments


def test_moments_are_those_of_frames_that_show_both(rng):
    points = rng.normal(size=(30, 4, 3))
    points[rng.random((30, 4)) < 0.3] = np.nan
    shift = rng.normal(size=(4, 4))
    shift += shift.T
    count, total, squares = pair_moments(points, shift)
    away = np.linalg.norm(points[:, :, None] - points[:, None], axis=3) - shift
    away[:, np.arange(4), np.arange(4)] = np.nan
    np.testing.assert_array_equal(count, np.isfinite(away).sum(axis=0))
    np.testing.assert_allclose(total, np.nansum(away, axis=0), atol=1e-12)
    np.testing.assert_allclose(squares, np.nansum(away**2, axis=0), atol=1e-12)
