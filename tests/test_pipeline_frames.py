"""Axes and rest positions in another recording's limb frames: limbs lie beside their markers."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.data import motion_from_parameters
from kinesphere.geometry.rotations import rotation_about
from kinesphere.normalization.propagation import move_skeleton
from kinesphere.parameterization import ParameterizationSettings, parameterize
from kinesphere.pipeline.best_axes import Calibrated, with_best_axes
from kinesphere.pipeline.frames_apart import FRAMES, turn_between
from kinesphere.pipeline.reuse import calibrated, parameterized
from kinesphere.synthetic import make_performance

TURN = np.deg2rad(12.0)


@pytest.fixture(scope="module")
def performance():
    return make_performance(np.random.default_rng(5), rate=12.0, free_s=0.0)


@pytest.fixture(scope="module")
def plain(performance):
    return measured(performance.skeleton)


def measured(skeleton):
    joints = (
        replace(j, axes_source="movement", axes_uncertainty=np.full(j.n_axes, 0.05))
        for j in skeleton.joints
    )
    return replace(skeleton, joints=tuple(joints))


def elsewhere(skeleton, seed=1):
    """Return the same body with every limb frame turned by 12° and moved."""
    rng = np.random.default_rng(seed)
    n = len(skeleton.limbs)
    about = rng.normal(size=(n, 3))
    about /= np.linalg.norm(about, axis=1, keepdims=True)
    turns = np.stack([rotation_about(axis, TURN) for axis in about])
    along = np.stack([limb.long_axis for limb in skeleton.limbs])
    lengths = np.array([limb.length for limb in skeleton.limbs])
    return move_skeleton(skeleton, turns, 0.05 * rng.normal(size=(n, 3)), along, lengths)


def with_limb(skeleton, name, **changes):
    limbs = (replace(one, **changes) if one.name == name else one for one in skeleton.limbs)
    return replace(skeleton, limbs=tuple(limbs))


def test_axes_and_rests_come_back_from_any_limb_frames(plain):
    there = elsewhere(plain)
    assert np.abs(there.joint("left_hip").axes - plain.joint("left_hip").axes).max() > 0.05
    bearing, said = with_best_axes(plain, calibrated(there))
    assert said == ()
    assert bearing.history[-1].findings["frames_by_name"] == {}
    for joint, wanted in zip(bearing.joints, plain.joints, strict=True):
        assert_allclose(joint.axes, wanted.axes, atol=1e-12)
        assert_allclose(joint.rest, wanted.rest, atol=1e-12)
        assert_allclose(joint.rest.T @ joint.rest, np.eye(3), atol=1e-14)
        assert_allclose(joint.axes_uncertainty, wanted.axes_uncertainty, atol=1e-9)


def test_several_recordings_each_in_frames_of_its_own(plain):
    """Also axes of two recordings that are put together come into the frames of the third."""

    def half(assumed, seed):
        joints = tuple(
            replace(j, axes_assumed=assumed) if j.n_axes == 2 else j for j in plain.joints
        )
        return elsewhere(replace(plain, joints=joints), seed)

    trials = {"one": half((False, True), 2), "other": half((True, False), 3)}
    bearing, _ = with_best_axes(plain, calibrated(trials))
    for joint, wanted in zip(bearing.joints, plain.joints, strict=True):
        if joint.n_axes == 2:
            assert joint.axes_reused_from == ("one", "other")
        assert_allclose(joint.axes, wanted.axes, atol=1e-12)
        assert_allclose(joint.rest, wanted.rest, atol=1e-12)


def test_angles_are_the_same_and_go_round(performance, plain):
    bearing, _ = with_best_axes(plain, calibrated(elsewhere(plain)))
    first = parameterize(performance.motion, reuse=plain)
    second = parameterize(performance.motion, reuse=bearing)
    assert_allclose(second.angles, first.angles, atol=1e-9)
    assert_allclose(second.twists, first.twists, atol=1e-9)
    back = parameterize(motion_from_parameters(second), reuse=bearing)
    assert_allclose(back.angles, second.angles, atol=1e-9)
    assert_allclose(back.twists, second.twists, atol=1e-9)


def test_the_same_solution_again_changes_nothing(plain):
    foot = plain.limb("left_foot")
    two = {"markers": foot.markers[:2], "marker_positions": foot.marker_positions[:2]}
    plain = with_limb(plain, "left_foot", **two)
    bearing, _ = with_best_axes(plain, calibrated(plain))
    assert bearing.history[-1].findings["frames_by_name"] == {}
    for joint, wanted in zip(bearing.joints, plain.joints, strict=True):
        assert_array_equal(joint.axes, wanted.axes)
        assert_array_equal(joint.rest, wanted.rest)
        assert_array_equal(joint.axes_uncertainty, wanted.axes_uncertainty)


def test_limbs_whose_markers_moved_go_by_their_frames_names(performance, plain):
    """One limb's markers were put on anew, one has two, one has them on a line."""
    there = elsewhere(plain)
    shank, foot, hand = (there.limb(n) for n in ("left_shank", "left_foot", "right_shank"))
    rng = np.random.default_rng(2)
    anew = shank.marker_positions + 0.05 * rng.normal(size=shank.marker_positions.shape)
    there = with_limb(there, "left_shank", marker_positions=anew)
    two = foot.markers[:2]
    there = with_limb(there, "left_foot", markers=two, marker_positions=foot.marker_positions[:2])
    line = np.outer(np.linspace(0, 0.3, len(hand.markers)), hand.long_axis)
    there = with_limb(there, "right_shank", marker_positions=line)
    bearing, _ = with_best_axes(plain, [Calibrated("range", there)])
    why = {
        "left_shank": "markers lie otherwise",
        "left_foot": "fewer than three markers in both",
        "right_shank": "markers on a line",
    }
    assert bearing.history[-1].findings["frames_by_name"] == {"range": why}
    ankle, told = bearing.joint("left_ankle"), there.joint("left_ankle")
    assert_array_equal(ankle.axes, told.axes)
    assert_array_equal(ankle.rest, told.rest)
    assert_allclose(ankle.axes_uncertainty, np.hypot(0.05, FRAMES))
    # the knee's parent is known, so its axis is; its rest is turned on the thigh's side alone
    knee, true = bearing.joint("left_knee"), plain.joint("left_knee")
    assert_allclose(knee.axes, true.axes, atol=1e-12)
    turn = turn_between(plain.limb("left_thigh"), there.limb("left_thigh")).rotation
    assert_allclose(knee.rest, turn @ there.joint("left_knee").rest, atol=1e-12)
    assert_allclose(bearing.joint("right_hip").rest, plain.joint("right_hip").rest, atol=1e-12)
    # and a user is told
    motion = replace(performance.motion, skeleton=plain)
    several = [Calibrated("range", there)]
    solved = parameterized(motion, ParameterizationSettings(), None, several)
    (warning,) = (w for s in solved.history if s.name == "calibration" for w in s.warnings)
    assert "frames of one name" in warning
    for limb, clause in why.items():
        assert f"{limb} ({clause})" in warning


@pytest.mark.parametrize(("off_mm", "n", "used"), [(1, 4, True), (3, 5, True), (30, 5, False)])
def test_a_turn_is_used_as_far_as_the_markers_tell_it(plain, off_mm, n, used):
    """Errors of the turn are as told: within three standard deviations but for one in ten."""
    rng = np.random.default_rng(off_mm)
    places = 0.06 * rng.normal(size=(n, 3))
    names = tuple(f"m{i}" for i in range(n))
    limb = replace(plain.limbs[0], markers=names, marker_positions=places)
    off = rotation_about(np.array([1.0, 2.0, 2.0]) / 3, TURN)
    errors, told = [], []
    for _ in range(200):
        noise = off_mm / 1e3 * rng.normal(size=(n, 3))
        turn = turn_between(limb, replace(limb, marker_positions=(places + noise) @ off))
        told.append(turn.unsure)
        assert (turn.why_named == "") == (turn.unsure < FRAMES)
        cosine = (np.trace(turn.rotation @ off.T) - 1) / 2
        errors.append(np.arccos(np.clip(cosine, -1.0, 1.0)))
    by_markers = np.array(told) < FRAMES
    assert (by_markers.mean() > 0.9) if used else (by_markers.mean() < 0.1)
    if used:
        beyond = np.array(errors)[by_markers] > 3 * np.sqrt(2) * np.array(told)[by_markers]
        assert beyond.mean() < 0.1
        assert np.median(errors) < FRAMES / 2
