"""Which frames axes are taken from, and how they are laid one after another."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.data import PoseFlag
from kinesphere.parameterization import ParameterizationSettings
from kinesphere.parameterization.view import (
    frames_within,
    reliable_frames,
    view_halves,
    view_joint,
)

SMOOTHED = 0.05  # what 4 Hz do to a limb's direction at the ends of short runs


def flags(*limbs):
    return np.array(limbs, dtype=np.uint8).T


def test_what_was_filled_or_borrowed_is_left_out():
    own, aided = [PoseFlag.MEASURED] * 8, [PoseFlag.JOINT_AIDED] * 8
    for bad in (PoseFlag.UNSEEN, PoseFlag.TWIST_BORROWED, PoseFlag.TWIST_UNKNOWN, PoseFlag.FILLED):
        parent, child = list(own), list(aided)
        parent[2] = child[5] = bad
        chosen = reliable_frames(flags(parent, child), np.ones(8, dtype=bool))
        assert_array_equal(np.flatnonzero(~chosen), [2, 5])


def test_a_limb_of_many_markers_is_left_out_where_it_leans_on_a_joint():
    child = [PoseFlag.MEASURED] * 6 + [PoseFlag.JOINT_AIDED] * 2
    chosen = reliable_frames(flags([PoseFlag.JOINT_AIDED] * 8, child), np.ones(8, dtype=bool))
    assert_array_equal(chosen, [True] * 6 + [False] * 2)


def test_a_doubtful_axis_beats_none():
    unknown = [PoseFlag.TWIST_UNKNOWN] * 7 + [PoseFlag.FILLED]
    chosen = reliable_frames(flags([PoseFlag.MEASURED] * 8, unknown), np.ones(8, dtype=bool))
    assert_array_equal(chosen, [True] * 7 + [False])
    filled = [PoseFlag.FILLED] * 8
    assert reliable_frames(flags(filled, filled), np.ones(8, dtype=bool)).all()


def test_limbs_that_are_good_in_turns_have_frames_in_common_all_the_same():
    parent = [PoseFlag.MEASURED] * 4 + [PoseFlag.FILLED] * 4
    chosen = reliable_frames(flags(parent, parent[::-1]), np.ones(8, dtype=bool))
    assert chosen.all()


def test_the_window_bounds_them():
    window = np.arange(8) >= 3
    chosen = reliable_frames(flags([PoseFlag.MEASURED] * 8, [PoseFlag.MEASURED] * 8), window)
    assert_array_equal(chosen, window)


@pytest.mark.parametrize("rate", [12.0, 29.97, 100.0, 120.0])
def test_frames_on_the_edge_of_a_window_are_inside_from_either_end_of_time(rate):
    last = 215 / rate
    for first, final in ((30, 135), (7, 91), (33, 34), (1, 214)):
        ahead = frames_within(216, rate, (first / rate, final / rate))
        back = frames_within(216, rate, (last - final / rate, last - first / rate))
        assert_array_equal(np.flatnonzero(ahead), np.arange(first, final + 1))
        assert_array_equal(back, ahead[::-1])


def test_a_frame_that_is_outside_a_window_stays_outside():
    assert_array_equal(np.flatnonzero(frames_within(8, 10.0, (0.11, 0.49))), [2, 3, 4])
    assert not frames_within(8, 10.0, (0.12, 0.18)).any()
    assert not frames_within(0, 10.0, (0.0, 1.0)).any()


def test_bad_frames_are_not_smoothed_into_good_ones(rng, calibration):
    joint = calibration(rng)
    good = np.ones(len(joint.rotations), dtype=bool)
    good[rng.integers(0, len(good), 40)[:, None] + np.arange(5)] = False
    spoiled = joint.rotations.copy()
    spoiled[~good] = np.eye(3)
    everywhere = np.ones(len(good), dtype=bool)
    settings = ParameterizationSettings()
    view = view_joint("joint_01", spoiled, joint.long_axis, everywhere, joint.rate, good, settings)
    assert_array_equal(view.samples.frames, np.flatnonzero(good))
    truth = joint.rotations[good] @ joint.long_axis
    assert_allclose(view.samples.positions, truth, atol=SMOOTHED)
    start, stop = view.samples.phases[0]
    frames = view.samples.frames
    assert view.samples.phase_times[0] == (
        frames[start] / joint.rate,
        (frames[stop - 1] + 1) / joint.rate,
    )


def test_halves_are_the_calibration_cut_in_two(rng, calibration):
    view = calibration(rng, correlated=0.5).view()
    first, second = view_halves(view, ParameterizationSettings())
    assert not (first.calibration & second.calibration).any()
    assert ((first.calibration | second.calibration) == view.calibration).all()
    assert abs(int(first.calibration.sum()) - int(second.calibration.sum())) <= 1
    assert len(first.samples.phases) == len(second.samples.phases) == len(view.samples.phases) / 2


def test_halves_of_nothing_are_nothing(rng, calibration):
    joint = calibration(rng)
    nowhere = np.zeros(len(joint.rotations), dtype=bool)
    settings = ParameterizationSettings()
    view = view_joint("x", joint.rotations, joint.long_axis, ~nowhere, 50.0, nowhere, settings)
    for half in view_halves(view, settings):
        assert not half.calibration.any()
