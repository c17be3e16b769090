"""A solved folder: everything comes back, to the last bit, or it is said what is wrong."""

import json
from dataclasses import fields, is_dataclass, replace

import c3d
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.data import (
    Analog,
    Event,
    Motion,
    Output,
    PoseFlag,
    Recording,
    Solution,
    Step,
    motion_from_parameters,
)
from kinesphere.errors import BadSetting, KinesphereError, UnreadableFile
from kinesphere.io import (
    read,
    read_parameters,
    read_skeleton,
    read_solution,
    read_trc,
    write,
    write_solution,
)
from kinesphere.io.c3d import read_c3d, write_c3d
from kinesphere.io.solution import FILES, ISB_ANGLES, MOTION_GLB

PRINTED = 5.1e-10  # m, of a TRC file
STORED = 2e-6  # m, of the 32-bit floats of a C3D file


def assert_same(a, b, way="solution"):
    """Compare any two values; arrays bit for bit, NaN equal to NaN, details left out."""
    if is_dataclass(a):
        assert type(a) is type(b), way
        for f in fields(a):
            if f.name != "details":
                assert_same(getattr(a, f.name), getattr(b, f.name), f"{way}.{f.name}")
    elif isinstance(a, np.ndarray):
        assert isinstance(b, np.ndarray), way
        assert a.dtype == b.dtype, way
        assert a.shape == b.shape, way
        assert a.tobytes() == b.tobytes(), way
    elif isinstance(a, tuple | list):
        assert type(a) is type(b), way
        assert len(a) == len(b), way
        for i, (x, y) in enumerate(zip(a, b, strict=True)):
            assert_same(x, y, f"{way}[{i}]")
    elif isinstance(a, dict):
        assert list(a) == list(b), way
        for key in a:
            assert_same(a[key], b[key], f"{way}[{key}]")
    else:
        assert type(a) is type(b), way
        assert a == b or (a != a and b != b), way


@pytest.fixture
def solution(performance, gappy_parameters, rng):
    """Return a solution with gaps, outputs, analog channels, events, history."""
    n = performance.recording.n_frames
    steps = (
        Step("read", {"file": "a.c3d"}, {"rate_hz": 25.0}, ("the unit is guessed",), "0.1"),
        Step("axes", {"list": [1, 2.5, None, "x", {"deep": True}]}, {"odd_mm": float("nan")}),
    )
    markers = performance.recording.markers.copy()
    markers[3:9, 4], markers[:, 6] = np.nan, np.nan
    world_from_file = np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]])
    recording = Recording(
        markers=markers,
        labels=performance.recording.labels,
        rate=25.0,
        first_frame=31,
        residuals=rng.random(markers.shape[:2]) * 1e-3,
        outputs=(
            Output("LKneeAngles", "angle", rng.normal(size=(n, 3)) * 40, "deg"),
            Output("LHipForce", "force", rng.normal(size=(n, 3)), "N", rng.random(n)),
        ),
        analog=Analog(rng.normal(size=(n * 4, 2)), ("Fz", "EMG é"), ("N", "V"), 100.0),
        events=(Event(0.44, "Foot Strike", "Left", "anna", "heel"),),
        up="+y",
        world_from_file=world_from_file,
        history=steps[:1],
    )
    truth = motion_from_parameters(gappy_parameters)
    flags = truth.flags.copy()
    flags[5, 0] = PoseFlag.JOINT_AIDED
    motion = Motion(
        skeleton=replace(performance.skeleton, history=steps),
        rotations=truth.rotations,
        origins=truth.origins,
        residuals=rng.random(flags.shape) * 1e-3,
        flags=flags,
        rate=25.0,
        first_frame=31,
        history=steps,
    )
    parameters = replace(gappy_parameters, first_frame=31, history=steps, rate=25.0)
    return Solution(recording, motion, parameters, "bodies", {"read": 0.125, "axes": 2.5})


@pytest.fixture
def folder(solution, tmp_path):
    write_solution(solution, tmp_path / "out", extra={"report.html": "<p>é</p>"})
    return tmp_path / "out"


def test_everything_comes_back_to_the_last_bit(solution, folder):
    assert_same(solution, read(folder))


def test_the_folder_holds_what_the_design_says(folder):
    assert {path.name for path in folder.iterdir()} == {*FILES, ISB_ANGLES, "report.html"}
    assert (folder / "report.html").read_text(encoding="utf-8") == "<p>é</p>"


def test_the_c3d_file_holds_markers_and_joint_centres(solution, folder):
    recording = read_c3d(folder / "recording.c3d")
    joints = solution.skeleton.joint_names
    assert recording.labels == solution.recording.labels + joints
    in_file = solution.recording.markers @ solution.recording.world_from_file
    at = recording.columns(solution.recording.labels)
    assert_allclose(recording.markers[:, at], in_file, atol=STORED, rtol=0)
    centres = solution.motion.joint_centres() @ solution.recording.world_from_file
    assert_allclose(recording.markers[:, recording.columns(joints)], centres, atol=STORED, rtol=0)
    assert recording.first_frame == 31
    with (folder / "recording.c3d").open("rb") as file:
        labels = [label.strip() for label in c3d.Reader(file).point_labels]
    assert set(joints) <= set(labels)


def test_table_and_skeleton_in_the_folder_rebuild_the_poses(solution, folder):
    skeleton = read_skeleton(folder / "skeleton.json")
    again = motion_from_parameters(read_parameters(folder / "parameters.csv", skeleton))
    truth = motion_from_parameters(solution.parameters)
    assert_allclose(again.origins, truth.origins, atol=1e-8)


def test_the_marker_file_stands_in_the_world_of_the_model(solution, folder):
    trc = read_trc(folder / "motion.trc")
    owned = {label for limb in solution.skeleton.limbs for label in limb.markers}
    assert set(trc.labels) == owned
    at = solution.recording.columns(trc.labels)
    assert_allclose(trc.markers, solution.recording.markers[:, at], atol=PRINTED, rtol=0)


def test_the_summary_tells_each_stage(folder):
    def refuse(constant):
        raise AssertionError(constant)

    text = (folder / "summary.json").read_text(encoding="utf-8")
    summary = json.loads(text, parse_constant=refuse)
    assert summary["model"] == "bodies"
    assert summary["n_frames"] == 75
    assert summary["duration_s"] == 3.0
    assert summary["warnings"] == ["the unit is guessed"]
    read_step, axes_step = summary["stages"]
    assert read_step["name"] == "read"
    assert read_step["seconds"] == 0.125
    assert read_step["findings"] == {"rate_hz": 25.0}
    assert axes_step["findings"] == {"odd_mm": None}
    assert axes_step["settings"]["list"][4] == {"deep": True}


def test_the_arrays_open_without_us(solution, folder):
    with np.load(folder / "solution.npz", allow_pickle=False) as arrays:
        assert_array_equal(arrays["motion.rotations"], solution.motion.rotations)
        assert_array_equal(arrays["parameters.angles"], solution.parameters.angles)
        assert tuple(arrays["joints"]) == solution.skeleton.joint_names
        assert tuple(arrays["limbs"]) == solution.skeleton.limb_names
        assert tuple(arrays["labels"]) == solution.recording.labels


def test_what_a_c3d_file_needs_to_be_written_back_survives(solution, tmp_path):
    write_c3d(solution.recording, tmp_path / "in.c3d")
    recording = read_c3d(tmp_path / "in.c3d")
    write(replace(solution, recording=recording), tmp_path / "out")
    restored = read_solution(tmp_path / "out").recording
    assert_same(recording, restored, "recording")
    before, after = (r.details["c3d"].layout.section for r in (recording, restored))
    assert [group.name for group in after.groups] == [group.name for group in before.groups]
    write_c3d(restored, tmp_path / "again.c3d")
    assert_same(
        replace(recording, history=()),
        replace(read_c3d(tmp_path / "again.c3d"), history=()),
        "written again",
    )


def test_the_same_solution_gives_the_same_bytes(solution, folder, tmp_path):
    write_solution(solution, tmp_path / "twin", extra={"report.html": "<p>é</p>"})
    for path in folder.iterdir():
        if path.name != "motion.trc":  # names itself in its first line, as TRC files do
            assert path.read_bytes() == (tmp_path / "twin" / path.name).read_bytes(), path.name


def test_markerless_solutions_have_joint_centres_alone(solution, tmp_path):
    n = solution.recording.n_frames
    recording = Recording(np.empty((n, 0, 3)), (), 25.0)
    skeleton = solution.skeleton
    bare = replace(
        skeleton,
        limbs=tuple(
            replace(limb, markers=(), marker_positions=np.empty((0, 3))) for limb in skeleton.limbs
        ),
    )
    markerless = replace(
        solution,
        recording=recording,
        parameters=replace(solution.parameters, skeleton=bare),
        motion=replace(solution.motion, skeleton=bare),
    )
    write(markerless, tmp_path / "out")
    assert_same(markerless, read(tmp_path / "out"))
    assert read_c3d(tmp_path / "out" / "recording.c3d").labels == skeleton.joint_names


def test_a_marker_called_like_a_joint_keeps_its_name(solution, tmp_path):
    joint = solution.skeleton.joint_names[0]
    labels = (joint, *solution.recording.labels[1:])
    write(replace(solution, recording=replace(solution.recording, labels=labels)), tmp_path / "out")
    labels = read_c3d(tmp_path / "out" / "recording.c3d").labels
    assert joint in labels
    assert f"{joint}_centre" in labels


def test_a_solved_folder_is_replaced_and_nothing_of_the_old_stays(solution, folder):
    (folder / ".DS_Store").touch()  # a look at it in Finder must not lock it
    write_solution(replace(solution, model_name="other"), folder)
    assert read_solution(folder).model_name == "other"
    assert not (folder / "report.html").exists()
    assert [path.name for path in folder.parent.iterdir()] == ["out"]


def test_other_peoples_files_are_never_touched(solution, folder):
    (folder / "thesis.txt").write_text("ten years")
    with pytest.raises(KinesphereError, match=r"out holds other files, .* lost \(thesis\.txt\)"):
        write_solution(solution, folder)
    assert (folder / "thesis.txt").read_text(encoding="utf-8") == "ten years"
    assert read_solution(folder).model_name == "bodies"


def test_what_fails_half_way_leaves_nothing(solution, folder, tmp_path):
    joints = list(solution.skeleton.joints)
    joints[3] = replace(joints[3], axes=None, axes_uncertainty=None)
    skeleton = replace(solution.skeleton, joints=tuple(joints))
    broken = replace(solution, parameters=replace(solution.parameters, skeleton=skeleton))
    for name in ("new", "out"):
        with pytest.raises(KinesphereError, match="no movement axes"):
            write_solution(broken, tmp_path / name)
    assert [path.name for path in tmp_path.iterdir()] == ["out"]
    assert_same(solution, read_solution(folder))


@pytest.mark.parametrize("name", ["a/b.html", "../x", "..", "solution.npz", ""])
def test_extra_files_have_plain_new_names(solution, tmp_path, name):
    with pytest.raises(BadSetting, match="cannot be added"):
        write_solution(solution, tmp_path / "out", extra={name: ""})


def test_no_folder_and_no_solution(tmp_path):
    with pytest.raises(UnreadableFile, match="not there"):
        read_solution(tmp_path / "none")
    (tmp_path / "file").write_text("x")
    with pytest.raises(UnreadableFile, match="is a file"):
        read_solution(tmp_path / "file")
    (tmp_path / "empty").mkdir()
    with pytest.raises(UnreadableFile, match="no solved folder"):
        read_solution(tmp_path / "empty")


@pytest.mark.parametrize("name", [name for name in FILES if name != MOTION_GLB])
def test_a_missing_file_is_named(folder, name):
    (folder / name).unlink()
    with pytest.raises(UnreadableFile, match=name):
        read_solution(folder)


def test_folders_from_before_there_was_gltf_are_whole(solution, tmp_path):
    write_solution(solution, tmp_path / "old")
    (tmp_path / "old" / MOTION_GLB).unlink()
    assert_same(read_solution(tmp_path / "old"), solution)


def test_damaged_arrays_are_said(solution, folder, rng):
    path = folder / "solution.npz"
    whole = path.read_bytes()
    for share in (0.0, 0.01, 0.5, 0.99, 0.9999):
        path.write_bytes(whole[: int(share * len(whole))])
        with pytest.raises(UnreadableFile, match=r"solution\.npz"):
            read_solution(folder)
    n_said = 0
    for at in rng.integers(0, len(whole), 30):
        spoilt = bytearray(whole)
        spoilt[at] ^= 0x5A
        path.write_bytes(bytes(spoilt))
        said, found = "", solution
        try:
            found = read_solution(folder)
        except UnreadableFile as error:
            said = str(error)
        assert "\n" not in said
        assert_same(solution, found)  # a byte was hit that nobody needs, or it was said
        n_said += bool(said)
    assert n_said > 20


@pytest.mark.parametrize(
    "change",
    [
        lambda tree: tree.update(format="kinesphere-solution-9"),
        lambda tree: tree.pop("solution"),
        lambda tree: tree["solution"].update({"$": "Path"}),
        lambda tree: tree["solution"].update({"$": "Step"}),
        lambda tree: tree["solution"].pop("motion"),
        lambda tree: tree["solution"]["motion"].update(colour="red"),
        lambda tree: tree["solution"]["motion"].update(rotations={"$array": "nowhere"}),
        lambda tree: tree["solution"]["motion"].update(rotations={"$array": "motion.origins"}),
        lambda tree: tree.update(solution=3),
    ],
)
def test_a_tree_that_contradicts_itself_is_said(folder, change):
    path = folder / "solution.npz"
    with np.load(path) as entries:
        arrays = dict(entries)
    tree = json.loads(bytes(arrays["tree"]))
    change(tree)
    arrays["tree"] = np.frombuffer(json.dumps(tree).encode(), dtype=np.uint8)
    np.savez(path, **arrays)
    with pytest.raises(UnreadableFile, match=r"solution\.npz"):
        read_solution(folder)


def test_nothing_is_ever_unpickled(folder):
    path = folder / "solution.npz"
    with np.load(path) as entries:
        arrays = dict(entries)
    arrays["motion.origins"] = np.array([{"a": 1}], dtype=object)
    np.savez(path, **arrays)
    with pytest.raises(UnreadableFile, match="allow_pickle"):
        read_solution(folder)


def test_how_long_it_took_is_told_by_the_summary_alone(solution, folder, tmp_path):
    slower = replace(solution, seconds={"read": 7.5})
    write_solution(slower, tmp_path / "slower")
    arrays = (tmp_path / "slower" / "solution.npz").read_bytes()
    assert arrays == (folder / "solution.npz").read_bytes()
    assert read_solution(tmp_path / "slower").seconds == {"read": 7.5}


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"seconds": 3}', '{"seconds": {"read": "x"}}'])
def test_times_that_nobody_can_read_are_none(solution, tmp_path, text):
    write_solution(solution, tmp_path / "folder")
    (tmp_path / "folder" / "summary.json").write_text(text, encoding="utf-8")
    assert read_solution(tmp_path / "folder").seconds == {}
