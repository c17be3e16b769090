"""fit_skeleton against actors whose joint centres are known."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.data import Landmark, PoseFlag, Recording
from kinesphere.errors import BadRecording, DegenerateMotion, KinesphereError
from kinesphere.labelling import built_in_model
from kinesphere.skeleton import SkeletonSettings, fit_skeleton
from kinesphere.skeleton.landmarks import STEADY

EXACT = 1e-4  # m: 0.1 mm on noise-free recordings
NOISE = 1e-3  # m


def error_of(performance, motion):
    """Joint → largest distance in m of the centre, carried by both limbs, from the truth."""
    truth = {name: i for i, name in enumerate(performance.skeleton.joint_names)}
    errors = {}
    for joint in motion.skeleton.joints:
        if joint.name not in truth:
            continue
        true = performance.joint_centres[:, truth[joint.name]]
        for limb, centre in (
            (joint.parent, joint.centre_in_parent),
            (joint.child, joint.centre_in_child),
        ):
            i = motion.skeleton.limb_names.index(limb)
            carried = motion.rotations[:, i] @ centre + motion.origins[:, i]
            off = float(np.nanmax(np.linalg.norm(carried - true, axis=1)))
            errors[joint.name] = max(off, errors.get(joint.name, 0.0))
    return errors


def rebuilt_within(recording, motion):
    """Return the largest distance of a marker from where its limb's pose puts it, m."""
    placed = motion.marker_positions()
    return max(
        float(
            np.nanmax(
                np.linalg.norm(points - recording.markers[:, recording.labels.index(n)], axis=1)
            )
        )
        for n, points in placed.items()
    )


def changed(recording, markers):
    return replace(recording, markers=markers)


def hide(recording, frames, labels):
    markers = recording.markers.copy()
    markers[frames, np.array(recording.columns(labels))[:, None]] = np.nan
    return changed(recording, markers)


def test_marker_bodies_give_every_joint_centre(bodies, bodies_motion):
    motion = bodies_motion
    errors = error_of(bodies, motion)
    assert len(errors) == 11
    assert max(errors.values()) < EXACT
    assert rebuilt_within(bodies.recording, motion) < EXACT
    assert (motion.flags == PoseFlag.MEASURED).all()
    assert all(joint.observability in ("determined", "hinge") for joint in motion.skeleton.joints)


def test_sparse_markers_do_with_a_model_of_limbs_the_actor_lacks(cmu41, cmu41_motion):
    motion = cmu41_motion
    errors = error_of(cmu41, motion)
    assert len(errors) == 11
    assert max(errors.values()) < EXACT
    assert rebuilt_within(cmu41.recording, motion) < EXACT
    still = {joint.name for joint in motion.skeleton.joints if joint.range_of_motion < 1e-6}
    assert still == {"lumbar", "left_wrist", "right_wrist"}
    for name in still:
        joint = motion.skeleton.joint(name)
        assert joint.observability == "undetermined"
        assert joint.note.startswith("range of motion 0°, centre undetermined")
    assert motion.history[-1].warnings == (
        "the motion does not tell the centre of lumbar, left_wrist, right_wrist; "
        "it is where the model's landmarks expect it",
    )
    thigh = motion.skeleton.limb_names.index("left_thigh")
    assert (motion.flags[:, thigh] == PoseFlag.JOINT_AIDED).all()


def test_without_landmarks_no_model_is_said_to_expect_a_centre(cmu41):
    steady = Landmark({"RWRA": 0.5, "RWRB": 0.5}, spread=0.06, source=STEADY)
    of = {"trunk": (), "left_hand": (), "right_hand": (steady,)}
    model = built_in_model("cmu41")
    joints = tuple(replace(j, landmarks=of.get(j.child, j.landmarks)) for j in model.joints)
    motion = fit_skeleton(cmu41.recording, replace(model, joints=joints))
    told = [w for w in motion.history[-1].warnings if "does not tell the centre" in w]
    assert told == [
        "the motion does not tell the centre of lumbar, left_wrist; "
        "it is put midway between the markers of both limbs",
        "the motion does not tell the centre of right_wrist; "
        "it is put amid the markers that are steady in both limbs",
    ]


def test_lengths_are_those_of_the_actor(bodies, bodies_motion):
    motion = bodies_motion
    for side in ("left", "right"):
        true = {n: bodies.skeleton.joint(f"{side}_{n}") for n in ("hip", "knee", "ankle")}
        thigh = np.linalg.norm(true["hip"].centre_in_child - true["knee"].centre_in_parent)
        shank = np.linalg.norm(true["knee"].centre_in_child - true["ankle"].centre_in_parent)
        assert motion.skeleton.limb(f"{side}_thigh").length == pytest.approx(thigh, abs=EXACT)
        assert motion.skeleton.limb(f"{side}_shank").length == pytest.approx(shank, abs=EXACT)


def test_noise_of_a_millimetre_costs_millimetres_and_shows(cmu41, rng):
    noisy = cmu41.recording.markers + rng.normal(scale=NOISE, size=cmu41.recording.markers.shape)
    motion = fit_skeleton(changed(cmu41.recording, noisy), built_in_model("cmu41"))
    errors = error_of(cmu41, motion)
    sure = [j.name for j in motion.skeleton.joints if j.observability == "determined"]
    assert len(sure) >= 4
    assert max(errors[name] for name in sure if name in errors) < 20 * NOISE
    told = [j.residual for j in motion.skeleton.joints if np.isfinite(j.residual)]
    assert len(told) >= 4
    assert max(told) < 5 * NOISE
    assert min(told) > NOISE / 10


def test_what_is_put_at_its_joint_does_not_come_apart(cmu41):
    """A thigh of two markers is fitted to the hip: no distance between them says how well."""
    motion = fit_skeleton(cmu41.recording, built_in_model("cmu41"))
    owned = {limb.name: len(limb.markers) for limb in motion.skeleton.limbs}
    untold = {j.child for j in motion.skeleton.joints if np.isnan(j.residual)}
    assert untold
    assert {"left_thigh", "right_thigh"} <= untold
    assert untold == {limb for limb in owned if owned[limb] < 3} - {motion.skeleton.limbs[0].name}


def test_turning_and_moving_the_room_changes_nothing(cmu41, cmu41_motion):
    a = np.deg2rad(137.0)
    turn = np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])
    shift = np.array([3.0, 0.2, -7.0])
    model = built_in_model("cmu41")
    here = cmu41_motion
    there = fit_skeleton(changed(cmu41.recording, cmu41.recording.markers @ turn.T + shift), model)
    assert_allclose(there.joint_centres(), here.joint_centres() @ turn.T + shift, atol=1e-6)
    assert [j.observability for j in there.skeleton.joints] == [
        j.observability for j in here.skeleton.joints
    ]


def test_time_may_run_backwards_and_markers_stand_in_any_order(cmu41, cmu41_motion, rng):
    model = built_in_model("cmu41")
    here = cmu41_motion
    order = rng.permutation(cmu41.recording.n_markers)
    other = replace(
        cmu41.recording,
        markers=cmu41.recording.markers[::-1, order],
        labels=tuple(cmu41.recording.labels[i] for i in order),
    )
    there = fit_skeleton(other, model)
    assert_allclose(there.joint_centres()[::-1], here.joint_centres(), atol=1e-6)


def test_a_mirrored_person_has_mirrored_centres(cmu41):
    """What lies left comes to lie right, landmarks and directions included."""
    model = built_in_model("cmu41")
    partner = {a: b for pair in model.mirror for a, b in (pair, pair[::-1])}
    flip = np.array([1.0, 1.0, -1.0])
    still = cmu41.recording.markers[:40]  # no calibration: the landmarks have their say
    here = fit_skeleton(changed(cmu41.recording, still), model)
    there = fit_skeleton(
        replace(
            cmu41.recording,
            markers=still * flip,
            labels=tuple(partner.get(label, label) for label in cmu41.recording.labels),
        ),
        model,
    )
    names = here.skeleton.joint_names
    for i, name in enumerate(names):
        twin = name.replace("left", "?").replace("right", "left").replace("?", "right")
        mirrored = there.joint_centres()[:, names.index(twin)] * flip
        assert_allclose(mirrored, here.joint_centres()[:, i], atol=1e-4)


def test_a_person_who_stands_still_gets_centres_from_landmarks_and_is_told(cmu41, rng):
    standing = np.repeat(cmu41.recording.markers[:1], 60, axis=0)
    standing = standing + rng.normal(scale=1e-4, size=standing.shape)
    motion = fit_skeleton(changed(cmu41.recording, standing), built_in_model("cmu41"))
    for joint in motion.skeleton.joints:
        assert joint.observability == "undetermined"
        assert "centre undetermined" in joint.note
    assert motion.skeleton.joint("left_hip").note.count("Harrington") == 1
    errors = error_of(cmu41_at_start(cmu41, 60), motion)
    assert max(errors.values()) < 0.06  # landmarks are good to centimetres


def cmu41_at_start(performance, n):
    return replace(performance, joint_centres=np.repeat(performance.joint_centres[:1], n, axis=0))


def test_gaps_are_answered_with_what_is_left(cmu41):
    """One marker of two, a limb for a moment, for long between joints, for long at an end."""
    recording = hide(cmu41.recording, slice(100, 140), ("LKNE",))
    recording = hide(recording, slice(300, 305), ("RSHN", "RANK"))
    recording = hide(recording, slice(500, 600), ("RUPA", "RELB"))
    recording = hide(recording, slice(700, 800), ("LFHD", "RFHD", "LBHD", "RBHD"))
    motion = fit_skeleton(recording, built_in_model("cmu41"))
    at = motion.skeleton.limb_names.index
    thigh, shank, arm = (
        motion.flags[:, at(n)] for n in ("left_thigh", "right_shank", "right_upper_arm")
    )
    assert set(thigh[100:140]) <= {PoseFlag.JOINT_AIDED, PoseFlag.TWIST_UNKNOWN, PoseFlag.FILLED}
    assert (shank[300:305] == PoseFlag.FILLED).all()
    assert (arm[505:595] == PoseFlag.TWIST_UNKNOWN).all()
    assert (motion.flags[705:795, at("head")] == PoseFlag.UNSEEN).all()
    unseen = motion.flags == PoseFlag.UNSEEN
    assert np.isnan(motion.rotations[unseen]).all()
    assert np.isfinite(motion.rotations[~unseen]).all()
    assert np.isfinite(motion.origins[~unseen]).all()
    knee = motion.skeleton.joint_names.index("left_knee")
    truth = cmu41.joint_centres[:, cmu41.skeleton.joint_names.index("left_knee")]
    assert (
        np.linalg.norm(motion.joint_centres()[100:140, knee] - truth[100:140], axis=1).max() < 0.05
    )


def test_a_limb_without_markers_is_left_out_with_all_it_carries(cmu41):
    labels = ("LSHN", "LANK")
    motion = fit_skeleton(hide(cmu41.recording, slice(None), labels), built_in_model("cmu41"))
    assert not {"left_shank", "left_foot"} & set(motion.skeleton.limb_names)
    assert motion.history[-1].warnings[:2] == (
        "limb left_shank is left out: none of its markers (LSHN, LANK) is seen",
        "limb left_foot is left out: it hangs from left_shank, which is left out",
    )


def test_without_its_root_nothing_stands(cmu41):
    recording = hide(cmu41.recording, slice(None), ("LFWT", "RFWT"))
    with pytest.raises(BadRecording, match=r"pelvis of model cmu41 needs at least three.*LFWT"):
        fit_skeleton(recording, built_in_model("cmu41"))
    crossed = hide(cmu41.recording, slice(0, 500), ("LFWT", "RFWT"))
    crossed = hide(crossed, slice(500, None), ("LBWT", "RBWT"))
    with pytest.raises(DegenerateMotion, match="seen together off a line"):
        fit_skeleton(crossed, built_in_model("cmu41"))


def test_no_frames_is_said_and_one_frame_is_enough(cmu41):
    model = built_in_model("cmu41")
    with pytest.raises(BadRecording, match="no frames"):
        fit_skeleton(changed(cmu41.recording, cmu41.recording.markers[:0]), model)
    for n in (1, 2):
        motion = fit_skeleton(changed(cmu41.recording, cmu41.recording.markers[:n]), model)
        assert motion.n_frames == n
        assert np.isfinite(motion.joint_centres()).all()


def test_an_upper_arm_of_one_marker_borrows_its_twist_from_the_flexed_forearm(cmu41):
    recording = hide(cmu41.recording, slice(None), ("LUPA", "RUPA"))
    motion = fit_skeleton(recording, built_in_model("cmu41"))
    arm = motion.skeleton.limb_names.index("left_upper_arm")
    flags = motion.flags[:, arm]
    assert set(flags) <= {PoseFlag.TWIST_BORROWED, PoseFlag.TWIST_UNKNOWN}
    assert (flags == PoseFlag.TWIST_BORROWED).mean() > 0.3
    truth = cmu41.motion.rotations[:, cmu41.skeleton.limb_names.index("left_upper_arm")]
    lent = flags == PoseFlag.TWIST_BORROWED
    relative = np.swapaxes(truth[lent], 1, 2) @ motion.rotations[lent, arm]
    turned = np.einsum("nij,ij->n", relative, relative[0])
    spread = np.arccos(np.clip((turned - 1) / 2, -1, 1))
    assert np.median(spread) < np.deg2rad(25)  # the forearm's own freedom shows in the plane


def test_history_says_what_was_done(bodies):
    settings = SkeletonSettings(sample_frames=300)
    motion = fit_skeleton(bodies.recording, bodies.model, settings)
    step = motion.history[-1]
    assert step.name == "skeleton"
    assert step.settings["sample_frames"] == 300
    assert step.findings["frames_measured_on"] <= 300
    assert motion.history[:-1] == bodies.recording.history
    assert motion.skeleton.history == motion.history


def test_a_recording_that_knows_nothing_of_the_model_says_what_is_missing(cmu41):
    stranger = Recording(np.zeros((4, 2, 3)), ("A", "B"), rate=50.0)
    with pytest.raises(BadRecording, match="LFWT, RFWT, LBWT, RBWT; the recording shows none"):
        fit_skeleton(stranger, built_in_model("cmu41"))


def without(model, label):
    """Return the model, the marker gone from its limb."""
    segments = tuple(
        replace(segment, markers=tuple(m for m in segment.markers if m != label))
        for segment in model.segments
    )
    return replace(model, segments=segments, mirror=())


def test_a_marker_the_model_does_not_know_joins_the_limb_it_is_rigid_with(bodies):
    limb = next(s for s in bodies.model.segments if len(s.markers) > 3 and s.name != "trunk")
    stranger = limb.markers[-1]
    model = without(bodies.model, stranger)
    motion = fit_skeleton(bodies.recording, model)
    assert motion.history[-1].findings["adopted_markers"] == {stranger: limb.name}
    assert set(motion.skeleton.limb(limb.name).markers) == set(limb.markers)
    alone = fit_skeleton(bodies.recording, model, SkeletonSettings(adopt_markers=False))
    assert stranger not in alone.skeleton.limb(limb.name).markers


def test_nobody_adopts_a_marker_that_two_limbs_could_claim_or_none(cmu41, rng):
    """Pelvis and trunk of this actor are one piece; a wanderer belongs nowhere."""
    recording = replace(
        cmu41.recording,
        labels=(*cmu41.recording.labels, "WILD"),
        markers=np.concatenate(
            [cmu41.recording.markers, rng.normal(size=(cmu41.recording.n_frames, 1, 3))], axis=1
        ),
    )
    motion = fit_skeleton(recording, without(built_in_model("cmu41"), "T10"))
    assert motion.history[-1].findings["adopted_markers"] == {}


def test_a_root_of_two_markers_leans_on_the_joint_it_shares(cmu41, cmu41_motion):
    """Two waist markers and the lumbar joint, as the trunk carries it, make a pelvis."""
    gap = slice(100, 140)
    motion = fit_skeleton(hide(cmu41.recording, gap, ("LFWT", "RFWT")), built_in_model("cmu41"))
    assert (motion.flags[gap, 0] == PoseFlag.JOINT_AIDED).all()
    hips = [motion.skeleton.joint_names.index(f"{side}_hip") for side in ("left", "right")]
    off = motion.joint_centres()[gap][:, hips] - cmu41_motion.joint_centres()[gap][:, hips]
    assert np.abs(off).max() < EXACT


SPOILT = {
    "sparse": lambda x, r: np.where(r.random((*x.shape[:2], 1)) < 0.4, np.nan, x),
    "markers_gone": lambda x, r: np.where(r.random((1, x.shape[1], 1)) < 0.3, np.nan, x),
    "coincident": lambda x, _: x[:, np.minimum(np.arange(x.shape[1]), 30)],
    "ghosts": lambda x, r: x + 3.0 * (r.random((*x.shape[:2], 1)) < 0.02),
    "few_frames": lambda x, r: np.where(r.random((4, x.shape[1], 1)) < 0.2, np.nan, x[:4]),
    "far_away": lambda x, _: x + 1e3,
    "one_point": lambda x, _: np.repeat(x[:, :1], x.shape[1], axis=1),
}


@pytest.mark.parametrize("how", SPOILT)
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_bad_input_gives_a_clear_error_or_a_finite_flagged_result(cmu41, how, seed):
    markers = SPOILT[how](cmu41.recording.markers[::12], np.random.default_rng(seed))
    try:
        motion = fit_skeleton(changed(cmu41.recording, markers), built_in_model("cmu41"))
    except KinesphereError:
        assert how in ("sparse", "markers_gone", "few_frames", "one_point")
        return
    unseen = motion.flags == PoseFlag.UNSEEN
    assert np.isfinite(motion.rotations[~unseen]).all()
    assert np.isnan(motion.rotations[unseen]).all()
    for joint in motion.skeleton.joints:
        assert np.isfinite(joint.centre_in_parent).all()
