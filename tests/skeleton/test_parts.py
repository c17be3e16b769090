"""The small parts: which frames, whose twist, how far a joint moves, settings."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.data import JointModel
from kinesphere.errors import BadSetting
from kinesphere.geometry.centres import CentreFit
from kinesphere.geometry.range_of_motion import range_of_motion
from kinesphere.skeleton import SkeletonSettings
from kinesphere.skeleton.averages import mean_seen, median_seen
from kinesphere.skeleton.body import measure_shape
from kinesphere.skeleton.limb_body import joint_noise
from kinesphere.skeleton.measured import MeasuredJoint
from kinesphere.skeleton.poses import borrowing
from kinesphere.skeleton.report import verdict_on
from kinesphere.skeleton.sampling import spread_frames, spread_over_joints

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


def test_joints_have_equal_shares_of_frames_however_small_their_ways():
    """A hip that moves by a metre for 10 s, an ankle by 2 cm for 5 s, rest, 50 Hz."""
    t = np.linspace(0, 1, 4000)
    markers = np.zeros((4000, 6, 3)) + np.arange(6)[:, None]
    markers[500:1000, 2:4, 0] += np.sin(60 * t[500:1000] * np.pi)[:, None]
    markers[3000:3250, 4:6, 1] += 0.02 * np.sin(60 * t[3000:3250] * np.pi)[:, None]
    trunk, thigh, foot = [0, 1], [2, 3], [4, 5]
    frames = spread_over_joints(markers, 200, [(trunk, thigh), (trunk, foot)])
    assert len(frames) <= 200
    assert (np.diff(frames) > 0).all()
    assert {0, 3999} <= set(frames)
    hip, ankle = (((lo <= frames) & (frames < hi)).sum() for lo, hi in ((500, 1000), (3000, 3250)))
    assert 0.6 < hip / ankle < 1.6
    by_way = spread_frames(markers, 200)
    assert ((by_way >= 3000) & (by_way < 3250)).sum() < 0.5 * ankle
    gaps = np.diff(frames)
    assert gaps.max() <= 4000 / 100 + 1  # half of them are even in time


def test_ghosts_and_gaps_are_no_way_of_a_joint(rng):
    markers = np.cumsum(rng.normal(scale=0.003, size=(1000, 4, 3)), axis=0)
    joints = [([0, 1], [2, 3])]
    there = spread_over_joints(markers, 60, joints)
    assert spread_over_joints(markers, 1000, joints).tolist() == list(range(1000))
    spoilt = markers.copy()
    spoilt[500, 2] += 100.0
    spoilt[700:710, 1] = np.nan
    assert len(np.intersect1d(there, spread_over_joints(spoilt, 60, joints))) > 30
    assert spread_over_joints(np.full((1000, 4, 3), np.nan), 60, joints).size
    back = 999 - spread_over_joints(markers[::-1], 60, joints)
    assert len(np.intersect1d(there, back)) >= len(there) - 2


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


@pytest.mark.parametrize(
    ("deviations_mm", "spread_mm", "range_deg", "expected"),
    [
        ((1, 2, 3), 10, 60, "determined"),
        ((1, 2, 30), 50, 60, "hinge"),  # worse than is useful
        ((1, 2, 15), 10, 60, "hinge"),  # the expectation knows better
        ((1, 30, 30), 50, 60, "undetermined"),
        ((1, 2, 3), 10, 9, "undetermined"),  # hardly moved
    ],
)
def test_the_verdict_weighs_motion_against_use_and_expectation(
    deviations_mm, spread_mm, range_deg, expected
):
    data = np.diag(np.array(deviations_mm) * 1e-3) ** 2
    prior = np.eye(3) / (spread_mm * 1e-3) ** 2
    fit = CentreFit(np.zeros(3), 1e-3, data, prior, np.linalg.inv(np.linalg.inv(data) + prior), 9)
    measured = MeasuredJoint(
        JointModel("left_hip", "pelvis", "left_thigh"), fit, np.zeros(3), spread_mm * 1e-3, "book"
    )
    found, note = verdict_on(measured, np.deg2rad(range_deg), SkeletonSettings())
    assert found == expected
    assert note.startswith(f"range of motion {range_deg}°")
    assert ("book" in note) == (expected != "determined")


def test_a_centre_held_where_it_is_expected_is_not_determined_by_what_motion_would_tell():
    data, prior = np.diag([0.002, 0.002, 0.015]) ** 2, np.diag([1.0, 1.0, 100.0]) / 0.07**2
    held = np.diag([0.002, 0.002, 0.07]) ** 2  # along the third the expectation held, and errs
    hip = JointModel("left_knee", "left_thigh", "left_shank")
    told = [
        verdict_on(MeasuredJoint(hip, fit, np.zeros(3), 0.07, "book"), 1.0, SkeletonSettings())
        for fit in (CentreFit(np.zeros(3), 1e-3, data, prior / 100, one, 9) for one in (data, held))
    ]
    assert told[0][0] == "determined"
    assert told[1][0] == "hinge"
    assert "± 70 mm" in told[1][1]


@pytest.mark.parametrize(
    ("drawn", "said"),
    [(0.0053, ", drawn 5 mm towards where it is expected (book)"), (0.0004, "")],
)
def test_a_determined_centre_says_how_far_anatomy_has_drawn_it(drawn, said):
    data = np.diag([0.004, 0.006, 0.011]) ** 2
    fit = CentreFit(np.zeros(3), 1e-3, data, np.eye(3) / 0.05**2, data / 2, 9)
    hip = MeasuredJoint(
        JointModel("left_hip", "pelvis", "left_thigh"), fit, np.zeros(3), 0.009, "book", drawn
    )
    verdict, note = verdict_on(hip, np.deg2rad(40), SkeletonSettings())
    assert verdict == "determined"
    assert note == f"range of motion 40°{said}"


def test_a_centre_drawn_away_is_not_said_to_be_where_it_was_expected():
    data, prior = np.diag([0.0003, 0.0009, 0.09]), np.eye(3) / 0.05**2
    fit = CentreFit(np.array([0.2, 0.0, 0.0]), 1e-3, data, prior, np.linalg.inv(prior), 9)
    hip = JointModel("left_hip", "pelvis", "left_thigh")
    away, near = (
        verdict_on(MeasuredJoint(hip, fit, expected, 0.05, "book"), 1.0, SkeletonSettings())
        for expected in (np.zeros(3), np.array([0.16, 0.0, 0.0]))
    )
    assert away[0] == near[0] == "undetermined"
    assert away[1].endswith("200 mm from where it is expected (book)")
    assert near[1].endswith("placed by expectation (book)")


def plate_that_shakes(rng, scale, noise=1e-3, n=4000):
    """Return markers of a plate of 5 cm, and a joint 0.3 m away that strays by ``scale``."""
    plate = np.array([[0, 0, 0], [0.05, 0, 0], [0, 0.05, 0], [0.05, 0.04, 0.01]])
    turns = Rotation.random(n, rng=rng).as_matrix()
    points = plate @ np.swapaxes(turns, 1, 2) + rng.normal(scale=noise, size=(n, 4, 3))
    joint = turns @ np.array([0.02, 0.3, 0.0]) + rng.normal(scale=scale, size=(n, 3))
    return points, joint


def test_a_joint_does_not_stray_because_a_small_plate_shakes(rng):
    points, steady = plate_that_shakes(rng, 0.0)
    assert joint_noise(measure_shape(points, 0.003, 0.005), steady, 1e-4) < 0.002  # beside 4 mm


@pytest.mark.parametrize("scale", [0.004, 0.02])
def test_a_joint_counts_beside_markers_by_what_both_stray(rng, scale):
    """Markers of 1 mm are reckoned with √2 mm; so is what else there is, or it would outvote."""
    points, joint = plate_that_shakes(rng, scale)
    found = joint_noise(measure_shape(points, 0.003, 0.005), joint, 1e-4)
    assert found == pytest.approx(np.sqrt(2) * scale, rel=0.12)


def test_no_joint_is_surer_than_what_is_known_to_stray(rng):
    points, steady = plate_that_shakes(rng, 0.0)
    assert joint_noise(measure_shape(points, 0.003, 0.005), steady, 0.007) == 0.007


def test_where_markers_are_seen_exactly_a_joint_keeps_its_say(rng):
    """Anything is any number of times as noisy as they; 0.1 mm is the least that is believed."""
    points, joint = plate_that_shakes(rng, 1e-5, noise=0.0)
    assert joint_noise(measure_shape(points, 0.003, 0.005), joint, 1e-6) < 2e-4
