"""The person a model was learnt from: known by their distances, standing or moving."""

from dataclasses import replace

import numba
import numpy as np
import pytest
from numpy.testing import assert_array_equal
from tests.labelling.conftest import actor

from kinesphere.geometry.signature import signature
from kinesphere.labelling.blocks import twins
from kinesphere.labelling.held import held_to_distances
from kinesphere.labelling.pair_statistics import match_pair_statistics
from kinesphere.labelling.problem import problem_of
from kinesphere.labelling.same_person import (
    is_mirrored,
    is_the_person,
    rigid_pairs,
    template_of_person,
)
from kinesphere.labelling.seating import places_of
from kinesphere.labelling.template import of_one_segment, template_of
from kinesphere.skeleton.statistics import marker_statistics

slow_in_python = pytest.mark.skipif(
    bool(numba.config.DISABLE_JIT), reason="a search in plain Python takes minutes"
)
NOISE = 0.0003  # m


def standing(recording, rng, n=60):
    """Return a standing trial: one frame, again and again, with a little noise."""
    markers = np.repeat(recording.markers[:1], n, axis=0)
    return replace(recording, markers=markers + rng.normal(scale=NOISE, size=markers.shape))


@pytest.fixture
def static_model(legs):
    """Return the layout with the statistics of a standing trial of the person under test."""
    model, recording = legs
    trial = standing(recording, np.random.default_rng(5))
    learnt = marker_statistics(trial, model.labels, "standing")
    return replace(model, name="static", statistics=(learnt,))


def labels_of(recording, model, rng, keep=slice(None)):
    """Return labels given and true ones, of shuffled points."""
    order = rng.permutation(recording.n_markers)[keep]
    match = match_pair_statistics(recording.markers[:, order], model)
    return np.where(match.confidence >= 0.1, match.labels, -1), order, match


@slow_in_python
class TestStandingTrial:
    def test_it_labels_the_movements_of_its_person(self, legs, static_model, rng):
        given, truth, _ = labels_of(legs[1], static_model, rng)
        assert_array_equal(given, truth)

    def test_markers_that_are_missing_make_no_label_wrong(self, legs, static_model, rng):
        given, truth, _ = labels_of(legs[1], static_model, rng, slice(2, None))
        assert ((given == truth) | (given < 0)).all()
        assert (given == truth).mean() > 0.8

    def test_it_refuses_another_person(self, static_model, rng):
        other = actor(11, static_model.labels)
        given, _, match = labels_of(other, static_model, rng)
        assert (given < 0).all()
        assert "standing still" in match.note

    def test_it_refuses_its_person_in_a_mirror(self, legs, static_model, rng):
        recording = legs[1]
        mirrored = replace(recording, markers=recording.markers * np.array([1.0, 1.0, -1.0]))
        given, _, match = labels_of(mirrored, static_model, rng)
        assert (given < 0).all()
        assert "left and right are mirrored" in match.note

    def test_it_is_labelled_by_a_movement_of_its_person(self, legs, rng):
        model, recording = legs
        learnt = marker_statistics(recording, model.labels, "moving")
        model = replace(model, statistics=(learnt,))
        given, truth, _ = labels_of(standing(recording, rng), model, rng)
        assert_array_equal(given, truth)


class TestRigidPairs:
    def test_they_are_of_one_segment(self, static_model):
        rigid = rigid_pairs(static_model, static_model.labels, static_model.statistics)
        together = of_one_segment(static_model, static_model.labels)
        assert rigid.any()
        assert not (rigid & ~together).any()
        assert not rigid.diagonal().any()

    def test_people_of_two_sizes_have_none(self, static_model):
        one = static_model.statistics[0]
        taller = replace(one, mean=1.2 * one.mean)
        assert not rigid_pairs(static_model, static_model.labels, (one, taller)).any()

    def test_one_person_twice_has_them_still(self, legs, static_model, rng):
        again = marker_statistics(standing(legs[1], rng), static_model.labels, "again")
        both = (*static_model.statistics, again)
        once = rigid_pairs(static_model, static_model.labels, static_model.statistics)
        assert_array_equal(rigid_pairs(static_model, static_model.labels, both), once)


@pytest.fixture
def known(legs, static_model):
    """Return (template, rigid, segments, signature of the person moving)."""
    template = template_of(static_model)
    rigid = rigid_pairs(static_model, template.labels, static_model.statistics)
    at = {x: i for i, x in enumerate(template.labels)}
    segments = [[at[x] for x in (*s.markers, *s.shared)] for s in static_model.segments]
    own = template_of_person(template, rigid)
    return own, rigid, segments, signature(legs[1].markers[::20])


class TestPerson:
    def test_right_labels_prove_it_and_shifted_ones_do_not(self, known):
        own, rigid, _, found = known
        labels = np.arange(own.n)
        assert is_the_person(found.mean, labels, own, rigid)
        assert not is_the_person(1.08 * found.mean, labels, own, rigid)
        assert not is_the_person(found.mean, np.roll(labels, 1), own, rigid)
        assert not is_the_person(found.mean, np.full(own.n, -1), own, rigid)

    def test_a_mirror_is_told_by_the_sides_that_distances_fit(self, known, static_model):
        own, rigid, _, found = known
        twin = twins(static_model, own.labels)
        labels = np.arange(own.n)
        assert not is_mirrored(found.mean, labels, twin, own, rigid)
        assert is_mirrored(found.mean, twin[labels], twin, own, rigid)
        assert not is_mirrored(found.mean, np.full(own.n, -1), twin, own, rigid)

    def test_of_a_symmetric_body_nothing_is_said(self, known, static_model):
        own, rigid, _, _ = known
        twin = twins(static_model, own.labels)
        mean = own.size * (own.mean + own.mean[np.ix_(twin, twin)]) / 2
        symmetric = replace(own, mean=mean / own.size)
        for labels in (np.arange(own.n), twin):
            assert not is_mirrored(mean, labels, twin, symmetric, rigid)

    def test_the_first_place_of_a_segment_is_its_own(self, known):
        own, rigid, segments, found = known
        for segment in segments:
            if len(segment) < 3:
                continue
            places = places_of(found.mean, own.size * own.mean, rigid, 0.01, segment)
            costs = [place.cost for place in places]
            assert costs == sorted(costs)
            assert any((p.points == p.labels).all() for p in places)


class TestHeldToDistances:
    @pytest.fixture
    def held(self, known):
        own, rigid, segments, found = known
        problem = problem_of(found, own.size, own)

        def hold(labels):
            return held_to_distances(
                problem, found.mean, labels, own.size * own.mean, rigid, segments
            )

        return hold, own

    def test_right_labels_stay(self, held):
        hold, own = held
        assert_array_equal(hold(np.arange(own.n)), np.arange(own.n))

    @pytest.mark.parametrize("pair", [("LTOE", "LFWT"), ("RFWT", "LBWT"), ("LHEE", "RTOE")])
    def test_an_exchanged_pair_is_mended_or_blank(self, held, pair):
        hold, own = held
        a, b = (own.labels.index(x) for x in pair)
        labels = np.arange(own.n)
        labels[[a, b]] = b, a
        mended = hold(labels)
        assert ((mended == np.arange(own.n)) | (mended < 0)).all()
        assert (mended == np.arange(own.n)).sum() >= own.n - 2

    def test_a_free_label_goes_to_the_point_that_has_its_distances(self, held):
        hold, own = held
        labels = np.arange(own.n)
        labels[own.labels.index("LHEE")] = -1
        assert_array_equal(hold(labels), np.arange(own.n))
