"""The small parts: which frames, whose twist, how far a joint moves, settings."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.errors import BadSetting
from kinesphere.skeleton import SkeletonSettings
from kinesphere.skeleton.averages import mean_seen, median_seen
from kinesphere.skeleton.poses import borrowing
from kinesphere.skeleton.report import range_of_motion
from kinesphere.skeleton.sampling import spread_frames

MARKERS = 4


def test_frames_are_spread_over_the_way_not_the_time(rng):
    way = np.concatenate([np.zeros(900), np.linspace(0, 1, 100)])
    markers = rng.normal(size=(1, MARKERS, 3)) * (1 + way[:, None, None])
    markers[37, 2] = np.nan
    frames = spread_frames(markers, 50)
    assert len(frames) <= 50
    assert (np.diff(frames) > 0).all()
    assert (frames >= 900).mean() > 0.8
    assert {0, 999} <= set(frames)


def test_all_frames_where_they_are_few_and_even_ones_where_nothing_moves():
    still = np.ones((200, MARKERS, 3))
    assert spread_frames(still, 300).tolist() == list(range(200))
    steps = np.diff(spread_frames(still, 20))
    assert steps.min() >= 0.5 * steps.max()


def test_a_twist_is_borrowed_above_one_angle_and_kept_above_a_smaller():
    degrees = np.array([5, 17, 22, 17, 16, 5, 17, np.nan, 30.0])
    lent = borrowing(np.sin(np.deg2rad(degrees)), np.deg2rad(20))
    assert lent.tolist() == [False, True, True, True, True, False, False, False, True]


def test_range_of_motion_is_the_widest_angle_but_for_outliers(rng):
    angles = np.linspace(0, np.deg2rad(80), 200)
    turns = Rotation.from_rotvec(angles[:, None] * [0, 0, 1.0]).as_matrix()
    assert range_of_motion(turns) == pytest.approx(np.deg2rad(76), abs=np.deg2rad(1.5))
    wild = turns.copy()
    wild[50] = Rotation.from_rotvec([3.0, 0, 0]).as_matrix()
    wild[60] = np.nan
    assert range_of_motion(wild) == pytest.approx(range_of_motion(turns), abs=np.deg2rad(2))
    assert range_of_motion(turns[:1]) == 0.0


def test_averages_leave_out_what_is_not_seen():
    values = np.array([[1.0, np.nan], [3.0, np.nan], [np.nan, np.nan]])
    assert mean_seen(values).tolist()[0] == 2.0
    assert median_seen(values).tolist()[0] == 2.0
    assert np.isnan([mean_seen(values)[1], median_seen(values)[1]]).all()


def test_settings_refuse_what_makes_no_sense():
    with pytest.raises(BadSetting, match=r"soft_tissue is 0\.5; it must be at least 1\.0"):
        SkeletonSettings(soft_tissue=0.5)
