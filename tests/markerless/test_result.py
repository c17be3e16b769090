"""Tracked poses become a motion like any other: the rest of the line works on it unchanged."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.data import PoseFlag, Solution
from kinesphere.errors import DegenerateMotion
from kinesphere.io import read_solution, write_solution
from kinesphere.markerless import (
    motion_from_tracked,
    recording_of,
    tracking_step,
    with_first_frame,
)
from kinesphere.normalization import normalize
from kinesphere.parameterization import parameterize
from kinesphere.synthetic.film import make_film

FRAMES, CAMERAS = 90, 2


@pytest.fixture(scope="module")
def film():
    return make_film(2, "body", size=(32, 24), n_frames=FRAMES, n_cameras=CAMERAS)


@pytest.fixture(scope="module")
def tracked(film, tracked_film):
    return tracked_film(film)


def test_joint_centres_and_lengths_are_the_truth(film, tracked):
    motion = motion_from_tracked(tracked)
    truth = film.motion
    assert_allclose(motion.joint_centres(), truth.joint_centres[:, 1:], atol=1e-9)
    for limb in ("left_thigh", "right_forearm"):
        i = truth.surface.limbs.index(limb)
        length = np.linalg.norm(truth.ends[0, i] - truth.joint_centres[0, i])
        assert motion.skeleton.limb(limb).length == pytest.approx(length)
    assert (motion.flags == PoseFlag.MEASURED).all()
    assert max(joint.residual for joint in motion.skeleton.joints) < 1e-9
    assert motion.skeleton.joint("left_elbow").parent == "left_upper_arm"


def test_a_joint_that_slides_in_its_parent_says_by_how_much(tracked):
    i = tracked.limb_names.index("left_upper_arm")
    origins = tracked.origins.copy()
    origins[::2, i, 1] += 0.01
    origins[1::2, i, 1] -= 0.01
    motion = motion_from_tracked(replace(tracked, origins=origins))
    assert motion.skeleton.joint("left_shoulder").residual == pytest.approx(0.01, rel=1e-3)


def test_lost_limbs_and_frames_have_no_pose(tracked):
    lost, parameters = tracked.lost.copy(), tracked.parameters.copy()
    hand = tracked.limb_names.index("left_hand")
    lost[10:20, hand] = True
    parameters[40:43] = np.nan
    spoiled = replace(tracked, lost=lost, parameters=parameters)
    motion = motion_from_tracked(spoiled)
    assert (motion.flags[10:20, hand] == PoseFlag.UNSEEN).all()
    assert np.isnan(motion.rotations[10:20, hand]).all()
    assert (motion.flags[40:43] == PoseFlag.UNSEEN).all()
    assert (motion.flags != PoseFlag.UNSEEN).sum() == motion.flags.size - 10 - 3 * 15
    kept = motion_from_tracked(spoiled, keep_lost=True)
    assert (kept.flags[10:20, hand] == PoseFlag.FILLED).all()
    assert np.isfinite(kept.rotations[10:20, hand]).all()
    step = tracking_step(spoiled, ("a", "b"))
    assert step.findings["n_solved"] == FRAMES - 3
    assert step.findings["frames_lost_of_limb"]["left_hand"] == 10


def test_a_camera_that_sees_the_body_elsewhere_is_named(tracked):
    overlap = np.full((FRAMES, 4), 0.85)
    assert tracking_step(replace(tracked, overlap=overlap), tuple("abcd")).warnings == ()
    overlap[:, 2] = 0.5
    overlap[:5, 2] = np.nan
    (warning,) = tracking_step(replace(tracked, overlap=overlap), tuple("abcd")).warnings
    assert "0.50 in c, by 0.85 in the others" in warning


def test_nobody_found_is_an_error(tracked):
    with pytest.raises(DegenerateMotion, match="no frame has a pose"):
        motion_from_tracked(replace(tracked, parameters=np.full((FRAMES, 1), np.nan)))


def test_decoding_is_no_part_of_the_speed(tracked):
    step = tracking_step(tracked, ("a", "b"))
    assert step.findings["frames_per_s"] == pytest.approx(FRAMES / 2.0)
    assert step.findings["overlap_of_camera"] == {"a": pytest.approx(0.9), "b": pytest.approx(0.9)}


def test_the_rest_of_the_line_and_every_file_take_it(tmp_path, film, tracked):
    measured = with_first_frame(motion_from_tracked(tracked), replace(film.scene, first_frame=7))
    motion = normalize(measured)
    solution = Solution(
        recording=recording_of(film.scene, measured),
        motion=motion,
        parameters=parameterize(motion),
        model_name="markerless",
    )
    write_solution(solution, tmp_path / "out")
    back = read_solution(tmp_path / "out")
    assert back.recording.n_markers == 0
    assert back.motion.first_frame == 8
    assert_allclose(back.motion.joint_centres(), film.motion.joint_centres[:, 1:], atol=1e-6)
    # the elbow's axis is its own: the angle about it moves as the true one does
    knee = back.skeleton.joint_names.index("left_knee")
    found = back.parameters.angles[:, knee, 0]
    true = film.motion.angle_at("left_shank")
    assert_allclose(np.abs(found - found[0]), np.abs(true - true[0]), atol=np.radians(2))
