"""The comparison finds nothing where nothing is wrong, and what is wrong where something is."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.data import Solution, motion_from_parameters
from kinesphere.errors import BadRecording
from kinesphere.geometry.rotations import rotation_about
from kinesphere.synthetic import (
    compare_with_truth,
    make_performance,
    spoil_with_swaps,
    worst_rows,
)
from kinesphere.synthetic.retelling import angles_about_axes

ROUNDING = 1e-6  # mm and deg


@pytest.fixture(scope="module")
def performance():
    return make_performance(np.random.default_rng(13), rate=20, calibration_s=15, free_s=5)


def solved(performance, **changed):
    """Return the truth as if it had been solved, with some of its parameters changed."""
    parameters = replace(performance.parameters, **changed)
    motion = motion_from_parameters(parameters)
    return Solution(performance.recording, motion, parameters, performance.model.name)


def with_joint(performance, name, **changed):
    """Return the true skeleton but for one joint."""
    joints = tuple(
        replace(joint, **changed) if joint.name == name else joint
        for joint in performance.skeleton.joints
    )
    return replace(performance.skeleton, joints=joints)


def errors(rows):
    """Return (measure, of) → error of every row."""
    return {(row.measure, row.of): row.error for row in rows}


@pytest.mark.parametrize("layout", ["bodies", "cmu41"])
def test_the_truth_is_true(rng, layout):
    performance = make_performance(rng, layout=layout, rate=20, calibration_s=15, free_s=5)
    rows = compare_with_truth(performance, solved(performance))
    assert max(row.largest for row in rows) < ROUNDING
    stages = [row.stage for row in worst_rows(rows)]
    assert set(stages) == {
        "orientation",
        "skeleton",
        "normalization",
        "axes",
        "parameterization",
        "reconstruction",
    }


def test_an_axis_that_is_off_is_off_by_that(performance):
    joint = performance.skeleton.joint("left_hip")
    turn = Rotation.from_rotvec(np.deg2rad(4.0) * joint.axes[0]).as_matrix()
    axes = np.array([joint.axes[0], turn @ np.cross(joint.axes[0], joint.axes[1])])
    axes[1] /= np.linalg.norm(axes[1])
    expected = np.rad2deg(np.arccos(abs(axes[1] @ joint.axes[1])))
    found = errors(
        compare_with_truth(
            performance,
            solved(performance, skeleton=with_joint(performance, "left_hip", axes=axes)),
        )
    )
    assert found["axis", "left_hip axis 2"] == pytest.approx(expected)
    assert found["axis", "left_hip axis 1"] < ROUNDING
    assert found["axis", "right_hip axis 2"] < ROUNDING


def test_order_and_sign_of_axes_do_not_matter_to_the_axes(performance):
    joint = performance.skeleton.joint("neck")
    skeleton = with_joint(performance, "neck", axes=-joint.axes[::-1])
    found = errors(compare_with_truth(performance, solved(performance, skeleton=skeleton)))
    assert found["axis", "neck axis 1"] < ROUNDING
    assert found["axis", "neck axis 2"] < ROUNDING
    assert found["axes in the other order", "neck"] == 1
    assert found["axes in the other order", "left_hip"] == 0


def test_signs_and_zeros_of_angles_do_not_matter(performance):
    j = performance.skeleton.joint_names.index("right_knee")
    joint = performance.skeleton.joints[j]
    offset = 0.3
    rest = rotation_about(joint.axes[0], np.array(offset)) @ joint.rest
    skeleton = with_joint(performance, "right_knee", axes=-joint.axes, rest=rest)
    angles = performance.parameters.angles.copy()
    angles[:, j, 0] = -(angles[:, j, 0] - offset)
    solution = solved(performance, skeleton=skeleton, angles=angles)
    rows = compare_with_truth(performance, solution)
    assert max(row.largest for row in rows) < ROUNDING


def test_wrong_angles_are_found_where_they_are(performance):
    j = performance.skeleton.joint_names.index("left_shoulder")
    angles = performance.parameters.angles.copy()
    angles[::2, j, 1] += np.deg2rad(2.0)  # every other frame: 1 deg about their mean
    solution = solved(performance, angles=angles)
    # the poses of the truth, so that only the angles are wrong
    solution = replace(solution, motion=performance.motion)
    found = errors(compare_with_truth(performance, solution))
    assert found["angle", "left_shoulder axis 2"] == pytest.approx(1.0, rel=1e-3)
    told = found["angle, same conventions", "left_shoulder axis 2"]
    assert told == pytest.approx(np.sqrt(2.0), rel=1e-3)  # rms of 2 and 0 deg
    assert found["angle", "left_shoulder axis 1"] < ROUNDING
    assert found["markers", "left_forearm"] > 5
    assert found["markers", "right_forearm"] < ROUNDING


def test_other_conventions_for_the_same_motion_are_told_apart_from_errors(performance):
    """Another long axis and rest orientation change the numbers, not the motion."""
    j = performance.skeleton.joint_names.index("left_ankle")
    joint, limb = performance.skeleton.joints[j], performance.skeleton.limbs[j + 1]
    rest = rotation_about(joint.axes[1], np.array(0.1)) @ joint.rest
    long_axis = Rotation.from_rotvec([0.0, 0.1, 0.2]).as_matrix() @ limb.long_axis
    relative = performance.motion.relative_rotations()[:, j]
    angles, twists = angles_about_axes(
        relative,
        joint.axes,
        rest,
        long_axis,
        performance.parameters.angles[:, j, :2],
        performance.parameters.twists[:, j],
    )
    skeleton = with_joint(performance, "left_ankle", rest=rest)
    limbs = tuple(
        replace(one, long_axis=long_axis) if one.name == limb.name else one
        for one in skeleton.limbs
    )
    all_angles, all_twists = (
        performance.parameters.angles.copy(),
        performance.parameters.twists.copy(),
    )
    all_angles[:, j, :2], all_twists[:, j] = angles, twists
    solution = solved(
        performance, skeleton=replace(skeleton, limbs=limbs), angles=all_angles, twists=all_twists
    )
    found = errors(compare_with_truth(performance, solution))
    assert found["markers", "left_foot"] < ROUNDING, "the motion is the same"
    assert found["angle", "left_ankle axis 2"] > 0.05
    assert found["angle, same conventions", "left_ankle axis 2"] < ROUNDING
    assert found["twist, same conventions", "left_ankle"] < ROUNDING


def test_a_world_that_stands_elsewhere_is_laid_over_the_truth(performance, rng):
    turn = Rotation.from_rotvec([0, 2.0, 0]).as_matrix()
    tilt = Rotation.from_rotvec([np.deg2rad(3.0), 0, 0]).as_matrix()
    turn, shift = tilt @ turn, rng.normal(size=3)
    truth = solved(performance)
    solution = Solution(
        replace(truth.recording, markers=truth.recording.markers @ turn.T + shift),
        replace(
            truth.motion,
            rotations=turn @ truth.motion.rotations,
            origins=truth.motion.origins @ turn.T + shift,
        ),
        replace(
            truth.parameters,
            root_rotations=turn @ truth.parameters.root_rotations,
            root_positions=truth.parameters.root_positions @ turn.T + shift,
        ),
        truth.model_name,
    )
    found = errors(compare_with_truth(performance, solution))
    assert found.pop(("up", "world")) == pytest.approx(3.0)
    assert max(found.values()) < ROUNDING


def test_joint_centres_of_hinges_count_across_their_axis(performance):
    joint = performance.skeleton.joint("left_knee")
    slid = 0.02 * joint.axes[0]
    skeleton = with_joint(performance, "left_knee", centre_in_parent=joint.centre_in_parent + slid)
    truth = solved(performance)
    solution = replace(truth, motion=replace(truth.motion, skeleton=skeleton))
    found = errors(compare_with_truth(performance, solution))
    assert found["joint centre across the axis", "left_knee"] < ROUNDING
    assert found["joint centre along the axis, constant", "left_knee"] == pytest.approx(20)


def test_a_wrong_length_is_wrong_by_that(performance):
    limbs = tuple(
        replace(limb, length=limb.length + 0.012) if limb.name == "right_thigh" else limb
        for limb in performance.skeleton.limbs
    )
    truth = solved(performance)
    skeleton = replace(performance.skeleton, limbs=limbs)
    solution = replace(truth, parameters=replace(truth.parameters, skeleton=skeleton))
    rows = compare_with_truth(performance, solution)
    (row,) = (r for r in rows if r.measure == "segment length" and r.of == "right_thigh")
    assert row.error == pytest.approx(12)
    assert row.estimate - row.truth == pytest.approx(12)
    assert errors(rows)["segment length", "left_thigh"] < ROUNDING


def test_a_long_axis_the_other_way_round_turns_twists_round(performance):
    j = performance.skeleton.joint_names.index("neck")
    limbs = tuple(
        replace(limb, long_axis=-limb.long_axis) if limb.name == "head" else limb
        for limb in performance.skeleton.limbs
    )
    twists = performance.parameters.twists.copy()
    twists[:, j] *= -1
    skeleton = replace(performance.skeleton, limbs=limbs)
    solution = solved(performance, skeleton=skeleton, twists=twists)
    assert max(row.largest for row in compare_with_truth(performance, solution)) < ROUNDING


def test_swapped_markers_do_not_tilt_the_world(performance, rng):
    truth = solved(performance)
    recording = spoil_with_swaps(truth.recording, rng, n_swaps=20, swap_s=3)
    rows = compare_with_truth(performance, replace(truth, recording=recording))
    assert max(row.largest for row in rows) < ROUNDING


def test_a_shaken_joint_centre_has_no_constant_part(performance):
    trunk = performance.motion.origins[:, 0].copy()
    trunk[::2] += [0.0, 0.01, 0.0]
    trunk[1::2] -= [0.0, 0.01, 0.0]
    truth = solved(performance)
    origins = truth.motion.origins.copy()
    origins[:, 0] = trunk
    solution = replace(truth, motion=replace(truth.motion, origins=origins))
    found = errors(compare_with_truth(performance, solution))
    assert found["joint centre", "left_hip"] == pytest.approx(10)
    assert found["joint centre, constant", "left_hip"] < 1  # as far as the trunk tilts between


def test_a_missing_axis_is_not_a_good_one(performance):
    axes = performance.skeleton.joint("left_hip").axes[:1]
    skeleton = with_joint(performance, "left_hip", axes=axes, axes_uncertainty=None)
    rows = compare_with_truth(performance, solved(performance, skeleton=skeleton))
    worst = {row.measure: row for row in worst_rows(rows)}
    assert np.isnan(worst["axis"].error)
    assert worst["axis"].of == "left_hip"


def test_another_number_of_frames_is_refused(performance, rng):
    other = make_performance(rng, rate=20, calibration_s=5, free_s=0)
    with pytest.raises(BadRecording, match="100 frames, the performance 400"):
        compare_with_truth(performance, solved(other))
