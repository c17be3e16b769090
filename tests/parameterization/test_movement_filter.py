"""The movement filter, against phases we placed ourselves."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from kinesphere.geometry.rotations import rotation_angle
from kinesphere.parameterization.movement_filter import (
    bridge,
    drop_short,
    find_movement,
    hysteresis,
    sample_speeds,
    trim,
)
from kinesphere.parameterization.samples import without_spikes
from kinesphere.parameterization.settings import FilterSettings
from kinesphere.parameterization.speed_threshold import paper_threshold, valley_threshold

NOISES = {
    "clean": {},
    "independent 1 deg": {"independent": 1.0},
    "independent 3 deg": {"independent": 3.0},
    "correlated 1 deg": {"correlated": 1.0},
    "correlated 3 deg": {"correlated": 3.0},
}
WORST_F1 = 0.95  # a frame or two more or less at the ends of every movement


def f1(found, true):
    both = (found & true).sum()
    return 2 * both / (found.sum() + true.sum())


@pytest.mark.parametrize("noise", NOISES)
@pytest.mark.parametrize("method", ["bounded-valley", "log-speed"])
def test_movements_are_found_again(rng, calibration, noise, method):
    joint = calibration(rng, **NOISES[noise])
    movement = joint.view(filter=FilterSettings(method=method)).movement
    assert movement.valley
    assert f1(movement.moving, joint.moving) > WORST_F1


@pytest.mark.parametrize("rate", [12.0, 50.0, 240.0])
def test_windows_are_seconds_at_every_rate(rng, calibration, rate):
    joint = calibration(rng, rate=rate)
    movement = joint.view().movement
    assert f1(movement.moving, joint.moving) > WORST_F1
    assert len(movement.phases) == 6


def test_the_papers_histogram_works_without_noise(rng, calibration):
    joint = calibration(rng, sway=0.05)
    movement = joint.view(filter=FilterSettings(method="paper")).movement
    assert movement.valley
    assert f1(movement.moving, joint.moving) > 0.8  # turning points count as rest there


def test_the_papers_threshold_is_the_first_gap_behind_the_peak():
    speeds = np.concatenate([np.full(100, 0.05), np.full(4, 0.35), np.full(30, 0.75), [1.0]])
    threshold = paper_threshold(speeds)
    assert threshold == pytest.approx(0.06, abs=1e-12)
    assert paper_threshold(np.zeros(9)) is None
    assert paper_threshold(np.empty(0)) is None


def test_single_frames_that_jump_away_change_nothing(rng, calibration):
    joint = calibration(rng)
    rotations = joint.rotations.copy()
    at = rng.choice(np.arange(5, len(rotations), 40), 15, replace=False)
    turns = Rotation.from_rotvec(rng.normal(size=(15, 3))).as_matrix()
    rotations[at] = turns @ rotations[at]
    spoilt = replace(joint, rotations=rotations).view().movement
    assert f1(spoilt.moving, joint.moving) > WORST_F1
    mended = without_spikes(rotations, joint.rate)
    assert rotation_angle(np.swapaxes(mended, 1, 2) @ joint.rotations).max() < 0.1


@pytest.mark.parametrize("rate", [12.0, 100.0])
def test_a_fast_swing_is_no_spike(rate):
    angles = 0.8 * np.sin(2 * np.pi * np.arange(40) / rate)
    swing = Rotation.from_rotvec(angles[:, None] * [0, 0, 1.0]).as_matrix()
    assert_array_equal(without_spikes(swing, rate), swing)
    whip = Rotation.from_rotvec(np.arange(40)[:, None] * [0, 0, 20 / rate]).as_matrix()
    assert_array_equal(without_spikes(whip, rate), whip)  # 1,100 deg/s, but it does not come back


def test_speed_is_an_angular_velocity():
    t = np.arange(80) / 40.0
    circle = np.stack([np.cos(1.7 * t), np.sin(1.7 * t), 0 * t], axis=1)
    assert_allclose(sample_speeds(circle, 40.0, 0.2), 1.7, rtol=1e-12)
    raw = sample_speeds(circle, 40.0, 0.0)
    assert np.isnan(raw[0])  # the paper's first frame has no step
    assert_allclose(raw[1:], 1.7, rtol=1e-12)


def test_what_is_unseen_never_moves(rng, calibration):
    joint = calibration(rng)
    positions = joint.rotations @ joint.long_axis
    gap = slice(310, 330)
    positions[gap] = np.nan
    found = find_movement(positions, joint.rate, FilterSettings())
    assert not found.moving[gap].any()
    assert all(stop <= 310 or start >= 330 for start, stop in found.phases)


def test_no_valley_is_flagged_not_raised(rng):
    still = np.tile([0.0, 0.0, 1.0], (50, 1))
    found = find_movement(still, 50.0, FilterSettings())
    assert not found.valley
    assert not found.moving.any()
    assert found.threshold == pytest.approx(np.deg2rad(12.6))
    turning = np.stack([np.cos(np.arange(50.0)), np.sin(np.arange(50.0)), np.zeros(50)], axis=1)
    found = find_movement(turning, 50.0, FilterSettings())
    assert not found.valley
    assert found.moving.all()
    nothing = find_movement(np.full((5, 3), np.nan), 50.0, FilterSettings())
    assert not nothing.moving.any()


def test_the_valley_stays_in_its_bounds(rng):
    slow, fast = rng.normal(0.01, 0.002, 500), rng.normal(3.0, 0.4, 300)
    speeds = np.abs(np.concatenate([slow, fast]))
    threshold = valley_threshold(speeds, np.deg2rad(4), np.deg2rad(40))
    assert np.deg2rad(4) <= threshold <= np.deg2rad(40)
    assert valley_threshold(speeds, 10.0, 11.0) is None  # nothing is that fast
    assert valley_threshold(fast, np.deg2rad(4), np.deg2rad(40)) is None  # no slow side


def test_a_movement_starts_slow_but_gets_fast():
    speeds = np.array([0, 2, 3, 6, 3, 2, 0, 3, 3, 0, np.nan, 6, 1])
    wanted = [0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 0, 1, 0]
    assert_array_equal(hysteresis(speeds, 5.0, 2.5), np.array(wanted, dtype=bool))


def test_short_rests_are_bridged_and_short_movements_dropped():
    moving = np.array([0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 0], dtype=bool)
    known = np.ones(11, dtype=bool)
    assert bridge(moving, known, 2).tolist() == [0, 1, 1, 1, 1, 1, 0, 0, 0, 1, 0]
    known[3] = False
    assert bridge(moving, known, 2).tolist() == moving.tolist()  # nobody saw it rest there
    assert drop_short(moving, 2).tolist() == [0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0]


def test_a_window_sees_movements_too_early_and_too_late():
    moving = np.array([1, 1, 1, 0, 1, 1, 1, 1, 1, 0, 1, 0, 0, 1, 1, 1], dtype=bool)
    assert trim(moving, 1).tolist() == [1, 1, 0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 0, 1, 1]


def test_a_still_stretch_leaves_the_threshold(rng, calibration):
    joint = calibration(rng)
    positions = joint.rotations @ joint.long_axis
    once = find_movement(positions, joint.rate, FilterSettings())
    twice = find_movement(np.concatenate([positions[:90], positions]), joint.rate, FilterSettings())
    assert abs(np.log(twice.threshold / once.threshold)) < 0.11  # one of the 100 bins


def test_a_mirrored_clock_moves_alike(rng, calibration):
    joint = calibration(rng)
    positions = joint.rotations @ joint.long_axis
    forward = find_movement(positions, joint.rate, FilterSettings())
    backward = find_movement(positions[::-1], joint.rate, FilterSettings())
    assert_array_equal(backward.moving[::-1], forward.moving)
