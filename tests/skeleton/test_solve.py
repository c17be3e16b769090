"""Poses of the whole recording: the same in blocks as at once, by whatever is seen."""

import numpy as np
from numpy.testing import assert_array_equal

from kinesphere.data import JointModel
from kinesphere.geometry.rigid import fit_rigid, tells_pose
from kinesphere.geometry.rotations import rotation_about
from kinesphere.skeleton import SkeletonSettings, fit_skeleton, poses, sampling
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.lines import measure_line
from kinesphere.skeleton.tree import Tree
from kinesphere.synthetic import spoil_with_gaps

FRAMES = 41


def test_what_is_seen_tells_the_pose_where_a_fit_succeeds(rng):
    shape = np.array([[0.0, 0, 0], [0.1, 0, 0], [0.2, 0.001, 0], [0.1, 0.1, 0], [np.nan] * 3])
    points = np.where(np.isnan(shape), 1.0, shape) + rng.normal(size=(FRAMES, 1, 3))
    points[rng.random((FRAMES, 5)) < 0.4] = np.nan
    seen = np.isfinite(points).all(axis=2)
    told = tells_pose(shape, seen)
    assert_array_equal(told, fit_rigid(shape, points).fitted)
    assert 0 < told.sum() < FRAMES
    assert tells_pose(shape, np.ones((7, 5), dtype=bool)).tolist() == [True] * 7
    assert tells_pose(shape[:3], np.ones((7, 3), dtype=bool)).tolist() == [False] * 7


def test_blocks_leave_no_seams(bodies, rng, monkeypatch):
    recording = spoil_with_gaps(bodies.recording, rng, share=0.3)
    whole = fit_skeleton(recording, bodies.model)
    for module in (poses, sampling):
        monkeypatch.setattr(module, "BLOCK", 97)
    split = fit_skeleton(recording, bodies.model)
    assert_array_equal(split.flags, whole.flags)
    assert_array_equal(split.rotations, whole.rotations)
    assert_array_equal(split.residuals, whole.residuals)


def test_the_same_frames_are_measured_when_time_runs_backwards(rng):
    markers = np.cumsum(rng.normal(scale=0.01, size=(500, 4, 3)), axis=0)
    there = sampling.spread_frames(markers, 60)
    back = sampling.spread_frames(markers[::-1], 60)
    # the little of plain time and rounding of the sum may move a frame or two
    assert len(np.intersect1d(there, 499 - back)) >= len(there) - 2


def test_a_heel_lies_behind_its_ankle_and_the_toe_before_it(rng):
    """Heel, ankle and toe in one line: lengths are signed, or the heel would point ahead."""
    swing = rotation_about(np.array([0.0, 0.0, 1.0]), np.linspace(-0.4, 0.4, FRAMES))
    shank = Body("left_shank", None, ("k",), np.zeros((1, 3)), np.full(1, 1e-3))
    shank.rotations = np.tile(np.eye(3), (FRAMES, 1, 1))
    shank.shifts = rng.normal(size=(FRAMES, 3))
    ankle = shank.shifts - np.array([0.0, 0.4, 0.0])
    heel, toe = np.array([-0.05, 0.0, 0.0]), np.array([0.16, 0.0, 0.0])
    sample = {"HEE": ankle + swing @ heel, "TOE": ankle + swing @ toe}
    joint = JointModel("left_ankle", "left_shank", "left_foot")
    tree = Tree("left_shank", (joint,), {"left_shank": ("k",), "left_foot": ("HEE", "TOE")}, ())
    body = measure_line(joint, shank, tree, sample, ankle, SkeletonSettings())
    assert body.twist_open
    assert body.borrow is None
    assert body.centre is not None
    forward = body.shape[1] / np.linalg.norm(body.shape[1])
    np.testing.assert_allclose(body.shape @ forward, [-0.05, 0.16], atol=1e-12)
    assert body.noise.max() < 1e-12
    placed = body.shape @ np.swapaxes(body.rotations, 1, 2) + body.shifts[:, None]
    seen = np.stack([sample["HEE"], sample["TOE"]], axis=1)
    np.testing.assert_allclose(placed, seen, atol=1e-12)
