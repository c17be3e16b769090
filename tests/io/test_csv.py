"""CSV of recordings, and the parameter table that rebuilds every pose with skeleton.json."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.data import Recording, motion_from_parameters
from kinesphere.errors import BadModel, UnreadableFile
from kinesphere.io import (
    read,
    read_csv,
    read_parameters,
    read_skeleton,
    write,
    write_csv,
    write_parameters,
    write_skeleton,
)

PRINTED = 5.1e-10  # m; nine decimals, rounded
REBUILT = 1e-8  # m; what the table keeps of every point


@pytest.fixture
def recording(rng):
    markers = rng.normal(scale=2.0, size=(17, 5, 3))
    markers[rng.random((17, 5)) < 0.3] = np.nan
    markers[4] = np.nan
    return Recording(markers, ("A", "b 2", 'say "c", please', "D:x", "E.x_m"), 119.88012)


def test_a_recording_there_and_back(recording, tmp_path):
    write(recording, tmp_path / "a.csv")
    again = read(tmp_path / "a.csv")
    assert again.labels == recording.labels
    assert again.rate == recording.rate
    assert_array_equal(again.seen, recording.seen)
    assert_allclose(again.markers, recording.markers, atol=PRINTED, rtol=0)


def test_what_a_recording_looks_like(recording, tmp_path):
    small = replace(recording, markers=[[[1, 2, 3]], [[np.nan] * 3]], labels=("C7",), rate=4.0)
    write_csv(small, tmp_path / "a.csv")
    assert (tmp_path / "a.csv").read_text(encoding="utf-8") == (
        "time_s,C7.x_m,C7.y_m,C7.z_m\n"
        "0.000000000,1.000000000,2.000000000,3.000000000\n"
        "0.250000000,,,\n"
    )


def test_a_recording_is_written_in_the_axes_of_its_file(recording, tmp_path):
    world_from_file = np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]])
    turned = replace(
        recording, markers=recording.markers @ world_from_file.T, world_from_file=world_from_file
    )
    write_csv(turned, tmp_path / "a.csv")
    assert_allclose(read_csv(tmp_path / "a.csv").markers, recording.markers, atol=PRINTED, rtol=0)


def test_one_frame_tells_no_rate(recording, tmp_path):
    write_csv(replace(recording, markers=recording.markers[:1]), tmp_path / "a.csv")
    again = read_csv(tmp_path / "a.csv")
    assert again.rate == 1.0
    assert "no frame rate" in again.history[-1].warnings[0]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("time_s,A.x_m,A.y_m\n0,1,2\n", "line 1 holds 'nothing more'"),
        ("time_s,A.x_m,A.y_m,B.z_m\n0,1,2,3\n", "line 1 holds 'B.z_m'"),
        ("time_s\n0\n1\n", "line 1 holds"),
        ("time_s,A.x_m,A.y_m,A.z_m\n", "no rows"),
        ("time_s,A.x_m,A.y_m,A.z_m\n0,1,2,3\n1,2,x,4\n", "line 3 holds 'x'"),
        ("time_s,A.x_m,A.y_m,A.z_m\n1,1,2,3\n1,2,3,4\n", "does not rise"),
        ("time_s,A.x_m,A.y_m,A.z_m\n1,1,2,3\n,2,3,4\n5,2,3,4\n", "uneven at line 3"),
        ("time_s,A.x_m,A.y_m,A.z_m\n1,1,2,3\n2,2,3,4\n5,2,3,4\n", "uneven at line 3"),
        ("time_s,A.x_m,A.y_m,A.z_m\n0,1,2,3\n1,2", "line 3 has 2 cells.*breaks off"),
        ("time_s" + 2 * ",A.x_m,A.y_m,A.z_m" + "\n0,1,2,3,1,2,3\n", "more than once"),
        ("", "empty"),
    ],
)
def test_damage_is_named(tmp_path, text, said):
    path = tmp_path / "a.csv"
    path.write_text(text)
    with pytest.raises(UnreadableFile, match=said):
        read_csv(path)


@pytest.mark.parametrize("of", ["performance", "odd", "gappy"])
def test_table_and_skeleton_alone_rebuild_every_pose(request, tmp_path, of):
    if of == "performance":
        truth = request.getfixturevalue("performance").parameters
    else:
        truth = request.getfixturevalue(f"{of}_parameters")
    write_skeleton(truth.skeleton, tmp_path / "skeleton.json")
    write_parameters(truth, tmp_path / "parameters.csv")
    again = read_parameters(tmp_path / "parameters.csv", read_skeleton(tmp_path / "skeleton.json"))
    assert again.rate == truth.rate
    assert_array_equal(again.flags, truth.flags)
    assert_array_equal(np.isnan(again.angles), np.isnan(truth.angles))
    assert_array_equal(np.isnan(again.twists), np.isnan(truth.twists))
    assert_allclose(again.residuals, truth.residuals, atol=PRINTED)
    before, after = motion_from_parameters(truth), motion_from_parameters(again)
    assert_array_equal(after.flags, before.flags)
    assert_allclose(after.origins, before.origins, atol=REBUILT)
    # 1 m from any limb's origin a point moves less than that, too
    assert_allclose(after.rotations, before.rotations, atol=REBUILT)


def test_the_columns_are_those_of_the_documents(performance, tmp_path):
    write_parameters(performance.parameters, tmp_path / "parameters.csv")
    head, first = (tmp_path / "parameters.csv").read_text(encoding="utf-8").splitlines()[:2]
    names = head.split(",")
    assert names[:8] == [
        *("time_s", "root.x_m", "root.y_m", "root.z_m"),
        *("root.qx", "root.qy", "root.qz", "root.qw"),
    ]
    assert names[8:13] == [f"neck.{c}" for c in (
        "axis1_deg", "axis2_deg", "twist_deg", "residual_mm", "flag"
    )]  # fmt: skip
    elbow = names.index("left_elbow.axis1_deg")
    assert names[elbow + 1] == "left_elbow.twist_deg"
    values = dict(zip(names, first.split(","), strict=True))
    assert float(values["root.qw"]) >= 0
    parameters = performance.parameters
    shoulder = performance.skeleton.joint_names.index("left_shoulder")
    assert float(values["left_shoulder.axis2_deg"]) == pytest.approx(
        np.degrees(parameters.angles[0, shoulder, 1])
    )
    assert values["left_shoulder.flag"] == str(parameters.flags[0, shoulder])


def test_quaternions_have_one_sign(odd_parameters, tmp_path):
    write_parameters(odd_parameters, tmp_path / "parameters.csv")
    head, *rows = (tmp_path / "parameters.csv").read_text(encoding="utf-8").splitlines()
    at = head.split(",").index("root.qw")
    assert min(float(row.split(",")[at]) for row in rows) >= 0


def test_columns_may_stand_in_any_order_with_others_among_them(performance, tmp_path):
    truth = performance.parameters
    path = tmp_path / "parameters.csv"
    write_parameters(truth, path)
    rows = [line.split(",")[::-1] for line in path.read_text(encoding="utf-8").splitlines()]
    rows = [[row[-1], "weather" if i == 0 else "7", *row[:-1]] for i, row in enumerate(rows)]
    path.write_text("\n".join(",".join(row) for row in rows) + "\n")
    assert_allclose(read_parameters(path, truth.skeleton).twists, truth.twists, atol=1e-11)


def test_the_skeleton_beside_the_table_is_found(performance, tmp_path):
    write(performance.parameters, tmp_path / "parameters.csv")
    with pytest.raises(UnreadableFile, match=r"skeleton\.json"):
        read(tmp_path / "parameters.csv")
    write(performance.skeleton, tmp_path / "skeleton.json")
    assert read(tmp_path / "parameters.csv").skeleton.joint_names == (
        performance.skeleton.joint_names
    )


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("neck.twist_deg", "neck.turn_deg", "no column neck.twist_deg"),
        ("neck.twist_deg,neck.residual_mm", "a,b", "no column neck.twist_deg and 1 more"),
        (",0\n", ",0.5\n", "line 2 holds a flag"),
        (",0\n", ",\n", "line 2 holds a flag"),
        (",0\n", ",256\n", "line 2 holds a flag"),
    ],
)
def test_a_damaged_table_is_named(performance, tmp_path, old, new, said):
    path = tmp_path / "parameters.csv"
    write_parameters(performance.parameters, path)
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises(UnreadableFile, match=said):
        read_parameters(path, performance.skeleton)


def test_joints_without_axes_are_refused(performance, tmp_path):
    joints = list(performance.skeleton.joints)
    joints[3] = replace(joints[3], axes=None, axes_uncertainty=None)
    skeleton = replace(performance.skeleton, joints=tuple(joints))
    with pytest.raises(BadModel, match=f"{joints[3].name} has no movement axes"):
        write_parameters(replace(performance.parameters, skeleton=skeleton), tmp_path / "p.csv")
