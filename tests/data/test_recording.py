"""Recording: what it accepts, what it refuses, and that nobody can change it afterwards."""

import dataclasses

import numpy as np
import pytest

import kinesphere
from kinesphere.data import Analog, Output, Recording, Step
from kinesphere.errors import BadRecording

FRAMES, LABELS = 7, ("a", "b", "c", "d", "e")


def recording(rng, **changes):
    fields = {"markers": rng.normal(size=(FRAMES, len(LABELS), 3)), "labels": LABELS, "rate": 50.0}
    return Recording(**(fields | changes))


def test_arrays_cannot_be_changed_from_inside_or_outside(rng):
    mine = rng.normal(size=(FRAMES, len(LABELS), 3))
    held = recording(rng, markers=mine)
    before = held.markers.copy()
    mine[:] = 0
    np.testing.assert_array_equal(held.markers, before)
    with pytest.raises(ValueError, match="read-only"):
        held.markers[0, 0, 0] = 1
    with pytest.raises(dataclasses.FrozenInstanceError):
        held.rate = 1.0


def test_a_read_only_view_of_a_writable_array_is_not_trusted(rng):
    mine = rng.normal(size=(FRAMES, len(LABELS), 3))
    view = mine.view()
    view.flags.writeable = False
    held = recording(rng, markers=view)
    before = held.markers.copy()
    mine[:] = 0
    np.testing.assert_array_equal(held.markers, before)


def test_replacing_a_field_does_not_copy_the_others(rng):
    held = recording(rng)
    assert dataclasses.replace(held, rate=100.0).markers is held.markers


def test_a_marker_with_a_missing_coordinate_is_not_seen(rng):
    markers = rng.normal(size=(FRAMES, len(LABELS), 3))
    markers[3, 1, 2] = np.nan
    seen = recording(rng, markers=markers).seen
    assert not seen[3, 1]
    assert seen.sum() == seen.size - 1


def test_times_start_at_zero_and_step_by_the_rate(rng):
    np.testing.assert_allclose(recording(rng, rate=8.0).times, np.arange(FRAMES) / 8.0)


def test_columns_follow_the_order_asked_for(rng):
    assert recording(rng).columns(("d", "a")) == [3, 0]
    with pytest.raises(BadRecording, match=r"no marker is called x, y; there are a, b, c, d, e"):
        recording(rng).columns(("x", "a", "y"))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"labels": ("a", "b", "c", "d", "b")}, "more than once: b"),
        ({"rate": 0.0}, "rate is 0.0 Hz"),
        ({"rate": float("nan")}, "rate is nan Hz"),
        ({"rate": float("inf")}, "rate is inf Hz"),
        ({"outputs": (Output("angle", "angle", np.zeros((6, 3)), "deg"),)}, "has 6 frames"),
    ],
)
def test_contradictions_are_refused(rng, changes, message):
    with pytest.raises(BadRecording, match=message):
        recording(rng, **changes)


def test_an_array_in_another_order_is_put_in_ours(rng):
    columns_first = np.asfortranarray(rng.normal(size=(FRAMES, len(LABELS), 3)))
    columns_first.flags.writeable = False
    held = recording(rng, markers=columns_first).markers
    assert held.flags.c_contiguous
    np.testing.assert_array_equal(held, columns_first)


def test_misplaced_axes_are_named(rng):
    with pytest.raises(ValueError, match=r"residuals must have shape \(7, 5\), got \(5, 7\)"):
        recording(rng, residuals=np.zeros((5, 7)))
    with pytest.raises(ValueError, match=r"markers must have shape \(any, 5, 3\), got \(5, 7, 3\)"):
        recording(rng, markers=np.zeros((5, 7, 3)))


def test_infinity_is_no_way_to_say_not_seen(rng):
    markers = np.zeros((FRAMES, len(LABELS), 3))
    markers[2, 4, 1] = np.inf
    with pytest.raises(ValueError, match=r"infinite at \(2, 4, 1\)"):
        recording(rng, markers=markers)


def test_a_step_is_signed_by_the_version_that_took_it():
    assert Step("read").version == kinesphere.__version__
    assert Step("read", version="0.0").version == "0.0"


def test_every_analog_channel_has_a_unit():
    with pytest.raises(BadRecording, match="2 analog channels have 3 units"):
        Analog(np.zeros((5, 2)), labels=("Fx", "Fz"), units=("N", "N", "N"), rate=1000.0)
