"""What each command prints and writes when all goes well."""

import json
import re
import shutil
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from typer.testing import CliRunner

import kinesphere
from kinesphere.cli.app import app
from kinesphere.cli.console import on_one_line, plain
from kinesphere.cli.files import read_all_solved
from kinesphere.cli.options import calibration_from_text
from kinesphere.io import read, write, write_model
from kinesphere.labelling import built_in_model
from kinesphere.pipeline import Settings, settings_fields, stage_settings

COMMANDS = (
    "demo",
    "info",
    "label",
    "solve",
    "track",
    "view",
    "edit",
    "compare",
    "convert",
    "model",
    "settings",
)


def ok(called):
    assert called.code == 0, called.err
    assert called.err == ""
    return called.out


# --- help and version ---


def test_version():
    shown = CliRunner().invoke(app, ["--version"])
    assert (shown.exit_code, shown.output) == (0, f"kinesphere {kinesphere.__version__}\n")


def test_help_lists_what_there_is(call):
    shown = CliRunner().invoke(app, [])
    assert shown.exit_code == 0
    for command in COMMANDS:
        assert command in shown.output
    listed = [line.split()[1] for line in shown.output.splitlines() if line.startswith("│ ")]
    assert not {"live", "batch"} & {*listed}


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_shows_an_example(command):
    shown = CliRunner().invoke(app, [command, "--help"])
    assert shown.exit_code == 0
    assert re.search(f"Examples?: kinesphere {command}", shown.output)
    assert "--json" in shown.output


# --- settings ---


def test_settings_prints_every_setting(call):
    out = ok(call("settings"))
    for stage, part in stage_settings(Settings()).items():
        for field, _, _ in settings_fields(part):
            assert f"{stage}.{field.name} = " in out


def test_settings_shows_what_would_be_in_force(call, tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text("[filter]\nwindow = 0.3\n[axes]\ncell = 3\n")
    words = ["settings", "--json", "--settings", file, "--set", "axes.cell=7"]
    shown = json.loads(ok(call(*words)))
    found = {(stage, s["key"]): s["value"] for stage, rows in shown.items() for s in rows}
    assert found["filter", "window"] == 0.3
    assert found["axes", "cell"] == 7.0


def test_one_stage_with_its_sources(call):
    out = ok(call("settings", "axes"))
    assert "source: " in out
    assert "filter.window" not in out


# --- info ---


def test_info_of_a_recording(call, trc):
    shown = json.loads(ok(call("info", trc, "--json")))
    assert shown["kind"] == "recording"
    assert (shown["n_frames"], shown["rate_hz"], shown["n_markers"]) == (220, 10.0, 42)
    assert shown["model"] == "cmu41"
    assert shown["models"]["cmu41"] == 1.0
    assert shown["up"]["used"] == "+y"
    (worst,) = shown["gaps"]["worst"]
    assert worst["missing"] == pytest.approx(20 / 220, abs=1e-6)
    assert (worst["gaps"], worst["longest_s"]) == (1, 2.0)
    assert worst["longest_from_frame"] == shown["first_frame"] + 30
    assert any(finding["rule"] == "constant" for finding in shown["findings"])


def test_info_in_words(call, trc):
    out = ok(call("info", trc))
    for words in ("220 (1–220) at 10 Hz, 22.00 s", "42 (0 unlabelled)", "solve takes cmu41", "+y"):
        assert words in out
    assert "[red]X[/red]" in out


def test_info_tells_how_many_times_too_large_lengths_are(call, recording, tmp_path):
    file = tmp_path / "inches.trc"
    plain = replace(recording, markers=recording.markers[:, :-1], labels=recording.labels[:-1])
    write(replace(plain, markers=plain.markers * 25.4), file)
    shown = json.loads(ok(call("info", file, "--json")))
    assert shown["times_too_large"] == 25.4
    (unit,) = [found for found in shown["findings"] if found["rule"] == "unit"]
    assert unit["remedy"].endswith("; lengths of a person would be 25.4 times too large")
    assert {found["rule"] for found in shown["findings"]} <= {"unit", "far", "gap"}
    assert "likely wrong: lengths are 25.4 times too large" in ok(call("info", file))


def test_info_doubts_a_file_that_says_another_way_is_up(call, performance, tmp_path):
    assert "Nothing looks wrong with it" in ok(
        call("info", written(performance.recording, tmp_path))
    )
    turned = replace(performance.recording, up="+z")
    out = ok(call("info", written(turned, tmp_path)))
    assert "the file says up is +z, but in 100% of the frames the head is along +y" in " ".join(
        out.split()
    )
    assert "Nothing else looks wrong with it" in out


def written(recording, folder):
    write(recording, folder / "walk.c3d")
    return folder / "walk.c3d"


def test_info_of_a_c3d(call, c3d):
    shown = json.loads(ok(call("info", c3d, "--json")))
    assert shown["read"]["format"].upper() == "C3D"
    assert shown["gaps"]["worst"] == []
    assert "Missing most" not in ok(call("info", c3d))


def test_info_of_labels_nobody_knows(call, recording, tmp_path):
    file = tmp_path / "odd.trc"
    write(replace(recording, labels=tuple(f"P{i}" for i in range(42))), file)
    shown = json.loads(ok(call("info", file, "--json")))
    assert shown["model"] is None
    assert "solve goes by motion alone, unless --model names one" in ok(call("info", file))


def test_info_of_a_model(call, tmp_path):
    file = tmp_path / "model.json"
    write_model(built_in_model("plugin-gait"), file)
    shown = json.loads(ok(call("info", file, "--json")))
    assert (shown["kind"], shown["root"]) == ("model", "pelvis")
    assert "left_thigh" in ok(call("info", file))


# --- convert ---


def test_convert_there_and_back(call, c3d, tmp_path):
    there, back = tmp_path / "walk.trc", tmp_path / "back.c3d"
    assert "walk.trc" in ok(call("convert", c3d, there))
    told = json.loads(ok(call("convert", there, back, "--json")))
    assert told["bytes"] == back.stat().st_size
    first, last = read(c3d), read(back)
    assert first.labels == last.labels
    assert_allclose(last.markers, first.markers, atol=1e-6)


def test_convert_replaces_what_was_there(call, c3d, tmp_path):
    target = tmp_path / "walk.csv"
    target.write_text("old")
    ok(call("convert", c3d, target))
    assert target.read_text().count("\n") > 200
    assert [entry.name for entry in tmp_path.iterdir()] == ["walk.csv"]


# --- solve ---


@pytest.fixture(scope="module")
def solved(trc, tmp_path_factory):
    """Return a solved folder and what solve printed, as JSON."""
    folder = tmp_path_factory.mktemp("solved") / "walk"
    words = ["solve", str(trc), "-o", str(folder), "--calibration", "0:20", "--json"]
    shown = CliRunner().invoke(app, [*words, "--set", "filter.window=0.4"])
    assert shown.exit_code == 0, shown.output
    return folder, json.loads(shown.stdout)


@pytest.mark.slow
def test_solve_leaves_everything_in_one_folder(solved):
    folder, told = solved
    names = {entry.name for entry in folder.iterdir()}
    assert {
        "recording.c3d",
        "skeleton.json",
        "parameters.csv",
        "motion.bvh",
        "motion.trc",
        "motion.mot",
        "solution.npz",
        "summary.json",
        "report.html",
    } <= names
    summary = json.loads((folder / "summary.json").read_text())
    assert told["stages"] == summary["stages"]
    assert told["output"] == str(folder)


@pytest.mark.slow
def test_solve_says_how_good_each_stage_is(solved):
    _, told = solved
    names = [stage["name"] for stage in told["stages"]]
    wanted = ["read", "labelling", "orientation", "skeleton", "normalization", "parameterization"]
    wanted.insert(3, "checks")  # one marker never moves
    assert names == [*wanted, "surface"]
    assert told["model"] == "cmu41"
    assert told["limb_residual_rms_mm"] < 5
    assert {joint["name"] for joint in told["joint_findings"]} >= {"left_knee", "right_elbow"}
    settings = {stage["name"]: stage["settings"] for stage in told["stages"]}
    assert settings["parameterization"]["filter.window"] == 0.4
    assert settings["parameterization"]["calibration_s"] == [0.0, 20.0]


@pytest.mark.slow
def test_solve_from_motion_alone(call, trc, tmp_path):
    folder = tmp_path / "alone"
    out = ok(call("solve", trc, "-o", folder, "--model", "none"))
    for words in ("model motion alone", "bodies from motion alone", "Report:"):
        assert words in out
    assert 'id="bodies"' in (folder / "report.html").read_text(encoding="utf-8")
    summary = json.loads((folder / "summary.json").read_text())
    (step,) = [stage for stage in summary["stages"] if stage["name"] == "discovery"]
    assert step["seconds"] > 0


@pytest.mark.slow
def test_solve_in_words_and_again_with_reused_axes(solved, call, trc, tmp_path):
    folder, _ = solved
    again = tmp_path / "again"
    out = ok(call("solve", trc, "-o", again, "--calibration-from", folder, "--model", "cmu41"))
    for words in ("labelling", "41 of 41 labels", "of another recording", "left knee", "Report:"):
        assert words in out
    assert (again / "report.html").is_file()
    before, after = read(folder).skeleton, read(again).skeleton
    twice = ["--calibration-from", folder, "--calibration-from", again]
    out = ok(call("solve", trc, "-o", tmp_path / "third", *twice, "--model", "cmu41"))
    assert f"axes known best by {folder.name}: " in out
    for a, b in zip(before.joints, after.joints, strict=True):
        assert_array_equal(a.axes, b.axes)
    told = json.loads((again / "skeleton.json").read_text())["joints"]
    measured = [joint.axes_source == "movement" for joint in before.joints]
    assert [bool(joint["axes_reused_from"]) for joint in told] == measured
    assert f"reused from {folder.name}" in (again / "report.html").read_text()
    before = (folder / "solution.npz").read_bytes()
    for source in (trc, folder / "recording.c3d"):
        onto = call("solve", source, "-o", folder, "--calibration-from", folder, "--model", "cmu41")
        assert onto.code == 2
        assert f"{folder} is read from; name another place" in onto.err
    onto = call("solve", folder / "recording.c3d", "-o", folder, "--model", "cmu41")
    assert onto.code == 2
    assert (folder / "solution.npz").read_bytes() == before
    method = ["--set", "axes.method=body", "--calibration-from", folder]
    failed = call("solve", trc, "-o", tmp_path / "no", *method, "--model", "cmu41")
    assert failed.code == 2
    assert "give one or the other" in failed.err
    assert not (tmp_path / "no").exists()


@pytest.mark.slow
def test_recordings_are_called_as_their_folders(solved, tmp_path):
    folder, _ = solved
    for way in ("a/hip", "b/hip", "b/knee"):
        shutil.copytree(folder, tmp_path / way)
    ways = [tmp_path / way for way in ("a/hip", "b/knee")]
    assert list(read_all_solved([*ways, ways[0]])) == ["hip", "knee"]
    both = [tmp_path / "a/hip", tmp_path / "b/hip"]
    assert list(read_all_solved(both)) == [str(way) for way in both]


@pytest.mark.slow
def test_a_solved_folder_tells_of_itself_and_converts(solved, call, tmp_path):
    folder, _ = solved
    shown = json.loads(ok(call("info", folder, "--json")))
    assert shown["kind"] == "solution"
    assert "Joints" in ok(call("info", folder))
    for name in ("motion.bvh", "points.trc", "table.csv", "body.osim", "bones.json"):
        ok(call("convert", folder, tmp_path / name))
        assert (tmp_path / name).stat().st_size > 1000
    header = (tmp_path / "table.csv").read_text().split("\n", 1)[0]
    assert "left_knee.axis1_deg" in header
    said = ok(call("convert", folder / "recording.c3d", tmp_path / "markers.trc"))
    assert "joint centres that Kinesphere computed" in said
    assert "left_hip" not in (tmp_path / "markers.trc").read_text()


@pytest.mark.slow
def test_files_of_a_solved_folder_tell_of_themselves(solved, call):
    folder, _ = solved
    for name in ("skeleton.json", "parameters.csv"):
        shown = json.loads(ok(call("info", folder / name, "--json")))
        assert shown["kind"] == "skeleton"
        for joint in shown["joints"]:
            assert len(joint["axes_sources"]) == joint["n_axes"]
        assert "left_knee to left_thigh" in ok(call("info", folder / name))


@pytest.mark.slow
def test_solving_a_solved_folder_is_refused(solved, call, tmp_path):
    called = call("solve", solved[0], "-o", tmp_path / "x")
    assert called.code == 2
    assert "solved already" in called.err


@pytest.mark.slow
def test_a_solution_does_not_take_the_place_of_other_files(call, trc, tmp_path):
    (tmp_path / "thesis.docx").write_text("precious")
    called = call("solve", trc, "-o", tmp_path)
    assert called.code == 2
    assert [entry.name for entry in tmp_path.iterdir()] == ["thesis.docx"]


# --- small things ---


@pytest.mark.parametrize(
    ("text", "span"), [("0:60", (0.0, 60.0)), ("1.5:2", (1.5, 2.0)), (None, None)]
)
def test_calibration(text, span):
    assert calibration_from_text(text) == span


def test_text_from_files_is_made_harmless():
    assert plain("a\x1b[31mb\n\u202e") == "a�[31mb��"
    assert on_one_line("a\n  b\tc\x07") == "a b c�"


def test_json_has_null_for_what_is_not_known(capsys):
    from kinesphere.cli.console import print_json

    print_json({"a": float("nan"), "b": (1.0, float("inf")), "c": np.inf})
    assert json.loads(capsys.readouterr().out) == {"a": None, "b": [1.0, None], "c": None}


def test_a_warning_has_a_line_for_each_reason(capsys):
    from kinesphere.cli.console import print_warnings, stdout

    warning = "not told: left_hip (3° apart; hardly moves), right_hip (9° apart), neck (odd)"
    names = ("left_hip", "right_hip", "neck")
    print_warnings(stdout(), [warning, "and \x1b[31m"], names)
    assert capsys.readouterr().out.splitlines() == [
        "! not told",
        "    hips: 3–9° apart",
        "    left hip: hardly moves",
        "    neck: odd",
        "! and �[31m",
    ]
