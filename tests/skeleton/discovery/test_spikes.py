"""One frame far away changes nothing, and what really goes there is kept."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.skeleton import discover
from kinesphere.skeleton.discovery.spikes import without_spikes


@pytest.fixture
def walking(rng):
    """Return six markers within a metre that go five metres, (100, 6, 3) m."""
    return rng.normal(scale=0.3, size=(6, 3)) + np.linspace(0, 5, 100)[:, None, None]


def test_a_frame_far_away_is_left_out(walking):
    spoilt = walking.copy()
    spoilt[40, 2] = 1e6
    spoilt[70] *= 1e3
    expected = walking.copy()
    expected[40, 2] = expected[70] = np.nan
    np.testing.assert_array_equal(without_spikes(spoilt), expected)


def test_who_goes_far_and_stays_is_kept(walking):
    walking[50:] += 30.0
    walking[20, 1] += 0.2
    assert without_spikes(walking) is walking


def test_a_marker_once_a_kilometre_away_leaves_bodies_and_names(recorded):
    whole = discover(recorded)
    for where in ((300, 5), (300,)):
        markers = recorded.markers.copy()
        markers[where] += 1e3
        found = discover(replace(recorded, markers=markers))
        assert found.model.segments == whole.model.segments
