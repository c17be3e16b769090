"""The low-pass of quaternions against SciPy's, and signs that follow each other."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.signal import butter, sosfilt_zi, sosfiltfilt

from kinesphere.kernels.low_pass import align_signs_kernel, both_ways_kernel

ROUNDING = 1e-13


@pytest.mark.parametrize(("n", "padding"), [(300, 12), (5, 4), (13, 12), (4, 0)])
def test_both_ways_is_what_scipy_makes_of_it(rng, n, padding):
    values = rng.normal(size=(n, 4)).cumsum(axis=0)
    sos = butter(2, 0.2, output="sos")
    given = values.copy()
    found = both_ways_kernel(sos[0], sosfilt_zi(sos)[0], values, padding)
    assert_allclose(found, sosfiltfilt(sos, values, axis=0, padlen=padding), atol=ROUNDING)
    assert_array_equal(values, given)


def test_signs_follow_each_other(rng):
    smooth = np.array([1.0, 0.0, 0.0, 0.0]) + 0.01 * rng.normal(size=(50, 4)).cumsum(axis=0)
    signs = rng.choice([-1.0, 1.0], size=(50, 1))
    mixed = signs * smooth
    align_signs_kernel(mixed)
    assert_array_equal(mixed, signs[0] * smooth)
    nothing = np.empty((0, 4))
    align_signs_kernel(nothing)
