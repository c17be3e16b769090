"""Lengths that no person has, by how much they are off, and what they do not hide."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.geometry.length_units import times_too_large
from kinesphere.quality import check_at_size, check_recording, check_unit, told_unit
from kinesphere.synthetic import make_performance

WRONG = (1e-3, 1e-2, 1 / 25.4, 10.0, 25.4, 39.37, 100.0, 1000.0)


@pytest.fixture(scope="module")
def person():
    rng = np.random.default_rng(3)
    layout = {"layout": "cmu41", "rate": 10.0, "calibration_s": 5.0, "free_s": 2.0}
    return make_performance(rng, **layout).recording


def unlabelled(recording):
    return replace(recording, labels=tuple(f"*{i}" for i in range(recording.n_markers)))


def times(recording, factor):
    found = tuple(check_unit(replace(recording, markers=recording.markers * factor)))
    return len(found), told_unit(found)


@pytest.mark.parametrize("factor", WRONG)
def test_of_a_body_that_labels_name_it_is_told_how_many_times(person, factor):
    assert times(person, factor) == (1, pytest.approx(factor, rel=1e-3))


@pytest.mark.parametrize("factor", [1e-3, 10.0, 25.4, 100.0, 1000.0])
def test_and_of_one_whole_person_without_labels(person, factor):
    assert times(unlabelled(person), factor) == (1, pytest.approx(factor, rel=1e-3))


@pytest.mark.parametrize("factor", [1.0, 0.6, 1.3])
def test_children_and_tall_people_are_of_their_size(person, factor):
    assert times(person, factor) == times(unlabelled(person), factor) == (0, 1.0)


def test_a_crowd_is_no_giant(person):
    """Markers are far from the middle of all of them, and near the next one."""
    crowd = unlabelled(person)
    shifts = np.array([[4.0, 0, 0], [-4, 0, 1], [0, 0, 5], [1, 0, -5]])
    markers = np.concatenate([crowd.markers + shift for shift in shifts], axis=1)
    labels = tuple(f"*{i}" for i in range(markers.shape[1]))
    crowd = replace(crowd, markers=markers, labels=labels)
    assert times(crowd, 1.0) == (0, 1.0)
    n, told = times(crowd, 100.0)
    assert (n, told) == (1, 1.0)  # wrong, by how much nothing tells


@pytest.mark.parametrize("count", [9, 19])
def test_of_a_limb_it_is_not_told_how_many_times(person, count):
    """A few markers may be those of an arm, which is as large as it is."""
    few = unlabelled(person)
    few = replace(few, markers=few.markers[:, ::2], labels=few.labels[::2])
    few = replace(few, markers=few.markers[:, :count], labels=few.labels[:count])
    assert times(few, 1.0)[0] == 0
    assert times(few, 1000.0) == (1, 1.0)


def test_bodies_that_differ_tell_nothing_together(person):
    two = replace(
        person,
        markers=np.concatenate([person.markers * 10.0, person.markers * 1000.0], axis=1),
        labels=tuple(f"{name}:{label}" for name in "AB" for label in person.labels),
    )
    assert times(two, 1.0) == (2, 1.0)


def test_at_its_true_size_a_recording_has_nothing_else_wrong_with_it(person):
    """At a thousandfold every marker jumps."""
    off = replace(person, markers=person.markers * 1e3)
    known = {f.rule for f in check_at_size(off, 1e3)}
    assert known - {"far"} == {f.rule for f in check_recording(person)} | {"unit"}
    assert "jump" in {f.rule for f in check_recording(off)}


@pytest.mark.parametrize("value", [0.0, 1e-300, 1e150])
def test_lengths_of_no_size_at_all_raise_nothing(person, value):
    for recording in (person, unlabelled(person)):
        markers = np.full_like(recording.markers, value)
        assert len(tuple(check_unit(replace(recording, markers=markers)))) == 1
    assert times(person, np.nan) == (0, 1.0)


@pytest.mark.parametrize(
    ("stature", "told"), [(1.6, 1.0), (0.5, 1.0), (40.64, 25.4), (160.0, 100.0), (0.0016, 1e-3)]
)
def test_the_likeliest_unit_of_a_stature(stature, told):
    assert times_too_large(stature) == pytest.approx(told, rel=1e-6)
