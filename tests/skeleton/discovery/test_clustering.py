"""Both ways of clustering, by one suite; and the chains they leave."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from kinesphere.geometry.spectral import renumbered
from kinesphere.skeleton.discovery.chains import split_chains
from kinesphere.skeleton.discovery.clustering import METHODS, merge_curve
from kinesphere.skeleton.discovery.rigidity import measure_rigidity

SIZES = (4, 3, 5, 3)
NEAR = 0.075


@pytest.fixture(params=sorted(METHODS))
def method(request):
    """Return one way of clustering."""
    return METHODS[request.param]


def unlikeness(points):
    return measure_rigidity(points).unlikeness(NEAR)


def test_bodies_and_their_number_come_out(method, rng, moving_bodies):
    points, of = moving_bodies(rng, SIZES, noise=0.001)
    found = method(unlikeness(points), None)
    assert_array_equal(found.labels, of)
    assert found.n_bodies == len(SIZES)
    assert found.count_confidence > 0.3


def test_naming_markers_anew_names_bodies_anew_and_no_more(method, rng, moving_bodies):
    points, of = moving_bodies(rng, SIZES, noise=0.001)
    order = rng.permutation(len(of))
    found = method(unlikeness(points[:, order]), None)
    assert_array_equal(found.labels, renumbered(of[order]))


def test_gaps_leave_the_bodies_alone(method, rng, moving_bodies):
    points, of = moving_bodies(rng, SIZES, noise=0.001)
    points[rng.random(points.shape[:2]) < 0.3] = np.nan
    assert_array_equal(method(unlikeness(points), None).labels, of)


def test_a_number_that_is_given_is_kept(method, rng, moving_bodies):
    points, _ = moving_bodies(rng, SIZES, noise=0.001)
    for count in (1, 3, 6, len(points[0])):
        assert method(unlikeness(points), count).n_bodies == count


def test_markers_in_one_place_are_of_one_body(method, rng, moving_bodies):
    points, of = moving_bodies(rng, SIZES, noise=0.0005)
    points[:, 1] = points[:, 0]
    assert_array_equal(method(unlikeness(points), len(SIZES)).labels, of)


def test_the_merge_curve_rises_where_bodies_that_move_become_one(rng, moving_bodies):
    points, _ = moving_bodies(rng, SIZES, noise=0.001)
    rigidity = measure_rigidity(points)
    curve = merge_curve(rigidity.unlikeness(NEAR), rigidity.wander, 8)
    assert list(curve) == list(range(1, 9))
    assert curve[len(SIZES)] < 2e-3
    assert curve[len(SIZES) - 1] > 5 * curve[len(SIZES)]


def chain(knee_to_ankle, thigh_to_ankle):
    """Wander of thigh, knee, shank and ankle markers, m."""
    wander = np.full((4, 4), thigh_to_ankle)
    wander[0, 1] = wander[1, 0] = 0.001
    for i, j in ((1, 2), (1, 3), (2, 3)):
        wander[i, j] = wander[j, i] = knee_to_ankle
    np.fill_diagonal(wander, 0.0)
    return wander


def test_limbs_in_a_row_are_parted_at_the_marker_they_share():
    split = split_chains(np.zeros(4, dtype=int), chain(0.002, 0.02), noise=0.001, ratio=3.0)
    assert_array_equal(split, [0, 0, 1, 1])


def test_a_body_that_wobbles_stays_one():
    split = split_chains(np.zeros(4, dtype=int), chain(0.008, 0.02), noise=0.001, ratio=3.0)
    assert_array_equal(split, [0, 0, 0, 0])


def test_two_bodies_without_a_marker_between_are_the_clusterings_business():
    wander = np.full((4, 4), 0.02)
    for i, j in ((0, 1), (2, 3)):
        wander[i, j] = wander[j, i] = 0.001
    np.fill_diagonal(wander, 0.0)
    assert len(set(split_chains(np.zeros(4, dtype=int), wander, 0.001, 3.0))) == 1
