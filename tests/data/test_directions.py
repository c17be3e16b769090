"""The six directions by name."""

import numpy as np
from numpy.testing import assert_array_equal

from kinesphere.data import DIRECTIONS, vector_from_direction


def test_directions_are_the_axes_both_ways():
    vectors = np.array([vector_from_direction(direction) for direction in DIRECTIONS])
    assert_array_equal(vectors[::2], np.eye(3))
    assert_array_equal(vectors[1::2], -np.eye(3))
