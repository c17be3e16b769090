"""Lengths in a wrong unit: the same joints, at another size."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.data import Landmark
from kinesphere.geometry.length_units import STATURE
from kinesphere.skeleton import discover, fit_skeleton
from kinesphere.skeleton.discovery.person import Person
from kinesphere.skeleton.landmarks import STEADY
from kinesphere.skeleton.other_size import with_lengths
from kinesphere.skeleton.scale import PERSON, TINY, times_too_large
from kinesphere.synthetic import HAND, QUADRUPED, make_performance, spoil_with_noise

SMALL, ROUGHLY = 1e-5, 1e-3  # m, relative


@pytest.fixture(scope="module")
def person():
    made = make_performance(np.random.default_rng(7), rate=25, calibration_s=40, free_s=20)
    return spoil_with_noise(made.recording, np.random.default_rng(8), deviation=0.001), made.model


def rescaled(recording, times):
    return replace(recording, markers=times * recording.markers)


def is_the_same(motion, other, times):
    """Whether ``other`` is ``motion``, ``times`` as large; iterations may end a step apart."""

    def equal(there, here, power=1):
        return there / times**power == pytest.approx(here, abs=SMALL, rel=ROUGHLY, nan_ok=True)

    assert other.skeleton.joint_names == motion.skeleton.joint_names
    for here, there in zip(motion.skeleton.joints, other.skeleton.joints, strict=True):
        assert there.observability == here.observability
        assert equal(there.centre_in_child, here.centre_in_child)
        off = there.covariance / times**2 - here.covariance  # what two directions share may be 0
        assert np.linalg.norm(off) <= ROUGHLY * np.linalg.norm(here.covariance)
        assert equal(there.residual, here.residual)
    for here, there in zip(motion.skeleton.limbs, other.skeleton.limbs, strict=True):
        assert equal(there.length, here.length)
        assert equal(there.marker_positions, here.marker_positions)
    assert equal(other.joint_centres(), motion.joint_centres())
    assert equal(other.residuals, motion.residuals)
    assert (other.flags == motion.flags).all()


@pytest.mark.parametrize("times", [10.0, 1000.0])
def test_what_is_too_large_for_anybody_has_the_same_joints_in_proportion(person, times):
    recording, model = person
    motion, other = fit_skeleton(recording, model), fit_skeleton(rescaled(recording, times), model)
    is_the_same(motion, other, times)
    (told,) = set(other.history[-1].warnings) - set(motion.history[-1].warnings)
    assert told.startswith("nobody is so large")
    assert f"{times:g} times smaller" in told
    here, there = (m.history[-1].findings["joints"]["left_knee"] for m in (motion, other))
    assert there["residual_mm"] == pytest.approx(times * here["residual_mm"])
    assert other.skeleton.history == other.history


@pytest.mark.parametrize("times", [0.1, 10.0, 39.37, 1 / 25.4])
def test_joints_from_motion_alone_are_those_of_the_person_whatever_the_unit(person, times):
    """Names are not given there, so all are measured as joints of limbs without names."""
    recording, _ = person
    found = discover(rescaled(recording, times))
    assert found.unit == times
    (told,) = (w for w in found.step.warnings if "unit of length" in w)
    stature = float(told.partition("someone of ")[2].partition(" m)")[0])
    assert 1.2 < stature / times < 2.1
    assert f"{1 / times:.4g} times as large" in told
    assert discover(rescaled(recording, 1 / times)).model.segments == found.model.segments
    other = fit_skeleton(rescaled(recording, times), found.model, unit=found.unit)
    is_the_same(
        fit_skeleton(*with_lengths(rescaled(recording, times), found.model, 1 / times)),
        other,
        times,
    )
    assert not any("unit of length" in w for w in other.history[-1].warnings)


def test_an_animal_ten_times_too_large_is_measured_as_it_is():
    made = make_performance(np.random.default_rng(1), plan=QUADRUPED, calibration_s=40, free_s=9)
    recording = spoil_with_noise(made.recording, np.random.default_rng(8), deviation=0.001)
    found, other = discover(recording), discover(rescaled(recording, 10))
    assert (found.unit, other.unit) == (None, None)
    one = fit_skeleton(recording, found.model)
    is_the_same(one, fit_skeleton(rescaled(recording, 10), other.model), 10)


@pytest.mark.parametrize(
    ("extent", "times"),
    [
        *((0.05, 1), (0.5, 1), (9.9 * PERSON, 1), (10.1 * PERSON, 10), (5.0, 10), (500.0, 1000)),
        *((1.01 * TINY, 1), (0.99 * TINY, 0.1), (5e-4, 1e-2), (5e-5, 1e-3)),
    ],
)  # m, rms about the middle
def test_nobody_is_as_large_as_ten_people_or_smaller_than_a_finger(extent, times):
    square = np.array([[1.0, 1.0, 5.0], [-1.0, 1.0, 5.0], [-1.0, -1.0, 5.0], [1.0, -1.0, 5.0]])
    found = times_too_large(np.repeat(extent * square[None], 7, axis=0) / np.sqrt(2))
    assert found == pytest.approx(times)


def test_where_nothing_is_seen_nothing_is_too_large():
    assert times_too_large(np.full((3, 4, 3), np.nan)) == 1


@pytest.mark.parametrize(
    ("stature", "times"),
    [
        (0.17, 0.1),
        (0.12, 0.1),
        (17.0, 10),
        (1.1, 1),
        (0.5, 1),
        (0.0016, 1e-3),
        (1000.0, 1e3),
        (850.0, 1e3),
    ],
)  # m
def test_a_doll_is_no_person_in_another_unit(stature, times):
    person = Person(0, None, ((1, 2), (3, 4)), (), None, stature=stature)
    assert person.times_too_large == pytest.approx(times)


@pytest.mark.parametrize("factor", [39.37, 25.4, 2.54, 1 / 0.3048, 1 / 25.4, 0.0254])
@pytest.mark.parametrize("stature", [1.5, 1.6, 1.75])  # m; 2.54 and 3.28 leave no room for more
def test_inches_and_feet_are_units_too(stature, factor):
    person = Person(0, None, ((1, 2), (3, 4)), (), None, stature=stature * factor)
    assert person.times_too_large == pytest.approx(factor, rel=1e-4)


@pytest.mark.parametrize("stature", [1.0, 1.3, 1.6, 1.9])  # m
@pytest.mark.parametrize("factor", [1e-3, 1e-2, 0.1, 10.0, 100.0, 1000.0])
def test_a_child_in_centimetres_is_no_adult_in_inches(stature, factor):
    person = Person(0, None, ((1, 2), (3, 4)), (), None, stature=stature * factor)
    assert person.times_too_large == pytest.approx(factor)


@pytest.mark.parametrize("stature", [0.0049, 485.0])  # m
def test_a_person_whom_no_unit_explains_is_brought_to_a_person_s_size(stature):
    person = Person(0, None, ((1, 2), (3, 4)), (), None, stature=stature)
    assert stature / person.times_too_large == pytest.approx(STATURE)


@pytest.mark.parametrize("times", [0.1, 1e-3])
def test_a_hand_too_small_for_any_body_has_the_same_joints_in_proportion(times):
    made = make_performance(np.random.default_rng(1), plan=HAND, calibration_s=40, free_s=9)
    recording = spoil_with_noise(made.recording, np.random.default_rng(8), deviation=1e-4)
    motion = fit_skeleton(recording, made.model)
    other = fit_skeleton(rescaled(recording, times), made.model)
    is_the_same(motion, other, times)
    (told,) = set(other.history[-1].warnings) - set(motion.history[-1].warnings)
    assert told.startswith("no body is so small")
    assert f"{1 / times:g} times larger" in told


def test_only_what_motion_told_of_a_landmark_goes_with_the_unit(person):
    recording, model = person
    told = Landmark({"trunk1": 1.0}, spread=0.06, source=STEADY)
    of_people = replace(told, source="a paper")
    joint = replace(model.joints[0], landmarks=(told, of_people))
    model = replace(model, joints=(joint, *model.joints[1:]))
    smaller, other = with_lengths(recording, model, 0.1)
    assert [mark.spread for mark in other.joints[0].landmarks] == pytest.approx([0.006, 0.06])
    assert smaller.markers == pytest.approx(0.1 * recording.markers)
