"""Edited poses on demand: those of the whole edit, frame by frame."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.data import motion_from_parameters
from kinesphere.data.edits import Edit
from kinesphere.editing import apply_edits
from kinesphere.errors import BadSetting
from kinesphere.geometry.rotations import rotation_about
from kinesphere.viewer import EditedPoses
from kinesphere.viewer.poses import turning_axes

EXACT = 1e-12
EDITS = (
    Edit(joint="right_shoulder", axis=2, add_deg=40.0, frames=(20, 60), blend_s=0.5),
    Edit(joint="left_elbow", axis="twist", add_deg=-15.0),
    Edit(joint="root", axis=2, add_deg=25.0, frames=(30, 90)),
    Edit(joint="root", axis="x", add_m=0.3, seconds=(1.0, 2.0), blend_s=0.4),
)


@pytest.mark.parametrize("frames", ["one by one", "ahead"])
def test_they_are_those_of_the_whole_edit(gappy, frames):
    whole = apply_edits(gappy, EDITS)
    poses = EditedPoses(gappy, EDITS)
    for frame in range(gappy.motion.n_frames):
        if frames == "ahead":
            poses.prepare(frame)
        rotations, origins, markers = poses.at(frame)
        assert_allclose(rotations, whole.motion.rotations[frame], atol=EXACT)
        assert_allclose(origins, whole.motion.origins[frame], atol=EXACT)
        assert_allclose(markers, whole.recording.markers[frame], atol=EXACT)
    assert_array_equal(poses.parameters.angles, whole.parameters.angles)


def test_other_edits_start_from_what_was_measured(solution):
    poses = EditedPoses(solution, EDITS)
    poses.at(40)
    poses.edit(())
    assert_array_equal(poses.at(40)[0], solution.motion.rotations[40])
    assert_array_equal(poses.at(40)[2], solution.recording.markers[40])


def test_an_edit_that_means_nothing_is_refused_and_the_poses_stay(solution):
    poses = EditedPoses(solution, EDITS[:1])
    before = np.array(poses.at(40)[0])
    with pytest.raises(BadSetting, match="there is no joint 'tail'"):
        poses.edit((Edit(joint="tail", axis=1, add_deg=1.0),))
    assert_array_equal(poses.at(40)[0], before)


@pytest.mark.parametrize("name", ["left_knee", "right_hip", "left_shoulder"])
def test_a_limb_turns_about_the_axes_it_is_said_to_turn_about(solution, name):
    j = solution.skeleton.joint_names.index(name)
    frame, angle = 33, np.deg2rad(9.0)
    axes = turning_axes(solution.parameters, j, frame)
    n_axes = solution.skeleton.joints[j].n_axes
    assert len(axes) == n_axes + 1
    assert_allclose(np.linalg.norm(axes, axis=1), 1.0, atol=EXACT)
    before = motion_from_parameters(solution.parameters).relative_rotations()[frame, j]
    for k, axis in enumerate(axes):
        number = k + 1 if k < n_axes else "twist"
        edit = Edit(joint=name, axis=number, add_deg=9.0)
        after = motion_from_parameters(apply_edits(solution, [edit]).parameters)
        turned = after.relative_rotations()[frame, j]
        assert_allclose(turned, rotation_about(axis, np.array(angle)) @ before, atol=1e-9)
