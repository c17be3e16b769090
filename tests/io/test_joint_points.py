"""Joint centres and angles in recording.c3d, as ezc3d and the c3d package find them."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.data import JointFlag, Output, Solution
from kinesphere.io import read, read_c3d, read_solution, write, write_c3d
from kinesphere.io.c3d.renew import DESCRIPTIONS
from kinesphere.io.own_points import without_own_points

STORED = 2e-4  # deg and mm; 32-bit floats


@pytest.fixture
def solution(performance):
    """Return a solution as truth has it, a joint unseen for a while, a twist unknown."""
    truth = performance.parameters
    angles, twists, flags = truth.angles.copy(), truth.twists.copy(), truth.flags.copy()
    angles[10:20, 2], twists[10:20, 2], flags[10:20, 2] = np.nan, np.nan, JointFlag.UNSEEN
    twists[30:40, 3], flags[30:40, 3] = np.nan, JointFlag.TWIST_UNKNOWN
    parameters = replace(truth, angles=angles, twists=twists, flags=flags)
    return Solution(performance.recording, performance.motion, parameters, "bodies")


def expected(solution, j):
    n_axes = solution.skeleton.joints[j].n_axes
    values = np.degrees(solution.parameters.angles[:, j])
    unseen = np.isnan(values[:, 0])
    values[:, n_axes:] = 0
    if n_axes < 3:
        values[:, 2] = np.nan_to_num(np.degrees(solution.parameters.twists[:, j]))
    values[unseen] = np.nan
    return values


def test_ezc3d_finds_centres_and_angles(solution, tmp_path):
    ezc3d = pytest.importorskip("ezc3d")
    write(solution, tmp_path / "out")
    file = ezc3d.c3d(str(tmp_path / "out" / "recording.c3d"))
    point, points = file["parameters"]["POINT"], file["data"]["points"]
    labels = point["LABELS"]["value"]
    described = dict(zip(labels, point["DESCRIPTIONS"]["value"], strict=True))
    pairs = point["TYPE_GROUPS"]["value"]
    assert dict(zip(pairs[::2], pairs[1::2], strict=True))["ANGLES"] == "ANGLE"
    assert point["ANGLE_UNITS"]["value"] == ["deg"]
    centres = solution.motion.joint_centres() @ solution.recording.world_from_file
    for j, joint in enumerate(solution.skeleton.joints):
        label = f"{joint.name}_angles"
        assert label in point["ANGLES"]["value"]
        found = points[:3, labels.index(label)].T
        assert_allclose(found, expected(solution, j), atol=STORED)
        at = points[:3, labels.index(joint.name)].T
        assert_allclose(at, centres[:, j] * 1e3, atol=STORED)
        assert joint.parent in described[joint.name]
        assert "axis 1" in described[label]
    said = " ".join(file["parameters"]["KINESPHERE"]["CONVENTIONS"]["value"])
    assert "parent_from_child = " in said
    assert "Z the twist" in said


@pytest.mark.filterwarnings("ignore:No analog data")
def test_the_c3d_package_reads_the_same(solution, tmp_path):
    c3d = pytest.importorskip("c3d")
    write(solution, tmp_path / "out")
    with (tmp_path / "out" / "recording.c3d").open("rb") as file:
        reader = c3d.Reader(file)
        labels = [label.strip() for label in reader.point_labels]
        frames = np.array([points for _, points, _ in reader.read_frames()])
    for j, joint in enumerate(solution.skeleton.joints):
        column = frames[:, labels.index(f"{joint.name}_angles")]
        wanted = expected(solution, j)
        seen = np.isfinite(wanted).all(axis=1)
        assert_allclose(column[seen, :3], wanted[seen], atol=STORED)
        assert (column[~seen, 3] < 0).all()


def test_our_reader_takes_angles_for_outputs(solution, tmp_path):
    write(solution, tmp_path / "out")
    recording = read_c3d(tmp_path / "out" / "recording.c3d")
    joints = solution.skeleton.joint_names
    assert [o.label for o in recording.outputs] == [f"{name}_angles" for name in joints]
    assert {o.kind for o in recording.outputs} == {"angle"}
    assert not set(recording.labels) & {o.label for o in recording.outputs}


def test_a_file_whose_angles_are_radians_gets_radians(solution, tmp_path):
    n = solution.recording.n_frames
    vendor = Output("LKneeAngles", "angle", np.ones((n, 3)), "rad")
    radians = replace(solution, recording=replace(solution.recording, outputs=(vendor,)))
    write(radians, tmp_path / "out")
    outputs = {o.label: o for o in read_c3d(tmp_path / "out" / "recording.c3d").outputs}
    name = solution.skeleton.joint_names[0]
    assert outputs[f"{name}_angles"].unit == "rad"
    assert_allclose(outputs[f"{name}_angles"].values, np.radians(expected(solution, 0)), atol=1e-5)


def test_what_was_added_does_not_become_the_recordings_own(solution, tmp_path):
    write_c3d(solution.recording, tmp_path / "in.c3d")
    write(replace(solution, recording=read(tmp_path / "in.c3d")), tmp_path / "out")
    write_c3d(read_solution(tmp_path / "out").recording, tmp_path / "again.c3d")
    before, after = (read_c3d(tmp_path / name) for name in ("in.c3d", "again.c3d"))
    assert after.labels == before.labels
    assert after.outputs == ()
    section = after.details["c3d"].layout.section
    assert section.group("KINESPHERE") is None
    assert section.texts("POINT", "ANGLES") == ()


def test_own_centres_are_left_out_by_what_the_file_says(solution, tmp_path):
    """A marker that merely bears a joint's name stays."""
    write_c3d(solution.recording, tmp_path / "in.c3d")
    recording = read(tmp_path / "in.c3d")
    name = solution.skeleton.joint_names[0]
    recording = replace(recording, labels=(name, *recording.labels[1:]))
    write(replace(solution, recording=recording), tmp_path / "out")
    found = read_c3d(tmp_path / "out" / "recording.c3d")
    assert len(found.labels) == len(recording.labels) + len(solution.skeleton.joints)
    left = without_own_points(found)
    assert set(left.labels) == set(recording.labels)
    assert left.outputs == ()
    there = left.markers[:, left.columns(recording.labels)]
    assert_allclose(there, recording.markers, atol=STORED)
    assert (
        f"{len(solution.skeleton.joints)} points are joint centres" in left.history[-1].warnings[0]
    )
    assert without_own_points(left) is left
    assert without_own_points(recording) is recording


def test_a_description_alone_is_no_computed_point(performance, tmp_path):
    recording = performance.recording
    told = {recording.labels[0]: "joint centre between trunk and head"}
    write_c3d(replace(recording, details={DESCRIPTIONS: told}), tmp_path / "other.c3d")
    found = read_c3d(tmp_path / "other.c3d")
    assert without_own_points(found) is found


def test_a_recording_solved_again_holds_no_joint_twice(solution, tmp_path):
    write(solution, tmp_path / "out")
    left = without_own_points(read_c3d(tmp_path / "out" / "recording.c3d"))
    write(replace(solution, recording=left), tmp_path / "again")
    once, twice = (read_c3d(tmp_path / name / "recording.c3d") for name in ("out", "again"))
    assert twice.labels == once.labels
    assert [o.label for o in twice.outputs] == [o.label for o in once.outputs]
