"""Where to look: what is listed, and that nothing short is lost by thinning."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from kinesphere.data import Event, JointFlag, PoseFlag
from kinesphere.report.improbable import improbable_poses
from kinesphere.report.moments import Moment, find_moments, moment_rows, most_telling
from kinesphere.report.packing import unpack
from kinesphere.report.scene import scene_from_solution


@pytest.fixture
def calm(solution):
    """Return the solution with nothing wrong in it."""
    recording = solution.recording
    worn = {label for limb in solution.skeleton.limbs for label in limb.markers}
    columns = [i for i, label in enumerate(recording.labels) if label in worn]
    markers = np.array(recording.markers)
    markers[:, columns] = np.nan_to_num(markers[:, columns], nan=0.5)
    motion, parameters = solution.motion, solution.parameters
    rotations, origins = np.array(motion.rotations), np.array(motion.origins)
    rotations[:], origins[:] = rotations[0], origins[0]  # this actor is in a hurry
    flags = np.full(motion.flags.shape, PoseFlag.MEASURED, dtype=np.uint8)
    return replace(
        solution,
        recording=replace(recording, markers=markers),
        motion=replace(motion, rotations=rotations, origins=origins, flags=flags),
        parameters=replace(
            parameters,
            flags=np.zeros_like(parameters.flags),
            residuals=np.full(parameters.residuals.shape, 0.004),
        ),
    )


def with_gap(solution, label, first, end):
    markers = np.array(solution.recording.markers)
    markers[first:end, solution.recording.labels.index(label)] = np.nan
    return replace(solution, recording=replace(solution.recording, markers=markers))


def test_nothing_wrong_is_nothing_to_look_at(calm):
    assert find_moments(calm) == []
    assert moment_rows(calm) == ([], 0)
    scene = scene_from_solution(calm)
    assert scene["moments"] == []
    assert scene["improbable"] == []
    assert not unpack(scene["arrays"]["missing"]).any()


def test_a_gap_is_found_and_picks_its_marker(calm):
    label = calm.skeleton.limbs[3].markers[0]
    spoilt = with_gap(calm, label, 50, 62)
    column = calm.recording.labels.index(label)
    assert find_moments(spoilt) == [Moment(50, 62, "gap", f"{label} unseen", ("marker", column))]
    (row,), more = moment_rows(spoilt)
    assert (row.when, row.lasts, more) == (f"{50 / 90:.2f} s", "12 frames", 0)
    scene = scene_from_solution(spoilt)
    (moment,) = scene["moments"]
    assert scene["markers"][moment["about"][1]]["label"] == label
    assert_array_equal(np.flatnonzero(unpack(scene["arrays"]["missing"])), np.arange(50, 62))


def test_gaps_that_nearly_touch_are_one(calm):
    label = calm.skeleton.limbs[3].markers[0]
    spoilt = with_gap(with_gap(calm, label, 50, 60), label, 64, 70)
    assert [(m.first, m.end) for m in find_moments(spoilt)] == [(50, 70)]
    apart = with_gap(with_gap(calm, label, 50, 60), label, 90, 95)
    assert [(m.first, m.end) for m in find_moments(apart)] == [(50, 60), (90, 95)]


def test_one_bad_frame_survives_thinning(calm):
    label = calm.skeleton.limbs[3].markers[0]
    spoilt = with_gap(calm, label, 51, 52)
    flags = np.array(spoilt.parameters.flags)
    flags[53, 2] = JointFlag.DISLOCATED
    spoilt = replace(
        spoilt,
        motion=replace(spoilt.motion, rate=240.0),
        parameters=replace(spoilt.parameters, flags=flags, rate=240.0),
    )
    scene = scene_from_solution(spoilt)
    assert scene["stride"] == 4
    assert_array_equal(np.flatnonzero(unpack(scene["arrays"]["missing"])), [12])
    assert scene["flags"][2] == {"dislocated": [[13, 14]]}
    assert scene["improbable"] == [[13, 14]]
    assert [(m["first"], m["end"]) for m in scene["moments"]] == [(12, 13), (13, 14)]


def test_a_limb_without_a_pose_and_events_are_listed_in_time(calm):
    flags = np.array(calm.motion.flags)
    flags[30:33, 4] = PoseFlag.UNSEEN
    events = (Event(0.5, "Foot Strike", "Left"), Event(99.0, "End"), Event(float("nan"), "never"))
    spoilt = replace(
        calm,
        motion=replace(calm.motion, flags=flags),
        recording=replace(calm.recording, events=events),
    )
    name = calm.skeleton.limb_names[4].replace("_", " ")
    assert [(m.kind, m.what, m.first) for m in find_moments(spoilt)] == [
        ("pose", f"{name} has no pose", 30),
        ("event", "Left Foot Strike", 45),
        ("event", "End", calm.motion.n_frames - 1),
    ]


def test_the_longest_are_listed_and_every_event():
    moments = [Moment(10 * i, 10 * i + 1 + i % 7, "gap", f"m{i}") for i in range(30)]
    moments.append(Moment(5, 6, "event", "start"))
    told = most_telling(moments, 10)
    assert len(told) == 10
    assert "start" in [m.what for m in told]
    shortest = min(m.end - m.first for m in told if m.kind == "gap")
    left = [m for m in moments if m not in told]
    assert all(m.end - m.first <= shortest for m in left)
    assert [m.first for m in told] == sorted(m.first for m in told)


def test_a_leap_is_improbable_and_fast_movement_is_not(calm):
    rotations = np.array(calm.motion.rotations)
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    limb = 4
    rotations[60:, limb] = rotations[60:, limb] @ quarter  # 90° from one frame to the next
    leapt = replace(calm, motion=replace(calm.motion, rotations=rotations))
    found = improbable_poses(leapt)["leaps"]
    assert_array_equal(np.argwhere(found[:, limb - 1]), [[60]])
    slow = replace(leapt, motion=replace(leapt.motion, rate=12.0))
    assert not improbable_poses(slow)["leaps"].any()  # half a turn a frame is no leap at 12 Hz
    assert not improbable_poses(calm)["leaps"].any()


def test_a_limb_astray_is_told_by_what_it_usually_does(calm, rng):
    residuals = rng.uniform(0.010, 0.014, calm.parameters.residuals.shape)
    residuals[70:75, 2] = 0.06
    residuals[:, 3] = rng.uniform(0.0, 0.12, len(residuals))  # a joint that always strays
    residuals[70, 1] = 0.02  # far from its usual, but near
    residuals[71, 1] = np.nan
    found = improbable_poses(
        replace(calm, parameters=replace(calm.parameters, residuals=residuals))
    )["goes where its axes do not take it"]
    assert_array_equal(np.argwhere(found), [[f, 2] for f in range(70, 75)])
