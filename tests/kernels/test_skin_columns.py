"""Derivatives by skin that goes with a joint, against products of whole arrays."""

import numpy as np
from numpy.testing import assert_array_equal

from kinesphere.kernels.skin_columns import skin_columns_kernel


def test_columns_are_products_with_each_mode(rng):
    n, k = 11, 2
    seeing, own, modes = (
        rng.normal(size=(n, 3, 6)),
        rng.normal(size=(3, 6)),
        rng.normal(size=(n, k)),
    )
    columns = np.full((n, 3, 3 + 12 * k), 7.0)
    skin_columns_kernel(seeing, own, modes, columns[:, :, 3:])
    by_seeing = seeing[:, :, None] * modes[:, None, :, None]
    by_own = own[None, :, None] * modes[:, None, :, None]
    middle = 3 + 6 * k
    assert_array_equal(columns[:, :, 3:middle], by_seeing.reshape(n, 3, -1))
    assert_array_equal(columns[:, :, middle:], by_own.reshape(n, 3, -1))
    assert (columns[:, :, :3] == 7.0).all()
