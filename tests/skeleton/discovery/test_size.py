"""A subject's size, and an order of markers that is not the file's."""

import numpy as np
import pytest

from kinesphere.skeleton.discovery.size import PERSON, from_the_middle, subject_size


def test_size_goes_with_the_unit(recorded):
    size = subject_size(recorded.markers)
    assert size == pytest.approx(PERSON, rel=0.5)
    assert subject_size(0.1 * recorded.markers) == pytest.approx(0.1 * size, rel=1e-9)


def test_a_second_subject_counts_by_its_markers_and_not_by_how_far_it_is(recorded):
    size = subject_size(recorded.markers)
    for away in (3.0, 300.0):  # m
        both = np.concatenate([recorded.markers, recorded.markers + np.array([away, 0, 0])], axis=1)
        assert subject_size(both) == pytest.approx(np.sqrt(2) * size, rel=1e-9)


def test_more_markers_on_the_same_sheet_leave_its_size(rng):
    few, many = rng.random((20, 50, 3)) * [1, 1, 0], rng.random((20, 200, 3)) * [1, 1, 0]
    assert subject_size(many) == pytest.approx(subject_size(few), rel=0.1)


def test_nothing_to_measure_is_a_person(recorded):
    assert subject_size(np.full((5, 4, 3), np.nan)) == PERSON
    assert subject_size(np.zeros((5, 4, 3))) == PERSON
    assert subject_size(recorded.markers[:, :2]) == PERSON


def test_the_order_is_the_subject_s_own(recorded, rng):
    shuffled = rng.permutation(recorded.n_markers)
    own = from_the_middle(recorded.markers)
    assert shuffled[from_the_middle(recorded.markers[:, shuffled])].tolist() == own.tolist()
    assert sorted(own) == list(range(recorded.n_markers))


def test_the_order_goes_outward_and_ends_with_what_is_never_seen():
    row = np.array([0.0, 4.0, 1.5, 2.2, 9.0, 5.0])
    markers = np.stack([row, 0 * row, 0 * row], axis=1)[None].repeat(3, axis=0)
    markers[:, 3] = np.nan
    assert from_the_middle(markers).tolist() == [2, 1, 5, 0, 4, 3]
