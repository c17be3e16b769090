"""The clock: frames by time alone."""

import pytest

from kinesphere.viewer import Clock


@pytest.fixture
def clock():
    return Clock(n_frames=240, rate=120.0)


def test_a_second_is_as_many_frames_as_the_rate_says(clock):
    started = clock.started(10.0)
    assert started.playing
    assert [started.at(10.0 + t) for t in (0.0, 0.25, 1.0)] == [0, 30, 120]


def test_it_goes_round(clock):
    assert clock.started(0.0).at(2.5) == 60


def test_it_stands_where_it_was_stopped(clock):
    stopped = clock.started(0.0).stopped(0.5)
    assert not stopped.playing
    assert stopped.at(99.0) == 60
    assert stopped.started(99.0).at(99.25) == 90


def test_a_change_of_speed_leaves_no_frame_out(clock):
    slow = clock.started(0.0).at_speed(0.1, 0.5)
    assert slow.at(0.5) == 60
    assert slow.at(1.5) == 72


def test_seeking_stays_inside_and_goes_on_if_it_went(clock):
    assert clock.sought(999, 5.0).at(6.0) == 239
    assert clock.sought(-3, 5.0).at(6.0) == 0
    assert clock.started(0.0).sought(100, 5.0).at(5.5) == 160


def test_one_frame_is_enough():
    assert Clock(1, 100.0).started(0.0).at(3.7) == 0
