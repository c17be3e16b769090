"""The low-pass of quaternions against SciPy's."""

import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.signal import butter, sosfilt_zi, sosfiltfilt

from kinesphere.kernels.low_pass import both_ways_kernel

ROUNDING = 1e-13


@pytest.mark.parametrize(("n", "padding"), [(300, 12), (5, 4), (13, 12), (4, 0)])
def test_both_ways_is_what_scipy_makes_of_it(rng, n, padding):
    values = rng.normal(size=(n, 4)).cumsum(axis=0)
    sos = butter(2, 0.2, output="sos")
    given = values.copy()
    found = both_ways_kernel(sos[0], sosfilt_zi(sos)[0], values, padding)
    assert_allclose(found, sosfiltfilt(sos, values, axis=0, padlen=padding), atol=ROUNDING)
    assert_array_equal(values, given)
