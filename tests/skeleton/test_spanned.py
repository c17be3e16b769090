"""A limb hidden between two joints, and its markers put back."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.data import PoseFlag
from kinesphere.skeleton import fill_markers, fit_skeleton

SHORT, LONG = slice(200, 206), slice(500, 560)  # 0.24 and 2.4 s at 25 Hz
NEAR = 0.005  # m; the joints of noise-free bodies are right to far less, the twist is carried over
FAR = 0.06  # m; in two seconds a thigh twists by tens of degrees


def hidden(recording, limb, frames):
    markers = np.array(recording.markers)
    rows = np.r_[frames]
    markers[np.ix_(rows, recording.columns(limb.markers))] = np.nan
    return replace(recording, markers=markers)


@pytest.fixture(scope="module")
def spoilt(bodies):
    """Return the recording without its left thigh, twice."""
    limb = bodies.skeleton.limb("left_thigh")
    return hidden(hidden(bodies.recording, limb, SHORT), limb, LONG)


@pytest.fixture(scope="module")
def motion(bodies, spoilt):
    """Return the motion measured without it."""
    return fit_skeleton(spoilt, bodies.model)


def test_the_joints_at_both_ends_place_it_and_the_flag_says_how(bodies, motion):
    thigh = motion.skeleton.limb_names.index("left_thigh")
    assert (motion.flags[SHORT, thigh] == PoseFlag.FILLED).all()
    assert (motion.flags[LONG, thigh] == PoseFlag.TWIST_UNKNOWN).all()
    for name in ("left_hip", "left_knee"):
        found = motion.joint_centres()[:, motion.skeleton.joint_names.index(name)]
        truth = bodies.joint_centres[:, bodies.skeleton.joint_names.index(name)]
        for frames in (SHORT, LONG):
            assert np.linalg.norm(found[frames] - truth[frames], axis=1).max() < NEAR


def test_poses_are_rotations_that_put_the_knee_on_the_thigh(motion):
    thigh = motion.skeleton.limb_names.index("left_thigh")
    rotations = motion.rotations[LONG, thigh]
    product = np.swapaxes(rotations, 1, 2) @ rotations
    assert np.abs(product - np.eye(3)).max() < 1e-9
    assert np.linalg.det(rotations).min() > 0


def test_hidden_markers_come_back_where_they_were(bodies, spoilt, motion):
    filled = fill_markers(spoilt, motion)
    columns = spoilt.columns(bodies.skeleton.limb("left_thigh").markers)
    for frames, limit in ((SHORT, NEAR), (LONG, FAR)):
        off = filled.markers[frames][:, columns] - bodies.recording.markers[frames][:, columns]
        assert np.linalg.norm(off, axis=2).max() < limit
    seen = spoilt.seen
    assert (filled.markers[seen] == spoilt.markers[seen]).all()
    step = filled.history[-1]
    assert step.findings["filled_samples"] == len(columns) * 66
    assert step.findings["without_the_limbs_own_pose"] == len(columns) * 66
    assert step.findings["still_missing"] == 0
    could = next(step.findings for step in motion.history if step.name == "skeleton")
    assert could["hidden_samples"] == len(columns) * 66
    n = sum(len(limb.markers) for limb in bodies.skeleton.limbs)
    assert could["hidden_share"] == round(len(columns) * 66 / (n * spoilt.n_frames), 3)
    assert "rest on a pose" in step.warnings[0]


def test_one_marker_of_a_body_comes_back_from_the_others(bodies):
    label = bodies.skeleton.limb("trunk").markers[0]
    markers = np.array(bodies.recording.markers)
    column = bodies.recording.labels.index(label)
    markers[100:400, column] = np.nan
    spoilt = replace(bodies.recording, markers=markers)
    filled = fill_markers(spoilt, fit_skeleton(spoilt, bodies.model))
    off = filled.markers[:, column] - bodies.recording.markers[:, column]
    assert np.linalg.norm(off, axis=1).max() < 1e-6
    assert filled.history[-1].warnings == ()


def test_the_end_of_a_chain_stays_unseen_for_long(bodies):
    foot = bodies.skeleton.limb("right_foot")
    motion = fit_skeleton(hidden(bodies.recording, foot, LONG), bodies.model)
    at = motion.skeleton.limb_names.index("right_foot")
    assert (motion.flags[LONG, at] == PoseFlag.UNSEEN).all()
    step = next(step for step in motion.history if step.name == "skeleton")
    assert step.findings["hidden_samples"] == 0  # nothing tells where they are
