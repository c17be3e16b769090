"""The whole stage on the synthetic actor, and on motion that tells nothing."""

import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from kinesphere.data import JointFlag, Motion, PoseFlag, Skeleton, motion_from_parameters
from kinesphere.errors import BadSetting
from kinesphere.geometry.rotations import rotation_about
from kinesphere.parameterization import (
    AngleSettings,
    AxesSettings,
    FilterSettings,
    ParameterizationSettings,
    RestSettings,
    TwistSettings,
    parameterize,
)
from kinesphere.parameterization.joint_flags import twists_known
from kinesphere.parameterization.reused import not_reused
from kinesphere.synthetic import make_performance

AXIS = 0.5  # deg, noise-free: what 0.2 deg of sway about the other axes leaves
MET = 2e-3  # m, a one-axis joint whose axis is off by some hundredths of a degree


@pytest.fixture(scope="module")
def performance():
    """Return a short calibration and some free motion: 25 Hz keeps it quick."""
    return make_performance(np.random.default_rng(7), rate=25.0, calibration_s=40.0, free_s=8.0)


@pytest.fixture(scope="module")
def solved(performance):
    return parameterize(performance.motion)


def axis_errors(found, true):
    sines = np.linalg.norm(np.cross(found.axes, true.axes), axis=1)
    return np.rad2deg(np.arctan2(sines, np.abs((found.axes * true.axes).sum(axis=1))))


def findings(parameters, joint):
    return parameters.history[-1].findings["joints"][joint]


def only(motion, names):
    """Return the motion of some limbs, root first."""
    at = [motion.skeleton.limb_names.index(name) for name in names]
    joints = tuple(j for j in motion.skeleton.joints if j.child in names)
    skeleton = Skeleton(tuple(motion.skeleton.limbs[i] for i in at), joints)
    return replace(
        motion,
        skeleton=skeleton,
        rotations=motion.rotations[:, at],
        origins=motion.origins[:, at],
        residuals=motion.residuals[:, at],
        flags=motion.flags[:, at],
    )


def cut(motion, frames):
    return replace(
        motion,
        rotations=motion.rotations[frames],
        origins=motion.origins[frames],
        residuals=motion.residuals[frames],
        flags=motion.flags[frames],
    )


def test_the_actors_axes_come_back(performance, solved):
    for joint in solved.skeleton.joints:
        true = performance.skeleton.joint(joint.name)
        assert joint.axes_source == "movement", joint.name
        assert joint.n_axes == true.n_axes
        assert axis_errors(joint, true).max() < AXIS, joint.name
        assert ((joint.axes * true.axes).sum(axis=1) > 0).all(), joint.name  # order and sign
        assert max(findings(solved, joint.name)["halves_disagreement_deg"]) < 3.0


def test_findings_are_in_the_order_of_the_axes(solved):
    for side in ("left", "right"):
        sideways, forward = findings(solved, f"{side}_shoulder")["ranges_deg"]
        assert forward > 1.5 * sideways  # flexion is proximal, and an arm swings higher forward
        joint = solved.skeleton.joint(f"{side}_shoulder")
        told = findings(solved, f"{side}_shoulder")
        halves, arcs = np.array(told["halves_disagreement_deg"]), np.array(told["ranges_deg"])
        skin = np.rad2deg(np.hypot(3.0 / arcs, 0.07))  # 3° of it over the arc, and its share
        same = np.hypot(told["alike_deg"], skin)
        assert_allclose(np.rad2deg(joint.axes_uncertainty), np.hypot(halves / 2, same))


def test_the_poses_come_back(performance, solved):
    rebuilt = motion_from_parameters(solved)
    assert np.abs(rebuilt.origins - performance.motion.origins).max() < MET
    assert np.nanmax(solved.residuals) < MET
    assert (solved.flags == 0).mean() > 0.95


def test_the_actors_angles_come_back_with_its_own_axes(performance):
    solved = parameterize(performance.motion, reuse=performance.skeleton)
    true = performance.parameters
    off = np.angle(np.exp(1j * (solved.angles - true.angles)))
    assert_array_equal(np.isnan(off), np.isnan(true.angles))
    sound = (solved.flags & JointFlag.SINGULAR) == 0
    assert np.nanmax(np.abs(off[sound])) < 1e-9
    assert np.abs(np.angle(np.exp(1j * (solved.twists - true.twists))))[sound].max() < 1e-9
    assert all(joint.axes_source == "reused" for joint in solved.skeleton.joints)


def test_a_window_holds_what_axes_come_from(performance):
    start, end = performance.calibration
    solved = parameterize(performance.motion, calibration=(start, end))
    assert solved.history[-1].settings["calibration_s"] == [start, end]
    for joint in solved.skeleton.joints:
        assert axis_errors(joint, performance.skeleton.joint(joint.name)).max() < AXIS
        assert all(b <= end + 0.1 for _, b in findings(solved, joint.name)["phases_s"])
    with pytest.raises(BadSetting, match=r"runs from 0 to 47\.96 s"):
        parameterize(performance.motion, calibration=(100.0, 120.0))


def test_every_joint_may_have_a_window_of_its_own(performance, solved):
    knee = findings(solved, "left_knee")["phases_s"]
    span = knee[0][0] - 1, knee[-1][1] + 1
    settings = ParameterizationSettings(
        axes=AxesSettings(windows=f"left_knee={span[0]}:{span[1]}, shoulder=0:1")
    )
    windowed = parameterize(performance.motion, settings)
    phases = findings(windowed, "left_knee")["phases_s"]
    assert span[0] <= phases[0][0] < phases[-1][1] <= span[1] + 0.1
    true = performance.skeleton.joint("left_knee")
    assert axis_errors(windowed.skeleton.joint("left_knee"), true).max() < AXIS
    sources = {j.name: j.axes_source for j in windowed.skeleton.joints}
    assert sources["left_shoulder"] == sources["right_shoulder"] == "body"  # it stands, there
    assert sources["left_hip"] == "movement"  # as before


def test_a_window_of_a_joint_that_is_not_there_is_refused(performance):
    with pytest.raises(BadSetting, match="names tail; the joints are"):
        parameterize(
            performance.motion, ParameterizationSettings(axes=AxesSettings(windows="tail=0:9"))
        )


@pytest.mark.parametrize("name", ["knee", "left_knee"])
def test_a_window_without_a_frame_says_whose_it_is(performance, name):
    settings = ParameterizationSettings(axes=AxesSettings(windows=f"{name}=50:99"))
    with pytest.raises(BadSetting, match=rf"^axes\.windows gives {name} 50–99 s; the recording"):
        parameterize(performance.motion, settings)
    with pytest.raises(BadSetting, match=r"^calibration is 50–99 s; the recording"):
        parameterize(performance.motion, calibration=(50.0, 99.0))


def test_frames_that_were_filled_wrongly_tell_no_axis(performance, rng):
    motion = performance.motion
    rotations, flags = np.array(motion.rotations), np.array(motion.flags)
    child = motion.skeleton.limb_names.index("left_shank")
    bad = rng.integers(0, motion.n_frames, 12)[:, None] + np.arange(8)
    bad = np.unique(np.minimum(bad, motion.n_frames - 1))
    rotations[bad, child] = rotations[bad, child] @ rotation_about(
        np.array([0.0, 0.6, 0.8]), np.array(0.9)
    )
    flags[bad, child] = PoseFlag.FILLED
    spoiled = parameterize(replace(motion, rotations=rotations, flags=flags))
    for name in ("left_knee", "left_ankle"):
        true = performance.skeleton.joint(name)
        assert axis_errors(spoiled.skeleton.joint(name), true).max() < AXIS


def test_free_motion_is_told_and_gets_body_axes(performance):
    start = performance.calibration[1]
    solved = parameterize(performance.motion, calibration=(start, start + 100))
    sources = {j.name: j.axes_source for j in solved.skeleton.joints}
    assert sources["left_hip"] == sources["right_shoulder"] == "body"
    assert_allclose(np.abs(solved.skeleton.joint("left_hip").axes), [[1, 0, 0], [0, 0, 1]])
    told = solved.history[-1].warnings[0]
    for name, source in sources.items():
        assert (name in told) == (source == "body")
    for name in ("left_knee", "right_elbow"):  # one axis shows in any motion, twist or not
        true = performance.skeleton.joint(name)
        assert axis_errors(solved.skeleton.joint(name), true).max() < AXIS


def test_a_hinge_less_certain_than_asked_for_has_the_body_axis(performance):
    start = performance.calibration[1]
    sources = {}
    for most in (0.0, 10.0):  # deg; two halves never agree to 0
        settings = ParameterizationSettings(axes=AxesSettings(largest_uncertainty=most))
        solved = parameterize(performance.motion, settings, calibration=(start, start + 100))
        sources[most] = solved.skeleton.joint("left_knee").axes_source
    assert sources == {0.0: "body", 10.0: "movement"}


def test_halves_that_differ_a_little_are_said_and_their_axes_kept(performance):
    start = performance.calibration[1]
    settings = ParameterizationSettings(axes=AxesSettings(largest_disagreement=0.0))
    solved = parameterize(performance.motion, settings, calibration=(start, start + 100))
    assert solved.skeleton.joint("left_knee").axes_source == "movement"
    said = [w for w in solved.history[-1].warnings if "halves of their movement" in w]
    [told] = [w for w in said if "usually farther off at such joints" in w]
    assert "left_knee (axes from two halves of the data differ by" in told
    assert "differ" in findings(solved, "left_knee")["doubts"][-1]


@pytest.mark.slow
def test_free_motion_without_twist_suits_the_universal_joint():
    performance = make_performance(
        np.random.default_rng(7), rate=25.0, calibration_s=0.0, free_s=20.0
    )
    told = performance.parameters
    untwisted = motion_from_parameters(replace(told, twists=0 * told.twists))
    motion = only(untwisted, ["trunk", "right_upper_arm", "left_thigh"])
    settings = ParameterizationSettings(axes=AxesSettings(method="universal-joint"))
    solved = parameterize(motion, settings)
    for joint in solved.skeleton.joints:
        assert joint.axes_source == "movement"
        # the proximal axis needs no reference orientation
        true = performance.skeleton.joint(joint.name).axes[1]
        assert np.rad2deg(np.arccos(min(1.0, abs(joint.axes[1] @ true)))) < AXIS
    assert_allclose(solved.twists, 0, atol=0.05)
    assert {j.axes_source for j in parameterize(motion).skeleton.joints} == {"body"}


def test_the_history_can_be_written(solved):
    step = solved.history[-1]
    assert step.name == "parameterization"
    assert json.loads(json.dumps(step.findings))["joints"]["left_hip"]["n_axes"] == 2
    assert step.settings["axes.method"] == "phase-log-pca"
    assert solved.skeleton.history[-1] is step


def test_the_papers_own_way_by_name(performance):
    settings = ParameterizationSettings(
        filter=FilterSettings(method="paper"),
        axes=AxesSettings(method="direction-joining", on_doubt="movement"),
        rest=RestSettings(method="paper"),
        twist=TwistSettings(method="sampled", step=5.0),
    )
    motion = only(performance.motion, ["trunk", "left_thigh", "left_shank"])
    solved = parameterize(motion, settings, calibration=performance.calibration)
    knee = solved.skeleton.joint("left_knee")
    assert axis_errors(knee, performance.skeleton.joint("left_knee")).max() < 15  # great circles
    rest = knee.rest
    relative = motion.relative_rotations()[:, 1]
    assert np.abs(relative - rest).max(axis=(1, 2)).min() == 0  # one sample of the recording
    assert np.isfinite(solved.twists).all()
    steps = np.rad2deg(solved.twists) / 5
    assert_allclose(steps, np.round(steps), atol=1e-9)


def test_angles_run_on_where_that_is_asked_for(performance):
    motion = only(performance.motion, ["trunk", "left_thigh"])
    turns = rotation_about(np.array([0.0, 0.0, 1.0]), np.linspace(0, 9 * np.pi, motion.n_frames))
    rotations = motion.rotations.copy()
    rotations[:, 1] = rotations[:, 0] @ turns
    motion = replace(motion, rotations=rotations)
    jumps, runs = (
        parameterize(motion, ParameterizationSettings(angles=chosen))
        for chosen in (AngleSettings(), AngleSettings(unwrap=True))
    )
    assert np.abs(jumps.angles[:, 0, :2]).max() <= np.pi
    ways = np.abs(np.ptp(runs.angles[:, 0, :2], axis=0))
    assert ways.max() == pytest.approx(9 * np.pi, abs=0.5)
    first, second = motion_from_parameters(jumps), motion_from_parameters(runs)
    assert_allclose(first.rotations, second.rotations, atol=1e-9)


def test_counts_are_followed(performance):
    settings = ParameterizationSettings(axes=AxesSettings(counts="left_hip=1, knee=3"))
    motion = only(performance.motion, ["trunk", "left_thigh", "left_shank"])
    solved = parameterize(motion, settings)
    assert solved.skeleton.joint("left_hip").n_axes == 1
    assert solved.skeleton.joint("left_knee").n_axes == 3
    assert np.isfinite(solved.angles[:, 1]).all()
    rebuilt = motion_from_parameters(solved)
    assert_allclose(rebuilt.rotations[:, 2], motion.rotations[:, 2], atol=1.5)  # hip is poorer now
    assert findings(solved, "left_hip")["n_axes_by_data"] == 2


def test_an_unnamed_joint_finds_its_number_of_axes(performance):
    motion = only(performance.motion, ["trunk", "left_thigh", "left_shank"])
    names = {"left_hip": "joint_01", "left_knee": "joint_02"}
    joints = tuple(replace(j, name=names[j.name]) for j in motion.skeleton.joints)
    motion = replace(motion, skeleton=replace(motion.skeleton, joints=joints))
    solved = parameterize(motion)
    assert [joint.n_axes for joint in solved.skeleton.joints] == [2, 1]
    for joint in solved.skeleton.joints:
        back = {new: old for old, new in names.items()}[joint.name]
        true = performance.skeleton.joint(back)
        cosines = np.abs(joint.axes @ true.axes.T).max(axis=1)
        assert np.rad2deg(np.arccos(np.minimum(cosines, 1))).max() < AXIS
    for column in np.rad2deg(solved.angles[:, 0, :2]).T:
        assert np.percentile(column, [5, 95]).sum() > 0  # the larger excursion


@pytest.mark.parametrize("n_frames", [0, 1, 2])
def test_hardly_any_frames_are_flagged_not_refused(performance, n_frames):
    solved = parameterize(cut(performance.motion, slice(0, n_frames)))
    assert solved.n_frames == n_frames
    assert {joint.axes_source for joint in solved.skeleton.joints} == {"body"}
    assert len(solved.history[-1].warnings) > 0
    assert np.isfinite(solved.angles[:, :, 0]).all()


def test_a_still_body_is_told(performance):
    motion = performance.motion
    still = np.zeros(60, dtype=int)
    solved = parameterize(cut(motion, still))
    assert not solved.moving.any()
    told = solved.history[-1].warnings[0]
    assert "hardly moves" in told
    assert "left_hip" in told
    rebuilt = motion_from_parameters(solved)
    assert_allclose(rebuilt.rotations[:, 0], motion.rotations[still, 0])


def test_a_limb_never_seen_stays_absent(performance):
    motion = performance.motion
    at = motion.skeleton.limb_names.index("left_shank")
    flags = motion.flags.copy()
    rotations, origins = motion.rotations.copy(), motion.origins.copy()
    flags[:, at], rotations[:, at], origins[:, at] = PoseFlag.UNSEEN, np.nan, np.nan
    solved = parameterize(replace(motion, rotations=rotations, origins=origins, flags=flags))
    knee = solved.skeleton.joint_names.index("left_knee")
    ankle = solved.skeleton.joint_names.index("left_ankle")
    assert np.isnan(solved.angles[:, [knee, ankle]]).all()
    assert (solved.flags[:, [knee, ankle]] == JointFlag.UNSEEN).all()
    assert "never seen" in solved.history[-1].warnings[0]
    assert findings(solved, "left_knee")["residual_mean_mm"] is None
    assert solved.skeleton.joint("right_knee").axes_source == "movement"


def test_a_twist_nobody_knows_is_absent_and_carried_outward(performance):
    motion = only(performance.motion, ["trunk", "left_upper_arm", "left_forearm"])
    rng = np.random.default_rng(3)
    flags, rotations = motion.flags.copy(), motion.rotations.copy()
    flags[:, 1] = PoseFlag.TWIST_UNKNOWN
    limb = motion.skeleton.limbs[1]
    spin = np.cumsum(rng.normal(0, 0.02, motion.n_frames))
    rotations[:, 1] = rotations[:, 1] @ rotation_about(limb.long_axis, spin)
    spun = replace(motion, rotations=rotations, flags=flags)
    solved = parameterize(spun)
    assert np.isnan(solved.twists[:, 0]).all()
    assert (solved.flags[:, 0] & JointFlag.TWIST_UNKNOWN).all()
    assert findings(solved, "left_shoulder")["axes_method"] == "small-circle"
    shoulder = solved.skeleton.joint("left_shoulder")
    assert axis_errors(shoulder, performance.skeleton.joint("left_shoulder")).max() < 2 * AXIS
    rebuilt = motion_from_parameters(solved)
    along = limb.long_axis
    assert_allclose(rebuilt.rotations[:, 1] @ along, rotations[:, 1] @ along, atol=1e-6)
    # the forearm is told in the frame that the table rebuilds, so it points where it did
    unknown = np.isfinite(solved.angles[:, 1, 0])
    far = np.linalg.norm((rebuilt.rotations - spun.rotations)[:, 2] @ along, axis=1)
    assert np.median(far[unknown]) < 0.4


def test_a_joint_torn_apart_for_a_moment_is_flagged(performance):
    motion = only(performance.motion, ["trunk", "left_thigh", "left_shank"])
    origins = motion.origins.copy()
    origins[100:104, 2] += [0, 0, 0.1]
    flags = parameterize(replace(motion, origins=origins)).flags
    torn = (flags[:, 1] & JointFlag.DISLOCATED) > 0
    assert_array_equal(np.flatnonzero(torn), [100, 101, 102, 103])


def test_what_was_filled_stays_marked(performance):
    motion = only(performance.motion, ["trunk", "left_thigh", "left_shank"])
    flags = motion.flags.copy()
    flags[5:9, 1] = PoseFlag.FILLED
    found = parameterize(replace(motion, flags=flags)).flags & JointFlag.FILLED
    assert_array_equal(np.flatnonzero(found[:, 0]), [5, 6, 7, 8])
    assert_array_equal(np.flatnonzero(found[:, 1]), [5, 6, 7, 8])


def test_what_was_filled_beside_a_guess_tells_no_twist_either(performance):
    motion = only(performance.motion, ["trunk", "left_thigh", "left_shank"])
    flags = motion.flags.copy()
    flags[5:9, 2] = PoseFlag.FILLED
    flags[20:30, 2] = PoseFlag.TWIST_UNKNOWN
    flags[24:27, 2] = PoseFlag.FILLED
    flags[30:33, 2] = PoseFlag.FILLED
    solved = parameterize(replace(motion, flags=flags))
    guessed = np.r_[20:33]
    assert_array_equal(np.flatnonzero(np.isnan(solved.twists[:, 1])), guessed)
    assert_array_equal(np.flatnonzero(solved.flags[:, 1] & JointFlag.TWIST_UNKNOWN), guessed)
    filled = np.r_[5:9, 24:27, 30:33]
    assert_array_equal(np.flatnonzero(solved.flags[:, 1] & JointFlag.FILLED), filled)


def test_a_twist_is_as_good_as_those_it_is_carried_over_from():
    """Against the rule said frame by frame, on flags at random."""
    rng = np.random.default_rng(8)
    flags = rng.choice([0, 1, 4, 5, 5, 5], (300, 4)).astype(np.uint8)
    known = twists_known(flags)
    for limb in range(4):
        course = flags[:, limb].tolist()
        for frame, flag in enumerate(course):
            ends = [flag]
            if flag == PoseFlag.FILLED:
                ends = [f for f in course[:frame][::-1] if f != PoseFlag.FILLED][:1]
                ends += [f for f in course[frame:] if f != PoseFlag.FILLED][:1]
            assert known[frame, limb] == (PoseFlag.TWIST_UNKNOWN not in ends)
    assert twists_known(flags[:0]).shape == (0, 4)


def test_gaps_change_nothing_elsewhere(performance):
    motion = only(performance.motion, ["trunk", "left_thigh", "left_shank"])
    rotations, flags = motion.rotations.copy(), motion.flags.copy()
    rotations[300:310, 2], flags[300:310, 2] = np.nan, PoseFlag.UNSEEN
    whole = parameterize(motion, reuse=performance.skeleton)
    gappy = parameterize(
        replace(motion, rotations=rotations, flags=flags), reuse=performance.skeleton
    )
    seen = np.ones(motion.n_frames, dtype=bool)
    seen[300:310] = False
    assert_array_equal(gappy.angles[seen], whole.angles[seen])
    assert np.isnan(gappy.angles[~seen, 1]).all()
    assert_array_equal(gappy.angles[~seen, 0], whole.angles[~seen, 0])


def test_axes_are_used_again_on_another_recording(performance, solved):
    free = slice(round(performance.calibration[1] * 25), None)
    again = parameterize(cut(performance.motion, free), reuse=solved.skeleton)
    for joint in again.skeleton.joints:
        before = solved.skeleton.joint(joint.name)
        assert joint.axes_source == "reused"
        assert_array_equal(joint.axes, before.axes)
        assert_array_equal(joint.rest, before.rest)
        assert_array_equal(joint.axes_uncertainty, before.axes_uncertainty)
    assert_allclose(again.angles, solved.angles[free], atol=1e-12)


def test_axes_of_a_stranger_with_other_joints_are_no_help(performance):
    motion = only(performance.motion, ["trunk", "left_thigh"])
    stranger = only(performance.motion, ["trunk", "right_thigh"]).skeleton
    solved = parameterize(motion, reuse=stranger)
    assert "no recording to be reused measured axes of left_hip" in solved.history[-1].warnings[-1]
    assert solved.skeleton.joints[0].axes_source == "movement"


def test_it_is_told_what_nobody_measured_and_what_is_known_better_here(performance):
    skeleton = performance.skeleton
    measured = replace(skeleton.joint("left_hip"), axes_source="movement")
    assumed = replace(skeleton.joint("left_knee"), axes_source="body")
    reuse = Skeleton(
        skeleton.limbs,
        tuple({"left_hip": measured, "left_knee": assumed}.get(j.name, j) for j in skeleton.joints),
    )
    assert not_reused(["left_hip", "left_knee", "tail"], reuse) == (
        "no recording to be reused measured axes of left_knee, tail; theirs are from here",
        "more axes of left_hip are told here than to be reused; they are from here",
    )
    assert not_reused([], reuse) == not_reused(["left_hip"], None) == ()


def test_a_body_without_joints_has_no_parameters_but_a_root(performance):
    solved = parameterize(only(performance.motion, ["trunk"]))
    assert solved.angles.shape == (performance.motion.n_frames, 0, 3)
    assert_array_equal(solved.root_positions, performance.motion.origins[:, 0])
    assert solved.history[-1].warnings == ()


def test_twelve_frames_a_second_are_enough(performance):
    slow = make_performance(np.random.default_rng(5), rate=12.0, calibration_s=40.0, free_s=0.0)
    motion: Motion = only(slow.motion, ["trunk", "left_thigh", "left_shank", "left_foot"])
    solved = parameterize(motion)
    for joint in solved.skeleton.joints:
        assert joint.axes_source == "movement"
        assert axis_errors(joint, slow.skeleton.joint(joint.name)).max() < 2 * AXIS


def test_a_window_that_ends_on_frames_gives_the_same_axes_from_either_end_of_time():
    play = make_performance(np.random.default_rng(5), rate=12.0, calibration_s=18.0, free_s=0.0)
    ahead: Motion = only(play.motion, ["trunk", "left_thigh", "left_shank", "left_foot"])
    back = cut(ahead, slice(None, None, -1))
    last = (ahead.n_frames - 1) / ahead.rate
    first = parameterize(ahead, calibration=(2.5, 11.25)).skeleton.joints
    second = parameterize(back, calibration=(last - 11.25, last - 2.5)).skeleton.joints
    for one, other in zip(first, second, strict=True):
        assert one.axes_source == other.axes_source
        assert_allclose(np.abs((one.axes * other.axes).sum(axis=1)), 1.0, atol=1e-9)
        assert_allclose(one.rest, other.rest, atol=1e-4)


def test_axes_that_were_only_assumed_are_not_reused(performance):
    joints = tuple(
        replace(joint, axes_source="body") if joint.name == "left_knee" else joint
        for joint in performance.skeleton.joints
    )
    reuse = Skeleton(performance.skeleton.limbs, joints)
    solved = parameterize(performance.motion, reuse=reuse)
    assert solved.skeleton.joint("left_knee").axes_source == "movement"
    assert solved.skeleton.joint("right_knee").axes_source == "reused"
    assert any(
        "no recording to be reused measured axes of left_knee" in w
        for w in solved.history[-1].warnings
    )


def doubtful(solved, joint, *doubts):
    """Return a solved skeleton whose history doubts the axes of one joint."""
    step = solved.history[-1]
    told = {name: dict(found) for name, found in step.findings["joints"].items()}
    told[joint]["doubts"] = list(doubts)
    return replace(
        solved.skeleton, history=(*solved.history[:-1], replace(step, findings={"joints": told}))
    )


def test_doubts_about_reused_axes_stay_doubts(performance, solved):
    """Where nothing moves there is nothing better."""
    reuse = doubtful(solved, "left_knee", "the moon was full")
    still = cut(performance.motion, slice(20))
    again = parameterize(still, reuse=reuse, give_way=True)
    found, before = findings(again, "left_knee"), findings(solved, "left_knee")
    assert found["doubts"] == ["the moon was full"]
    assert found["halves_disagreement_deg"] == before["halves_disagreement_deg"]
    assert "phases_s" not in found  # those were seconds of another recording
    assert any(
        "doubtful where they come from: " in w and "left_knee (the moon was full)" in w
        for w in again.history[-1].warnings
    )
    assert not any("do not fit" in w for w in again.history[-1].warnings)
    thrice = parameterize(still, reuse=again.skeleton)
    assert findings(thrice, "left_knee")["doubts"] == ["the moon was full"]


@pytest.mark.parametrize("remark", ["", "a cloud passed"])
def test_what_is_doubted_of_an_axis_that_is_not_reused_is_not_told(performance, solved, remark):
    """The doubts are those of the axis that another, put across, replaces."""
    reuse = doubtful(solved, "left_hip", "the moon was full", *([remark] if remark else []))
    reuse.history[-1].findings["joints"]["left_hip"]["remark"] = remark or None
    half = tuple(
        replace(j, axes_assumed=(True, False)) if j.name == "left_hip" else j for j in reuse.joints
    )
    again = parameterize(
        cut(performance.motion, slice(20)), reuse=replace(reuse, joints=half), give_way=True
    )
    assert again.skeleton.joint("left_hip").axes_sources == ("body", "reused")
    told = [w for w in again.history[-1].warnings if "doubtful where they come from" in w]
    said = "reused axes are doubtful where they come from: left_hip (axis 2: a cloud passed)"
    assert told == ([said] if remark else [])


def test_doubtful_axes_give_way_to_what_is_told_without_doubt(performance, solved):
    """The truth: 30° beside it at the knee that is doubted, and nothing but that knee changes."""
    reuse = doubtful(solved, "left_knee", "the moon was full")
    askew = rotation_about(np.array([0.0, 1.0, 0.0]), np.deg2rad(30.0))
    joints = tuple(
        replace(joint, axes=joint.axes @ askew.T) if joint.name == "left_knee" else joint
        for joint in reuse.joints
    )
    asked = replace(reuse, joints=joints)
    again = parameterize(performance.motion, reuse=asked, give_way=True)
    for joint in again.skeleton.joints:
        own = joint.name == "left_knee"
        assert joint.axes_source == ("movement" if own else "reused")
        assert_allclose(joint.axes, solved.skeleton.joint(joint.name).axes, atol=1e-12)
    (said,) = (w for w in again.history[-1].warnings if "give way" in w)
    assert "left_knee (doubtful where they come from" in said
    assert "left_knee" not in "".join(w for w in again.history[-1].warnings if w != said)
    assert "doubtful where" in findings(again, "left_knee")["not_reused"]
    kept = parameterize(performance.motion, reuse=asked)  # whoever asks for these has them
    assert {joint.axes_source for joint in kept.skeleton.joints} == {"reused"}


def turned_off(skeleton, radians, *names):
    wrong = Rotation.from_rotvec([radians, 0.0, 0.0]).as_matrix()
    joints = tuple(
        replace(joint, rest=wrong @ joint.rest, axes=joint.axes @ wrong)
        if joint.name in names
        else joint
        for joint in skeleton.joints
    )
    return Skeleton(skeleton.limbs, joints)


def test_reused_axes_that_do_not_fit_are_named(performance):
    """Of the functional trial that somebody chose they serve all the same, as long as it can be."""
    reuse = turned_off(performance.skeleton, 0.15, "left_knee", "left_hip")
    solved = parameterize(performance.motion, reuse=reuse, give_way=True)
    told = solved.history[-1].warnings
    (misfit,) = (w for w in told if "do not fit this recording" in w)
    assert "left_knee (out of their reach in " in misfit
    assert "right_knee" not in misfit
    assert solved.skeleton.joint("left_knee").axes_source == "reused"


def test_undoubted_axes_give_way_where_they_ruin_a_joint(performance, solved):
    reuse = turned_off(performance.skeleton, 0.6, "left_knee")
    again = parameterize(performance.motion, reuse=reuse, give_way=True)
    (said,) = (w for w in again.history[-1].warnings if "give way" in w)
    assert "left_knee (out of their reach in " in said
    assert "right_knee" not in said
    knee = again.skeleton.joint("left_knee")
    assert knee.axes_source == "movement"
    assert_allclose(knee.axes, solved.skeleton.joint("left_knee").axes, atol=1e-12)
    assert again.skeleton.joint("right_knee").axes_source == "reused"


def wobbling(motion, degrees):
    """Return the motion with the left shank and foot moved to and fro across the knee's axis."""
    joint = motion.skeleton.joint("left_knee")
    shank = motion.skeleton.limb_names.index("left_shank")
    foot = motion.skeleton.limb_names.index("left_foot")
    times = np.arange(motion.n_frames) / motion.rate
    by = Rotation.from_rotvec(
        np.deg2rad(degrees) * np.sin(40.0 * times)[:, None] * np.array([1.0, 0.0, 0.0])
    ).as_matrix()
    before = motion.rotations[:, shank]
    across = before @ by @ np.swapaxes(before, -1, -2)
    knee = motion.origins[:, shank] + before @ joint.centre_in_child
    rotations, origins = motion.rotations.copy(), motion.origins.copy()
    for limb in (shank, foot):
        rotations[:, limb] = across @ rotations[:, limb]
        arm = (origins[:, limb] - knee)[..., None]
        origins[:, limb] = knee + (across @ arm)[..., 0]
    return replace(motion, rotations=rotations, origins=origins)


@pytest.mark.parametrize(("degrees", "gives_way"), [(3.0, True), (12.0, False)])
def test_own_axes_serve_where_the_limb_stays_near_them(performance, degrees, gives_way):
    """A real knee is out of a hinge's 2° in many frames, and still far nearer its own than 34°."""
    reuse = turned_off(performance.skeleton, 0.6, "left_knee")
    motion = wobbling(performance.motion, degrees)
    own = parameterize(motion)
    assert findings(own, "left_knee")["unreachable"] > 0.3
    again = parameterize(motion, reuse=reuse, give_way=True)
    told = "".join(again.history[-1].warnings)
    assert ("give way" in told) == gives_way
    assert ("reused axes do not fit this recording" in told) == (not gives_way)
    knee = again.skeleton.joint("left_knee")
    assert knee.axes_source == ("movement" if gives_way else "reused")


def test_what_does_not_apply_is_said(performance):
    options = AxesSettings(windows="left_knee=0:1000", counts="right_knee=2")
    settings = ParameterizationSettings(axes=options)
    told = parameterize(performance.motion, settings, reuse=performance.skeleton).history[-1]
    assert any("say nothing about axes that are reused" in w for w in told.warnings)
    assert any("window of left_knee, 0:1000 s, reaches beyond" in w for w in told.warnings)


def test_a_count_of_a_joint_that_is_not_there_is_refused(performance):
    settings = ParameterizationSettings(axes=AxesSettings(counts="tail=2"))
    with pytest.raises(BadSetting, match="counts names tail; the joints are"):
        parameterize(performance.motion, settings)
