"""One side of a person held against the other."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from kinesphere.labelling.sides import denied_by_other_side, symmetric_pairs

TWIN = np.array([3, 4, 5, 0, 1, 2])
KIN = np.kron(np.eye(2, dtype=bool), np.ones((3, 3), dtype=bool))
HAND = np.array([[0.0, 0.14, 0.09], [0.14, 0.0, 0.1], [0.09, 0.1, 0.0]])


@pytest.fixture
def hands():
    """Return mean distances of two hands, 1 m from each other, m."""
    mean = np.ones((6, 6))
    mean[:3, :3] = mean[3:, 3:] = HAND
    return mean


def exchanged(mean, one, other):
    order = np.arange(len(mean))
    order[[one, other]] = order[[other, one]]
    return mean[np.ix_(order, order)]


def test_only_distances_within_a_segment_are_told_by_the_other_side(hands):
    told = symmetric_pairs(hands, KIN, TWIN)
    assert_array_equal(told, KIN & ~np.eye(6, dtype=bool))
    hands[0, 1] = hands[1, 0] = 0.3
    assert not symmetric_pairs(hands, KIN, TWIN)[[0, 1, 3, 4], [1, 0, 4, 3]].any()
    hands[0, 2] = hands[2, 0] = np.nan
    assert not symmetric_pairs(hands, KIN, TWIN)[3, 5]


def test_two_markers_of_one_hand_that_are_exchanged_are_denied(hands):
    told = symmetric_pairs(hands, KIN, TWIN)
    assert not denied_by_other_side(hands, told, KIN, TWIN).any()
    # 5 cm between the two distances to the third marker
    denied = denied_by_other_side(exchanged(hands, 1, 2), told, KIN, TWIN)
    assert_array_equal(np.flatnonzero(denied), [1, 2, 4, 5])
    # 1 cm: hands are that unlike
    assert not denied_by_other_side(exchanged(hands, 0, 1), told, KIN, TWIN).any()


def test_of_a_side_that_is_not_seen_nothing_is_denied(hands):
    told = symmetric_pairs(hands, KIN, TWIN)
    mean = exchanged(hands, 1, 2)
    mean[3:] = mean[:, 3:] = np.nan
    assert not denied_by_other_side(mean, told, KIN, TWIN).any()
