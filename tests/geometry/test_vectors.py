"""Seen points, lengths and medians of columns, against NumPy's own."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.geometry.medians import column_medians
from kinesphere.geometry.vectors import is_seen, lengths

EXACT = 1e-14


@pytest.fixture
def points(rng):
    points = rng.normal(size=(7, 5, 3))
    points[2, 1, 0] = points[4, 3, 2] = np.nan
    points[5, 4] = np.nan
    return points


def test_one_missing_coordinate_is_not_seen(points):
    assert_array_equal(is_seen(points), np.isfinite(points).all(axis=-1))
    assert_array_equal(is_seen(points[0, 0]), True)
    assert_array_equal(is_seen(points[:, ::2]), np.isfinite(points[:, ::2]).all(axis=-1))


def test_lengths(points):
    assert_allclose(lengths(points), np.linalg.norm(points, axis=-1), rtol=EXACT)
    assert lengths(np.array([3.0, 0.0, -4.0])) == 5.0


@pytest.mark.parametrize("n", [1, 2, 7, 8])
def test_medians_of_columns(rng, n):
    values = rng.normal(size=(n, 5))
    assert_array_equal(column_medians(values), np.median(values, axis=0))
    seen = rng.random((n, 5)) < 0.7
    seen[:, 2] = False
    wanted = [np.median(v[s]) if s.any() else np.nan for v, s in zip(values.T, seen.T, strict=True)]
    assert_array_equal(column_medians(values, seen), wanted)


def test_medians_of_nothing():
    assert np.isnan(column_medians(np.empty((0, 4)))).all()
    assert column_medians(np.empty((3, 0))).shape == (0,)
