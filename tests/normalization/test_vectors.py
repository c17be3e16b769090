"""unit and angle_between, where naive formulas fail."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.normalization.vectors import angle_between, unit

ROUNDING = 1e-15  # rad, at angles down to 1e-8; the arc cosine has 1e-8


@pytest.mark.parametrize("angle", [1e-8, 1e-4, 0.3, np.pi / 2, 3.0, np.pi - 1e-8])
def test_angles_are_exact_near_both_ends_and_need_no_unit_vectors(angle):
    a, b = np.array([[0.0, 2.0, 0.0]]), np.array([[0.0, np.cos(angle), np.sin(angle)]]) * 5
    assert_allclose(angle_between(a, b), [angle], rtol=ROUNDING, atol=ROUNDING)


def test_what_is_not_seen_has_no_angle():
    assert np.isnan(angle_between(np.array([[1.0, np.nan, 0.0]]), np.array([1.0, 0.0, 0.0])))[0]


def test_too_short_a_vector_has_no_direction():
    vectors = np.array([[0.0, -3.0, 4.0], [0.0, 0.0, 0.0], [2e-3, 0.0, 0.0], [1e-3, 0.0, 0.0]])
    found = unit(vectors, shortest=1e-3)
    assert_allclose(found[[0, 2]], [[0.0, -0.6, 0.8], [1.0, 0.0, 0.0]])
    assert np.isnan(found[[1, 3]]).all()
