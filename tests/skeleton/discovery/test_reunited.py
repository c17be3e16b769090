"""Limbs all of whose markers are lost for a while, and what is left over of trajectories."""

from dataclasses import replace

import numpy as np
import pytest
from tests.skeleton.discovery.test_followed import in_lives

from kinesphere.skeleton import discover
from kinesphere.skeleton.discovery.congruent import alike, find_congruent
from kinesphere.skeleton.discovery.leftover import Leftover, left_over, settle
from kinesphere.skeleton.discovery.places import measure_places, riding, same_places
from kinesphere.skeleton.discovery.reunited import reunite
from kinesphere.skeleton.settings import SkeletonSettings
from kinesphere.synthetic import make_performance, spoil_with_noise

LIMITS = SkeletonSettings()


def lost_for_a_while(markers, columns, start, end):
    """Return the markers with each of some columns in two: before it is lost, and after."""
    first, second = markers.copy(), markers[:, columns].copy()
    first[start:, columns] = np.nan
    second[:end] = np.nan
    return np.concatenate([first, second], axis=1)


@pytest.fixture
def two_bodies(rng, moving_bodies):
    return moving_bodies(rng, (5, 4), n_frames=600, noise=5e-4)[0]


def test_a_body_lost_as_a_whole_is_found_again(two_bodies):
    pieces = lost_for_a_while(two_bodies, [5, 6, 7, 8], 250, 320)
    tracks = reunite([[m] for m in range(13)], pieces, 50.0, LIMITS)
    assert sorted(map(sorted, tracks)) == [
        [0],
        [1],
        [2],
        [3],
        [4],
        [5, 9],
        [6, 10],
        [7, 11],
        [8, 12],
    ]


def test_mirrored_it_is_another_body(two_bodies):
    pieces = lost_for_a_while(two_bodies, [5, 6, 7, 8], 250, 320)
    pieces[:, 9:, 0] *= -1
    assert len(reunite([[m] for m in range(13)], pieces, 50.0, LIMITS)) == 13


def test_another_body_in_its_stead_is_not_taken_for_it(rng, moving_bodies):
    markers = moving_bodies(rng, (5, 4, 4), n_frames=600, noise=5e-4)[0]
    markers[250:, 5:9] = np.nan
    markers[:320, 9:] = np.nan
    assert len(reunite([[m] for m in range(13)], markers, 50.0, LIMITS)) == 13


def test_of_two_that_are_seen_at_once_neither_is_meant(two_bodies):
    """Two bodies of one make, both lost and both found: which is which cannot be told."""
    twin = two_bodies[:, 5:] @ np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]) + 0.7
    both = np.concatenate([two_bodies, twin], axis=1)
    pieces = lost_for_a_while(both, [5, 6, 7, 8, 9, 10, 11, 12], 250, 320)
    assert len(reunite([[m] for m in range(21)], pieces, 50.0, LIMITS)) == 21


def test_the_same_distances_are_found_in_any_order(rng):
    points = rng.normal(size=(5, 3))
    order = np.array([3, 0, 4, 1])
    a, b = (np.linalg.norm(x[:, None] - x, axis=2) for x in (points, points[order]))
    (way,) = alike(a, b, 1e-9)
    assert {(int(order[j]), j) for _, j in way} == set(way)
    assert len(way) == 4


def test_an_even_triangle_is_alike_in_six_ways():
    triangle = np.ones((3, 3)) - np.eye(3)
    assert len(alike(triangle, triangle, 1e-9)) == 6
    assert alike(triangle, 2 * triangle, 1e-9) == []


def test_a_piece_rides_where_it_is_rigid_and_nowhere_else(two_bodies):
    places = measure_places(two_bodies, [np.arange(4), np.arange(5, 9)], LIMITS)
    np.testing.assert_array_equal(riding(places), [0] * 5 + [1] * 4)
    alone = measure_places(two_bodies, [np.arange(4)], LIMITS)
    np.testing.assert_array_equal(riding(alone), [0] * 5 + [-1] * 4)
    none = measure_places(two_bodies, [np.arange(2)], LIMITS)
    np.testing.assert_array_equal(riding(none), [-1] * 9)


def test_pieces_at_one_place_are_one_marker_unless_seen_at_once(two_bodies):
    pieces = lost_for_a_while(two_bodies, [4], 250, 320)
    for overlap, groups in ((False, [[4, 9]]), (True, [])):
        if overlap:
            pieces[200:, 9] = two_bodies[200:, 4]
        seen = np.isfinite(pieces).all(axis=2)
        places = measure_places(pieces, [np.arange(4)], LIMITS)
        found = same_places(places, riding(places), seen)
        assert [sorted(group) for group in found] == groups


def test_nothing_is_congruent_where_no_body_has_a_pose(two_bodies):
    places = measure_places(two_bodies, [np.arange(2)], LIMITS)
    assert find_congruent(places, [np.arange(2)], np.ones((600, 9), dtype=bool)) == []


def test_what_is_seen_too_little_beside_others_is_left_over():
    seen = np.zeros((100, 6), dtype=bool)
    seen[:, :3], seen[:50, 3], seen[:30, 4], seen[95:, 5] = True, True, True, True
    np.testing.assert_array_equal(left_over(seen), [False, False, False, False, True, True])


@pytest.mark.parametrize(("shown", "trust"), [(1.0, 1.0), (0.9, 1.0), (0.7, 0.5), (0.4, 0.0)])
def test_names_are_trusted_by_what_bodies_show(shown, trust):
    assert Leftover({}, (), shown).trust == pytest.approx(trust)


@pytest.fixture(scope="module")
def person():
    performance = make_performance(np.random.default_rng(43), n_frames=4800)
    return spoil_with_noise(performance.recording, np.random.default_rng(44), deviation=1e-3)


def test_the_rest_is_given_to_what_it_rides_on(person):
    """Columns are shuffled, so a limb's own must not be taken from their order."""
    of = np.array([label.rstrip("0123456789") for label in person.labels])
    limb, other = (np.flatnonzero(of == name) for name in ("left_thigh", "right_thigh"))
    stranger = np.flatnonzero(of == "left_forearm")[0]
    columns = np.concatenate([other, limb[1:]])
    bodies = [np.arange(len(other)), len(other) + np.arange(len(limb) - 1)]
    others = np.setdiff1d(np.arange(person.n_markers), [*columns, limb[0], stranger])
    found = settle(person, columns, others.tolist(), bodies, 1.0, LIMITS)
    assert found.rides == {int(limb[0]): 1}
    assert found.astray == (int(stranger),)
    n = len(columns) + 2
    assert found.shown == pytest.approx((n - 1) / n)


@pytest.mark.slow
@pytest.mark.parametrize(("gap", "seed"), [((0.1, 1.5), 3), ((1.0, 4.0), 4)])
def test_a_person_all_in_pieces_has_its_limbs_and_names(person, gap, seed):
    """With nothing but distances beside breaks there were 23 to 72 bodies, and no names."""
    pieces, of = in_lives(person.markers, np.random.default_rng(seed), gap)
    labels = tuple(f"*{m}" for m in range(len(of)))
    found = discover(replace(person, markers=pieces, labels=labels, residuals=None))
    truth = {
        label: person.labels[m].rstrip("0123456789") for label, m in zip(labels, of, strict=True)
    }
    assert {segment.name for segment in found.model.segments} == set(truth.values())
    assert all({truth[m] for m in s.markers} == {s.name} for s in found.model.segments)
    placed = sum(len(segment.markers) for segment in found.model.segments)
    assert placed >= 0.9 * len(of)
