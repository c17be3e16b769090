"""Edits of angles, and what follows from them."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.data import motion_from_parameters
from kinesphere.data.edits import Edit
from kinesphere.editing import apply_edits, edit_parameters, find_moves, moved_poses
from kinesphere.editing.weights import edit_weights
from kinesphere.errors import BadSetting
from kinesphere.geometry.rotations import rotation_about, rotation_angle
from kinesphere.parameterization import parameterize
from kinesphere.pipeline import solve
from kinesphere.synthetic import make_performance

EXACT = 1e-9
MEASURED = 2e-3  # m: noise-free joints whose axes are off by some hundredths of a degree


@pytest.fixture(scope="module")
def solution():
    true = make_performance(np.random.default_rng(3), rate=20.0, calibration_s=20.0, free_s=4.0)
    return solve(true.recording, true.model, calibration=true.calibration)


def edit(joint="left_elbow", axis=1, **told):
    return Edit(joint=joint, axis=axis, **told)


def test_an_elbow_bent_by_30_degrees_turns_its_hand_by_30_degrees(solution):
    bent = apply_edits(solution, [edit(add_deg=30.0, frames=(100, 200))])
    names = solution.skeleton.limb_names
    limb = names.index("left_forearm")
    inside = np.arange(99, 200)  # frames are numbered from 1
    turned = rotation_angle(
        bent.motion.rotations[:, limb] @ np.swapaxes(solution.motion.rotations[:, limb], -1, -2)
    )
    assert_allclose(np.rad2deg(turned[inside]), 30.0, atol=EXACT)
    outside = np.delete(np.arange(solution.motion.n_frames), inside)
    assert_array_equal(bent.motion.rotations[outside], solution.motion.rotations[outside])
    assert_array_equal(bent.recording.markers[outside], solution.recording.markers[outside])
    others = [i for i, name in enumerate(names) if name != "left_forearm"]
    assert_array_equal(bent.motion.origins[:, others], solution.motion.origins[:, others])


def test_the_joint_stays_where_it_is_and_markers_ride_along(solution):
    bent = apply_edits(solution, [edit("right_hip", 2, add_deg=-25.0, seconds=(1.0, 2.0))])
    before, after = solution.motion, bent.motion
    j = before.skeleton.joint_names.index("right_hip")
    assert_allclose(after.joint_centres()[:, j], before.joint_centres()[:, j], atol=EXACT)
    placed = before.marker_positions()
    moved = after.marker_positions()
    for label in before.skeleton.limbs[j + 1].markers:
        m = solution.recording.labels.index(label)
        off = solution.recording.markers[:, m] - placed[label]
        still = bent.recording.markers[:, m] - moved[label]
        # what the marker strays from its limb has the same length as before
        assert_allclose(np.linalg.norm(still, axis=1), np.linalg.norm(off, axis=1), atol=EXACT)
    shank = before.skeleton.limb_names.index("right_shank")
    assert np.abs(after.origins[30, shank] - before.origins[30, shank]).max() > 0.05


def test_edited_poses_have_the_edited_parameters(solution):
    edits = [
        edit("left_elbow", add_deg=15.0),
        edit("right_shoulder", 2, set_deg=20.0, seconds=(0.5, 3.0), blend_s=0.5),
        edit("left_hip", "twist", add_deg=-10.0, frames=(5, 300)),
    ]
    edited = apply_edits(solution, edits)
    again = parameterize(edited.motion, reuse=solution.skeleton)
    sound = (again.flags == 0) & (edited.parameters.flags == 0)
    wrapped = np.angle(np.exp(1j * (again.angles - edited.parameters.angles)))
    assert np.nanmax(np.abs(wrapped[sound])) < 1e-6
    assert np.nanmax(np.abs(again.twists - edited.parameters.twists)[sound]) < 1e-6


def test_undone_is_as_it_was(solution):
    there = apply_edits(solution, [edit(add_deg=40.0, frames=(50, 90), blend_s=0.4)])
    back = apply_edits(there, [edit(add_deg=-40.0, frames=(50, 90), blend_s=0.4)])
    assert_allclose(back.motion.rotations, solution.motion.rotations, atol=EXACT)
    assert_allclose(back.motion.origins, solution.motion.origins, atol=EXACT)
    assert_allclose(back.recording.markers, solution.recording.markers, atol=EXACT)
    assert [step.name for step in back.history[-2:]] == ["editing", "editing"]


def test_set_takes_the_shorter_way_and_angles_stay_half_open(solution):
    turned = apply_edits(solution, [edit(set_deg=179.0), edit(add_deg=2.0)])
    j = solution.skeleton.joint_names.index("left_elbow")
    assert_allclose(np.rad2deg(turned.parameters.angles[:, j, 0]), -179.0, atol=EXACT)


def test_what_is_not_seen_stays_so(solution):
    angles = np.array(solution.parameters.angles)
    j = solution.skeleton.joint_names.index("left_elbow")
    angles[10:20, j] = np.nan
    gappy = replace(solution, parameters=replace(solution.parameters, angles=angles))
    bent = apply_edits(gappy, [edit(add_deg=30.0)])
    assert np.isnan(bent.parameters.angles[10:20, j, 0]).all()
    limb = solution.skeleton.limb_names.index("left_forearm")
    assert_array_equal(bent.motion.rotations[10:20, limb], solution.motion.rotations[10:20, limb])
    assert np.isfinite(bent.motion.rotations).all()


def test_an_edit_that_changes_nothing_is_said(solution):
    angles = np.array(solution.parameters.angles)
    j = solution.skeleton.joint_names.index("left_elbow")
    angles[10:20, j] = np.nan
    gappy = replace(solution, parameters=replace(solution.parameters, angles=angles))
    hidden = edit(add_deg=30.0, frames=(gappy.parameters.first_frame + 10,) * 2)
    half = edit(add_deg=30.0, frames=(gappy.parameters.first_frame + 15,) * 2, blend_s=1.0)
    step = apply_edits(gappy, [half, hidden]).history[-1]
    said = [warning for warning in step.warnings if "changes nothing" in warning]
    assert said == ["edit 2 changes nothing: axis 1 of left_elbow is known in none of its frames"]
    whole = (np.flatnonzero(np.isfinite(angles[:, j, 0]))).size
    assert 0 < step.findings["frames"]["left_elbow"] < whole


def test_rebuilt_and_edited_agree(solution):
    """A motion that is nothing but its parameters is edited by its parameters alone."""
    rebuilt = replace(solution, motion=motion_from_parameters(solution.parameters))
    bent = apply_edits(rebuilt, [edit("neck", add_deg=12.0)])
    expected = motion_from_parameters(bent.parameters)
    assert_allclose(bent.motion.rotations, expected.rotations, atol=EXACT)
    assert_allclose(bent.motion.origins, expected.origins, atol=EXACT)


@pytest.mark.parametrize(
    ("told", "says"),
    [
        ({"joint": "tail", "add_deg": 1.0}, "edit 1: there is no joint 'tail'; the joints are"),
        ({"axis": 3, "add_deg": 1.0}, "left_elbow has no axis 3; it has 1 and 'twist'"),
        ({"add_deg": 1.0, "frames": (0, 5)}, r"frames \[0, 5\] lie outside the motion"),
        ({"add_deg": 1.0, "seconds": (0.0, 1e4)}, r"seconds \[0.0, 10000.0\] lie outside"),
    ],
)
def test_what_is_not_there_is_named(solution, told, says):
    with pytest.raises(BadSetting, match=says):
        apply_edits(solution, [edit(**told)])


def test_a_blend_begins_and_ends_without_a_jerk():
    blended = edit(add_deg=1.0, seconds=(2.0, 3.0), blend_s=1.0)
    weights = edit_weights(blended, 5001, 1000.0, 1)
    assert_array_equal(weights[2000:3001], 1.0)
    assert_array_equal(weights[:1001], 0.0)
    assert_array_equal(weights[4000:], 0.0)
    assert_allclose(weights[1500], 0.5)
    assert_allclose(weights, weights[::-1])
    speed = np.diff(weights) * 1000
    assert np.abs(np.diff(speed)).max() * 1000 < 6.0  # 1/s²; a straight ramp would jump by 1000
    assert (speed[:2000] >= 0).all()


def test_the_root_turns_in_its_place_and_takes_everything_along(solution):
    turned = apply_edits(solution, [edit("root", 2, add_deg=40.0, frames=(50, 90))])
    before, after = solution.motion, turned.motion
    inside = np.arange(49, 90)
    assert_allclose(after.origins[inside, 0], before.origins[inside, 0], atol=EXACT)
    own = np.swapaxes(before.rotations[inside, 0], -1, -2) @ after.rotations[inside, 0]
    assert_allclose(own, np.broadcast_to(rotation_about(np.eye(3)[1], np.deg2rad(40.0)), own.shape),
                    atol=EXACT)  # fmt: skip
    assert_allclose(after.relative_rotations(), before.relative_rotations(), atol=EXACT)
    assert_array_equal(turned.parameters.angles, solution.parameters.angles)
    outside = np.delete(np.arange(before.n_frames), inside)
    assert_array_equal(after.rotations[outside], before.rotations[outside])


def test_the_root_is_shifted_in_the_world(solution):
    told = [edit("root", "z", add_m=0.5), edit("root", "y", add_m=-0.1)]
    shifted = apply_edits(solution, told)
    by = np.array([0.0, -0.1, 0.5])
    assert_allclose(shifted.motion.origins, solution.motion.origins + by, atol=EXACT)
    assert_allclose(shifted.motion.rotations, solution.motion.rotations, atol=EXACT)
    worn = [i for i, label in enumerate(solution.recording.labels)
            if any(label in limb.markers for limb in solution.skeleton.limbs)]  # fmt: skip
    assert_allclose(
        shifted.recording.markers[:, worn], solution.recording.markers[:, worn] + by, atol=EXACT
    )
    assert shifted.history[-1].findings["frames"] == {"root": 2 * solution.motion.n_frames}


def test_moves_of_some_frames_are_those_of_all(solution):
    edits = [edit(add_deg=30.0, frames=(100, 200), blend_s=0.5), edit("root", 1, add_deg=5.0)]
    edited, _ = edit_parameters(solution.parameters, edits)
    whole = find_moves(solution.parameters, edited)
    frames = np.array([3, 99, 150, 205])
    some = find_moves(solution.parameters, edited, frames)
    assert_array_equal(some.turns, whole.turns[frames])
    assert_array_equal(some.shifts, whole.shifts[frames])
    for part, all_ in zip(
        moved_poses(solution.motion, some, frames), moved_poses(solution.motion, whole), strict=True
    ):
        assert_array_equal(part, all_[frames])
