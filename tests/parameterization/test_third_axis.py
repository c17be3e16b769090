"""A third axis: where a limb turns about itself on purpose, and nowhere else."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.chain import joint_rotations
from kinesphere.geometry.rotations import rotation_angle, rotation_exp
from kinesphere.parameterization.anatomy import MIRROR
from kinesphere.parameterization.axes.kernels import turned_between
from kinesphere.parameterization.axes.twist_phases import (
    TwistAxis,
    find_twist_axis,
    twist_threshold,
)
from kinesphere.parameterization.confidence import TISSUE
from kinesphere.parameterization.joint_angles import solve_joint
from kinesphere.parameterization.settings import AxesSettings, ParameterizationSettings
from kinesphere.parameterization.speed_threshold import persistence_threshold, speed_threshold
from kinesphere.parameterization.third_axis import _serves, fit_axes
from kinesphere.parameterization.view import view_joint

RATE = 25.0
EXACT = 1e-9
SWAY = 0.1  # deg about every axis while nothing is done on purpose
CLOSE = 0.3  # deg, what that sway leaves of an axis
DEFAULTS = ParameterizationSettings()
FLEXION, ABDUCTION, LIMB = np.array([0.0, 0, 1]), np.array([1.0, 0, 0]), np.array([0.0, -1, 0])


def off_limb(degrees):
    """Return a line in the thigh, ``degrees`` off its long axis."""
    angle = np.deg2rad(degrees)
    return np.array([np.sin(angle), -np.cos(angle), 0.0])


TO_AND_FRO = np.sin(np.linspace(0, 2 * np.pi, 50))
TO_ONE_SIDE = np.sin(np.linspace(0, np.pi, 50)) ** 2


def move(rng, strokes, third, course=TO_AND_FRO, axes=(ABDUCTION, FLEXION)):
    """Return rotations, (n, 3, 3): two seconds of rest, then a stroke of 2 s, over and over.

    A stroke is deg about flexion, abduction and the third axis (fixed in the child), with a fourth
    number by which the limb is flexed all the while.
    """
    n = 50 + len(course)
    played = np.concatenate([np.zeros(50), course])
    angles = np.concatenate([played[:, None] * stroke[:3] for stroke in strokes])
    held = np.repeat([stroke[3] for stroke in strokes], n).astype(float)
    held = np.concatenate([np.repeat(held[0], 20), held[:-20]])  # it bends while it rests
    bell = np.hanning(21) / np.hanning(21).sum()
    change = np.convolve(np.pad(held, 10, mode="edge"), bell, mode="valid")
    angles = np.deg2rad(angles + SWAY * rng.normal(size=angles.shape))
    angles[:, 0] += np.deg2rad(change)
    turned = np.eye(3)
    for axis, angle in zip((third, *axes), angles.T[[2, 1, 0]], strict=True):
        turned = rotation_exp(angle[:, None] * axis) @ turned
    return turned


SWINGS = [(45, 0, 0, 0)] * 3 + [(0, 40, 0, 0)] * 3
THREE = [*SWINGS, *[(0, 0, 35, 0)] * 3]


def view(rotations, name="left_hip", limb=LIMB, known=None, settings=DEFAULTS, among=None):
    everywhere = np.ones(len(rotations), dtype=bool)
    known, among = (everywhere if mask is None else mask for mask in (known, among))
    return view_joint(name, rotations, limb, known, RATE, among, settings)


def off(axis, true):
    return np.rad2deg(np.arctan2(np.linalg.norm(np.cross(axis, true)), abs(axis @ true)))


@pytest.mark.parametrize("tilt", [0.0, 8.0])
def test_what_the_limb_turns_about_is_the_most_distal_axis(rng, tilt):
    seen = view(move(rng, THREE, off_limb(tilt)))
    fit = fit_axes(seen, DEFAULTS)
    assert fit.source == "movement"
    assert fit.axes.shape == (3, 3)
    for axis, true in zip(fit.axes, (off_limb(tilt), ABDUCTION, FLEXION), strict=True):
        assert off(axis, true) < CLOSE
    assert fit.findings["n_axes"] == fit.findings["n_axes_by_data"] == 3
    assert fit.findings["twist_axis_off_limb_deg"] == pytest.approx(tilt, abs=CLOSE)
    assert len(fit.findings["twist_phases_s"]) == 3
    for span, start in zip(fit.findings["twist_phases_s"], (26, 30, 34), strict=True):
        assert span == pytest.approx([start, start + 2], abs=0.3)
    every = fit.findings["phases_s"]  # what the report shades
    assert every == sorted(every)
    assert len(every) == 9
    assert all(span in every for span in fit.findings["twist_phases_s"])
    assert np.rad2deg(fit.uncertainty).max() < 5
    lists = ("ranges_deg", "conditioning", "halves_disagreement_deg", "axes_uncertainty_deg")
    assert [len(fit.findings[name]) for name in lists] == [3, 3, 3, 3]
    assert fit.findings["ranges_deg"][0] == pytest.approx(70, abs=8)  # ±35°, extremes left out


def test_three_axes_rebuild_every_pose_and_leave_no_twist(rng):
    seen = view(move(rng, THREE, off_limb(8.0)))
    fit = fit_axes(seen, DEFAULTS)
    solved = solve_joint(seen, fit.axes, fit.rest, DEFAULTS)
    rebuilt = joint_rotations(fit.axes, fit.rest, LIMB, solved.angles, solved.twists)
    assert_allclose(rebuilt, seen.rotations, atol=EXACT)
    assert_allclose(solved.twists, 0.0, atol=0)
    again = joint_rotations(fit.axes, fit.rest, LIMB, solved.angles, solved.twists)
    back = solve_joint(view(again), fit.axes, fit.rest, DEFAULTS)
    assert_allclose(back.angles, solved.angles, atol=EXACT)


def test_a_turn_about_the_third_axis_stays_out_of_the_other_two(rng):
    rotations = move(rng, THREE, off_limb(8.0))
    turning = np.arange(len(rotations)) >= round(24 * RATE)
    leaks = {}
    for counts in ("", "hip=2"):
        settings = ParameterizationSettings(axes=AxesSettings(counts=counts))
        seen = view(rotations, settings=settings)
        fit = fit_axes(seen, settings)
        angles = solve_joint(seen, fit.axes, fit.rest, settings).angles[turning]
        leaks[counts] = np.rad2deg(angles[:, len(fit.axes) - 2 : len(fit.axes)].std(axis=0).max())
    assert leaks[""] < 0.5
    assert leaks["hip=2"] > 2.0  # 8° · sin 35°, about the limb's own line


def test_it_is_fixed_in_the_child_whatever_the_posture(rng):
    bent = [(0, 0, 35, 0), (0, 0, 35, 30), (0, 0, 35, 60)]
    rotations = move(rng, [*SWINGS, *bent], off_limb(8.0))
    twist = find_twist_axis(view(rotations).samples, DEFAULTS)
    assert off(twist.axis, off_limb(8.0)) < CLOSE
    assert len(twist.phases) == 3


def test_postures_on_both_sides_of_a_gap_are_movements_of_their_own(rng):
    bent = [(0, 0, 35, 0), (0, 0, 35, 30), (0, 0, 35, 60)]
    rotations = move(rng, bent, off_limb(8.0))
    strokes = np.arange(len(rotations)) % 100 >= 48
    twist = find_twist_axis(view(rotations, among=strokes).samples, DEFAULTS)
    assert len(twist.phases) == 3
    assert off(twist.axis, off_limb(8.0)) < CLOSE


def test_small_turns_do_not_count(rng):
    twist = find_twist_axis(
        view(move(rng, [*SWINGS, *[(0, 0, 35, 0)] * 3, (0, 0, 5, 0)], off_limb(8.0))).samples,
        DEFAULTS,
    )
    assert len(twist.phases) == 3


def test_a_long_turn_weighs_as_much_as_it_lasts(rng):
    slow = np.sin(np.linspace(0, 20 * np.pi, 1000))
    short = move(rng, [(0, 0, 35, 0)] * 3, off_limb(4.0))
    long = move(rng, [(0, 0, 35, 0)], off_limb(12.0), course=slow)
    twist = find_twist_axis(view(np.concatenate([short, long])).samples, DEFAULTS)
    assert off(twist.axis, off_limb(0.0)) == pytest.approx((150 * 4 + 1000 * 12) / 1150, abs=0.3)


def test_how_well_the_axis_is_conditioned_and_known(rng):
    rotations = move(rng, [(0, 0, 35, 0)] * 4, LIMB)
    wobble = np.deg2rad(8.0) * np.cos(np.linspace(0, 2 * np.pi, 50))
    for start in range(50, len(rotations), 100):
        during = slice(start, start + 50)
        rotations[during] = rotation_exp(wobble[:, None] * FLEXION) @ rotations[during]
    twist = find_twist_axis(view(rotations).samples, DEFAULTS)
    assert twist.conditioning == pytest.approx(35 / 8, rel=0.1)
    told = TwistAxis(LIMB, (), np.deg2rad(30.0), 9.0, np.deg2rad(4.0))
    assert told.uncertainty == pytest.approx(np.hypot(np.deg2rad(2.0), TISSUE / np.deg2rad(30.0)))


def test_a_limb_that_wags_meanwhile_does_not_turn_about_itself_alone(rng):
    twice = np.sin(np.linspace(0, 4 * np.pi, 100))
    rotations = move(rng, [(0, 0, 35, 0)] * 4, LIMB, course=twice)
    plain = view(rotations.copy())
    assert find_twist_axis(plain.samples, DEFAULTS) is not None
    wag = np.deg2rad(15.0) * np.sin(np.linspace(0, 8 * np.pi, 100))
    for start in range(50, len(rotations), 150):
        during = slice(start, start + 100)
        rotations[during] = rotation_exp(wag[:, None] * FLEXION) @ rotations[during]
    assert find_twist_axis(view(rotations).samples, DEFAULTS) is None


def test_much_noise_hides_no_third_axis(rng, skin):
    rest = [(0, 0, 0, 0)] * 8
    for _ in range(4):
        rotations = move(rng, [*rest, *SWINGS, *[(0, 0, 40, 0)] * 4, *rest], off_limb(8.0))
        noise = skin(rng, len(rotations), RATE, 3.0)
        twist = find_twist_axis(view(rotation_exp(noise) @ rotations).samples, DEFAULTS)
        assert len(twist.phases) >= 3
        assert off(twist.axis, off_limb(8.0)) < 4.0


def test_a_frame_that_stands_still_parts_no_movement_from_rest(rng):
    """One slow frame among a thousand is the second peak of a histogram that has one."""
    speeds = np.deg2rad(40) * np.exp(0.6 * rng.normal(size=1000))
    slow = np.append(speeds, np.deg2rad(0.1))
    assert persistence_threshold(speeds) is None
    assert np.rad2deg(persistence_threshold(slow)) < 4
    settings = DEFAULTS.filter
    assert twist_threshold(slow, settings) == twist_threshold(speeds, settings)
    assert np.rad2deg(twist_threshold(slow, settings)) == pytest.approx(settings.fallback)


def test_a_shallow_valley_parts_them_where_there_is_no_deep_one(rng):
    two = [np.deg2rad(one) * np.exp(0.4 * rng.normal(size=1000)) for one in (14, 42)]
    speeds = np.concatenate(two)
    assert not speed_threshold(speeds, DEFAULTS.filter)[1]
    assert 18 < np.rad2deg(twist_threshold(speeds, DEFAULTS.filter)) < 36


def test_turns_to_one_side_do_not_move_the_zero(rng):
    strokes = [(0, 0, 70, 0)] * 8
    swings = move(rng, SWINGS, LIMB)
    turns = move(rng, strokes, LIMB, course=TO_ONE_SIDE)
    seen = view(np.concatenate([swings, turns]))
    fit = fit_axes(seen, DEFAULTS)
    assert len(fit.axes) == 3
    assert np.rad2deg(rotation_angle(fit.rest)) < 0.5  # it rested there, aligned with its parent


@pytest.mark.parametrize("far", [-160, 130, 160])
def test_far_turns_leave_the_other_angles_where_they_are(rng, far):
    slow = np.sin(np.linspace(0, np.pi, 75)) ** 2
    strokes = [(100, 0, 0, 0)] * 3 + [(0, 0, far, 90)] * 4  # bends, then pronates at a right angle
    seen = view(move(rng, strokes, off_limb(6.0), course=slow), "left_elbow")
    fit = fit_axes(seen, DEFAULTS)
    angles = np.rad2deg(solve_joint(seen, fit.axes, fit.rest, DEFAULTS).angles)
    assert angles.shape[1] == len(fit.axes) == 3
    assert np.abs(np.diff(angles, axis=0)).max() < 20
    assert np.abs(angles[:, 1]).max() < 5
    assert -5 < angles[:, 2].min() < angles[:, 2].max() < 105
    assert np.abs(angles[:, 0]).max() == pytest.approx(abs(far), abs=2)


def test_the_way_through_a_singular_pose_and_back_takes_no_leap(rng):
    n = 3000
    t = np.linspace(0, 1, n)
    true = np.deg2rad(
        np.column_stack(
            [30 * np.sin(40 * t), 130 * np.sin(np.pi * t) ** 2, 20 * np.cos(30 * t)],
        )
    )
    axes = np.array([LIMB, ABDUCTION, FLEXION])
    rotations = joint_rotations(axes, np.eye(3), LIMB, true, np.zeros(n))
    solved = solve_joint(view(rotations), axes, np.eye(3), DEFAULTS)
    assert_allclose(solved.angles, true, atol=1e-6)


def along_the_proximal_axis(rng, elevated):
    """Return rotations of two axes alone: swings, then turns about axis 2 by a raised limb."""
    t = np.arange(80 * 25) / 25
    angles = SWAY * rng.normal(size=(len(t), 2))
    for axis, start, reach in [
        *((0, 2 + 4 * k, 45) for k in range(4)),
        *((1, 18 + 4 * k, 40) for k in range(4)),
        *((1, 42 + 5 * k, 40) for k in range(4)),
    ]:
        during = (t >= start) & (t < start + 2.5)
        angles[during, axis] += reach * np.sin(2 * np.pi * (t[during] - start) / 2.5)
    angles[:, 0] += elevated * np.clip((t - 36) / 3, 0, 1) * np.clip((72 - t) / 3, 0, 1)
    first, second = np.deg2rad(angles.T)
    return rotation_exp(second[:, None] * np.eye(3)[1]) @ rotation_exp(
        first[:, None] * np.eye(3)[0]
    )


@pytest.mark.parametrize("elevated", [80, 85])
@pytest.mark.parametrize("noise", [0.0, 1.0, 3.0])
def test_a_limb_along_its_proximal_axis_turns_about_that(rng, skin, elevated, noise):
    rotations = along_the_proximal_axis(rng, elevated)
    rotations = rotation_exp(skin(rng, len(rotations), RATE, noise)) @ rotations
    seen = view(rotations, "joint_04", np.array([0.0, 0, -1]))
    assert find_twist_axis(seen.samples, DEFAULTS) is not None
    assert len(fit_axes(seen, DEFAULTS).axes) == 2


def test_turns_that_the_other_axes_explain_do_not_count_among_others(rng):
    raised = rotation_exp(np.deg2rad(88.0) * FLEXION) @ ABDUCTION  # where the distal axis is, then
    assert abs(raised @ LIMB) > 0.99
    rotations = move(rng, [*THREE, *[(0, 0, 35, 88)] * 3], off_limb(4.0))
    fit = fit_axes(view(rotations, "joint_04"), DEFAULTS)
    assert len(fit.findings["twist_phases_s"]) == 3
    assert off(fit.rest.T @ fit.axes[0], off_limb(4.0)) < CLOSE
    hip = fit_axes(view(rotations), DEFAULTS)  # a name says that flexion is the proximal axis
    assert len(hip.findings["twist_phases_s"]) == 6


def test_axes_out_of_reach_or_mostly_singular_are_no_three(rng):
    seen = view(move(rng, THREE, off_limb(8.0)))
    fit = fit_axes(seen, DEFAULTS)
    assert _serves(seen, fit, DEFAULTS)
    oblique = rotation_exp(np.deg2rad(60.0) * ABDUCTION) @ FLEXION
    third = rotation_exp(np.deg2rad(25.0) * FLEXION) @ oblique
    narrow = replace(fit, axes=np.array([third, oblique, FLEXION]))
    assert not _serves(seen, narrow, DEFAULTS)
    gimbal = replace(fit, axes=np.array([FLEXION, ABDUCTION, FLEXION]))
    assert not _serves(seen, gimbal, DEFAULTS)


def test_what_nothing_tells_about_the_limb_is_no_angle(rng):
    rotations = move(rng, THREE, off_limb(8.0))
    unknown = np.arange(len(rotations)) % 3 == 0
    spun = rotations.copy()
    spun[unknown] = rotations[unknown] @ rotation_exp(
        rng.uniform(-3, 3, unknown.sum())[:, None] * LIMB
    )
    told = view(rotations)
    fit = fit_axes(told, DEFAULTS)
    solved = solve_joint(view(spun, known=~unknown), fit.axes, fit.rest, DEFAULTS)
    assert_allclose(np.isnan(solved.angles[:, 0]), unknown)
    assert_allclose(np.isnan(solved.twists), unknown)
    assert np.isfinite(solved.angles[:, 1:]).all()
    rebuilt = joint_rotations(fit.axes, fit.rest, LIMB, solved.angles, solved.twists)
    reach = solved.excess < 1e-9
    assert reach.mean() > 0.9
    assert_allclose((rebuilt @ LIMB)[reach], (rotations @ LIMB)[reach], atol=EXACT)
    assert_allclose(rebuilt[~unknown], rotations[~unknown], atol=EXACT)


def test_two_axes_that_are_one_stay_two(rng):
    hinge = rotation_exp(np.deg2rad(28.0) * FLEXION) @ LIMB
    strokes = [(0, 80, 0, 0)] * 4 + [(0, 0, 35, 0)] * 3
    third = off_limb(10.0)  # 18° from the hinge
    seen = view(move(rng, strokes, third, axes=(hinge, FLEXION)), "joint_04")
    assert find_twist_axis(seen.samples, DEFAULTS) is not None
    assert len(fit_axes(seen, DEFAULTS).axes) == 1


@pytest.mark.parametrize(
    ("strokes", "tilt"),
    [
        (SWINGS, 0.0),
        ([*SWINGS, (0, 0, 35, 0)], 8.0),  # once for a moment: less than 2 s of it is above rest
        ([*SWINGS, *[(0, 0, 6, 0)] * 3], 8.0),  # 12° in all
        ([*SWINGS, *[(0, 0, 9, 0)] * 3], 8.0),  # too short an arc for an axis known to 5°
        ([*SWINGS, *[(0, 0, 35, 0)] * 3], 22.0),  # two joints turn together
        ([*SWINGS, *[(25, 0, 35, 0)] * 3], 8.0),  # it moves meanwhile
    ],
)
def test_nothing_else_is_a_third_axis(rng, strokes, tilt):
    seen = view(move(rng, strokes, off_limb(tilt)))
    if len(strokes) == 7:
        brief = np.ones(len(seen.rotations), dtype=bool)
        brief[-round(0.7 * RATE) :] = False
        seen = view(seen.rotations[brief])
    assert find_twist_axis(seen.samples, DEFAULTS) is None


def test_the_users_number_counts(rng):
    rotations = move(rng, THREE, off_limb(8.0))
    for counts, expected in (("hip=2", 2), ("left_hip=1", 1), ("knee=2", 3), ("hip=3", 3)):
        settings = ParameterizationSettings(axes=AxesSettings(counts=counts))
        assert len(fit_axes(view(rotations, settings=settings), settings).axes) == expected
    assert off(fit_axes(view(rotations), settings).axes[0], off_limb(8.0)) < CLOSE


def test_a_method_that_sees_positions_only_has_no_third_axis(rng):
    settings = ParameterizationSettings(axes=AxesSettings(method="direction-joining"))
    seen = view(move(rng, THREE, off_limb(8.0)), settings=settings)
    assert len(fit_axes(seen, settings).axes) == 2


def test_an_unknown_twist_tells_no_axis(rng):
    rotations = move(rng, THREE, off_limb(8.0))
    known = np.arange(len(rotations)) % 5 > 0
    assert len(fit_axes(view(rotations, known=known), DEFAULTS).axes) == 2
    few = np.arange(len(rotations)) % 20 > 0
    assert len(fit_axes(view(rotations, known=few), DEFAULTS).axes) == 3


def test_where_the_main_movements_are_missing_the_twist_stays_a_twist(rng):
    seen = view(move(rng, [(0, 0, 35, 0)] * 4, off_limb(8.0)))
    fit = fit_axes(seen, DEFAULTS)
    assert fit.source == "body"
    assert len(fit.axes) == 2


def test_a_hinge_that_turns_about_itself_gets_an_axis_across_both(rng):
    rotations = move(rng, [(-40, 0, 0, 50)] * 3 + [(0, 0, 35, 50)] * 3, off_limb(8.0))
    fit = fit_axes(view(rotations, "left_elbow"), DEFAULTS)
    assert len(fit.axes) == 3
    assert off(fit.axes[2], FLEXION) < CLOSE
    assert off(fit.rest.T @ fit.axes[0], off_limb(8.0)) < 2 * CLOSE
    assert_allclose(fit.axes[1] @ fit.axes[[0, 2]].T, 0.0, atol=EXACT)
    assert np.isnan(fit.uncertainty).tolist() == [False, True, False]
    assert fit.findings["n_axes_by_data"] == 2
    assert fit.findings["ranges_deg"][1] is None
    only = ParameterizationSettings(axes=AxesSettings(counts="elbow=1"))
    assert len(fit_axes(view(rotations, "left_elbow"), only).axes) == 1


def test_joints_nobody_named_have_one_too(rng):
    seen = view(move(rng, [*SWINGS, *[(0, 0, -35, 0)] * 3], off_limb(8.0)), "joint_04")
    fit = fit_axes(seen, DEFAULTS)
    assert len(fit.axes) == 3
    angles = solve_joint(seen, fit.axes, fit.rest, DEFAULTS).angles
    for column in angles.T:
        assert np.percentile(column, [5, 95]).sum() > 0


def test_frames_of_parent_and_child_do_not_matter(rng):
    rotations = move(rng, THREE, off_limb(8.0))
    plain = find_twist_axis(view(rotations).samples, DEFAULTS)
    parent, child = Rotation.random(2, rng=rng).as_matrix()
    turned = view(parent @ rotations @ child.T, "joint_04", child @ LIMB)
    found = find_twist_axis(turned.samples, DEFAULTS)
    assert_allclose(found.axis, child @ plain.axis, atol=1e-7)
    assert found.range == pytest.approx(plain.range, abs=1e-7)
    assert found.phases == plain.phases


def test_left_and_right_mirror_each_other(rng):
    rotations = move(rng, THREE, off_limb(8.0))
    left = fit_axes(view(rotations), DEFAULTS)
    right = fit_axes(view(MIRROR @ rotations @ MIRROR, "right_hip"), DEFAULTS)
    assert_allclose(right.axes, -left.axes @ MIRROR, atol=1e-7)


def test_gaps_and_short_recordings_are_survived(rng):
    rotations = move(rng, THREE, off_limb(8.0))
    rotations[round(30.5 * RATE) : round(32 * RATE)] = np.nan
    fit = fit_axes(view(rotations), DEFAULTS)
    assert off(fit.axes[0], off_limb(8.0)) < CLOSE
    for n in (0, 1, 2, 3):
        assert find_twist_axis(view(rotations[:n]).samples, DEFAULTS) is None


def test_how_far_something_turns_between_frames(rng):
    rotations = Rotation.random(7, rng=rng).as_matrix()
    rotations[5] = np.nan
    before, after = np.array([0, 1, 2, 3]), np.array([2, 1, 4, 5])
    turned = turned_between(rotations, before, after)
    expected = rotation_angle(np.swapaxes(rotations[before], -1, -2) @ rotations[after])
    assert_allclose(turned[:3], expected[:3], atol=1e-7)
    assert np.isnan(turned[3])
    assert turned[1] == 0


@pytest.mark.parametrize(
    ("name", "strokes", "told"),
    [
        ("left_knee", [(45, 0, 0, 0)] * 5, 1),
        ("left_hip", [(45, 0, 0, 0)] * 5, 1),
        ("left_hip", SWINGS, 2),
        ("joint_01", [(45, 0, 0, 0)] * 5, 1),
    ],
)
def test_who_asks_for_three_keeps_what_was_measured(rng, name, strokes, told):
    settings = ParameterizationSettings(axes=AxesSettings(counts=f"{name}=3"))
    joint = view(move(rng, strokes, LIMB), name, settings=settings)
    fit = fit_axes(joint, settings)
    assert fit.axes.shape == (3, 3)
    assert fit.source == "movement"
    assert fit.n_told == told
    assert fit.assumed == (True,) * (3 - told) + (False,) * told
    assert np.isnan(fit.uncertainty[: 3 - told]).all()
    assert np.isfinite(fit.uncertainty[3 - told :]).all()
    assert fit.findings["n_axes_by_data"] == told
    assert off(fit.axes[2], FLEXION) < CLOSE
    assert off(fit.axes[0], fit.rest @ LIMB) < EXACT
    if told == 2:
        assert off(fit.axes[1], ABDUCTION) < 2 * CLOSE
    solved = solve_joint(joint, fit.axes, fit.rest, settings)
    back = joint_rotations(fit.axes, fit.rest, LIMB, solved.angles, solved.twists)
    assert rotation_angle(np.swapaxes(back, -1, -2) @ joint.rotations).max() < EXACT


def test_three_of_a_limb_that_stands_are_the_bodys(rng):
    settings = ParameterizationSettings(axes=AxesSettings(counts="left_knee=3"))
    fit = fit_axes(
        view(move(rng, [(0, 0, 0, 0)] * 5, LIMB), "left_knee", settings=settings), settings
    )
    assert (fit.source, len(fit.axes)) == ("body", 3)
