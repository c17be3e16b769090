"""Whatever goes wrong: one clear line on stderr, exit code 2, nothing that was there is touched."""

import json
import os
import subprocess
import sys
import time

import pytest

from kinesphere.cli.main import line_from_error, run
from kinesphere.errors import BadRecording

SECONDS = 10  # more than any malformed file may take


PNG = b"\x89PNG\r\n\x1a\n"

MALFORMED = {
    "empty.c3d": b"",
    "one_byte.c3d": b"\x02",
    "header.c3d": slice(0, 512),
    "parameters.c3d": slice(0, 700),
    "half.c3d": slice(0, 30_000),
    "frames.c3d": slice(0, -700),
    "zeros.c3d": bytes(4096),
    "noise.c3d": bytes((i * 97 + i // 7) % 256 for i in range(8192)),
    "absurd.c3d": b"\x02\x50" + b"\xff" * 4094,
    "table.c3d": b"time,x,y\n1,2,3\n",
    "blank.trc": b"\n\n\n",
    "short.trc": b"PathFileType\t4\t(X/Y/Z)\tx.trc\nDataRate\n",
    "broken.json": b'{"format": "kinesphere-model-1", ',
    "other.json": b'{"hello": 1}',
    "picture.png": PNG + bytes(64),
    "binary.mot": b"\0\1\2\3" * 100,
}
"""Name → content, or the part of a whole C3D file."""


@pytest.fixture
def kept(tmp_path):
    """Return an output that is there already, and a check that it still is as it was."""
    output = tmp_path / "kept.c3d"
    output.write_text("precious")
    return output


def assert_one_line(called, *words):
    assert called.code == 2
    assert called.out == ""
    assert len(called.error_lines) == 1, called.err
    assert called.err.startswith("error: ")
    assert "Traceback" not in called.err
    assert "a fault of Kinesphere" not in called.err
    for word in words:
        assert word in called.err


@pytest.mark.parametrize("name", MALFORMED)
@pytest.mark.parametrize("command", ["info", "convert", "solve", "model"])
def test_malformed_files(name, command, call, c3d, tmp_path, kept):
    file = tmp_path / name
    content = MALFORMED[name]
    file.write_bytes(c3d.read_bytes()[content] if isinstance(content, slice) else content)
    words = {
        "info": ["info", file],
        "convert": ["convert", file, kept],
        "solve": ["solve", file, "-o", tmp_path / "solved"],
        "model": ["model", file, "-o", kept],
    }[command]
    start = time.perf_counter()
    assert_one_line(call(*words), name)
    assert time.perf_counter() - start < SECONDS
    assert kept.read_text() == "precious"
    assert {entry.name for entry in tmp_path.iterdir()} == {name, "kept.c3d"}


def test_places_that_are_no_files(call, tmp_path):
    assert_one_line(call("info", tmp_path / "nowhere.c3d"), "nowhere.c3d", "no such file")
    assert_one_line(call("info", tmp_path), "folder")
    assert_one_line(call("info", "/dev/null"), "/dev/null")
    assert_one_line(call("info", "a\0b"))


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["frobnicate"], ["No such command 'frobnicate'"]),
        (["inof", "x.c3d"], ["Did you mean 'info'?"]),
        (["info"], ["Missing argument"]),
        (["solve", "x.c3d"], ["Missing option '-o'"]),
        (["info", "x.c3d", "--jsn"], ["--jsn"]),
        (["demo", "--seed", "one"], ["--seed"]),
        (["demo", "--set", "axes.method=magic"], ["axes.method is 'magic'"]),
        (["settings", "axis"], ["no stage is called 'axis'", "axes"]),
        (["settings", "--set", "axes.metod=pca"], ["did you mean method?"]),
        (["settings", "--set", "axes.cell=-1"], ["axes.cell is -1.0; it must be at least"]),
        (["settings", "--settings", "none.toml"], ["none.toml"]),
    ],
)
def test_words_that_cannot_be_meant(words, said, call):
    assert_one_line(call(*words), *said)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--model", "cmu14"], ["cmu14", "built in are cmu41, plugin-gait"]),
        (["--model", "none", "--set", "discovery.tree=9"], ["tree 9 was asked for"]),
        (["--subject", "Nobody"], ["Nobody"]),
        (["--calibration", "9"], ["START:END"]),
        (["--calibration", "5:2"], ["START:END"]),
        (["--calibration", "0:inf"], ["START:END"]),
        (["--calibration", "a:b"], ["START:END"]),
        (["--calibration", "0:5", "--calibration-from", "x"], ["exclude each other"]),
        (["--calibration-from", "nowhere"], ["nowhere"]),
        (["--set", "axes"], ["STAGE.KEY=VALUE"]),
        (["--set", "nope.method=1"], ["no stage is called 'nope'"]),
    ],
)
def test_solve_options_that_cannot_be_meant(options, said, call, trc, tmp_path):
    output = tmp_path / "out"
    assert_one_line(call("solve", trc, "-o", output, *options), *said)
    assert not output.exists()


@pytest.mark.slow
def test_a_way_to_face_that_cannot_be_meant(call, trc, tmp_path):
    assert_one_line(call("solve", trc, "-o", tmp_path / "o", "--facing", "north"), "north", "+x")


def test_a_model_that_is_a_recording(call, trc, c3d, tmp_path):
    assert_one_line(call("solve", trc, "-o", tmp_path / "o", "--model", c3d), "not a model")


def test_a_recording_is_wanted_not_a_model(call, tmp_path):
    from kinesphere.io import write_model
    from kinesphere.labelling import built_in_model

    model = tmp_path / "model.json"
    write_model(built_in_model("cmu41"), model)
    assert_one_line(call("solve", model, "-o", tmp_path / "o"), "a recording is wanted")


def test_outputs_that_cannot_be(call, c3d, tmp_path):
    assert_one_line(call("convert", c3d, tmp_path / "walk.xyz"), ".xyz", ".trc")
    assert_one_line(call("convert", c3d, tmp_path / "walk"), "no suffix")
    assert_one_line(call("convert", c3d, tmp_path / "no" / "walk.trc"), "cannot be written")
    assert_one_line(call("convert", c3d, tmp_path / "walk.bvh"), ".bvh")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(os.geteuid() == 0, reason="the superuser may write anywhere")
def test_a_folder_without_permission(call, c3d, tmp_path):
    tmp_path.chmod(0o500)
    assert_one_line(call("convert", c3d, tmp_path / "walk.trc"), "ermission")


def test_a_place_that_cannot_be_is_named_before_any_work(call, c3d, tmp_path, monkeypatch):
    def work(*_, **__):
        pytest.fail("the place should have been looked at first")

    for worker in ("io.read", "pipeline.solve", "skeleton.learn_model"):
        monkeypatch.setattr(f"kinesphere.{worker}", work)
    monkeypatch.setattr("kinesphere.cli.files.read", work)
    monkeypatch.setattr("kinesphere.synthetic.make_performance", work)
    file, foreign = tmp_path / "file", tmp_path / "foreign"
    file.touch()
    foreign.mkdir()
    (foreign / "thesis.tex").touch()
    for target, said in ((file, "is a file"), (foreign, "holds other"), (file / "in", "written")):
        assert_one_line(call("solve", c3d, "-o", target), said)
        assert_one_line(call("demo", "-o", target), said)
    assert_one_line(call("convert", c3d, foreign), "holds other files")
    assert_one_line(call("convert", c3d, tmp_path / "no" / "a.trc"), "cannot be written")
    assert_one_line(call("model", c3d, "-o", foreign), "is a folder")
    assert sorted(tmp_path.iterdir()) == [file, foreign]


# --- what no command expects ---


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (ZeroDivisionError("oh"), "ZeroDivisionError: oh (a fault of Kinesphere; --debug"),
        (OSError(28, "No space left on device", "out.c3d"), "out.c3d: no space left on device"),
        (PermissionError(13, "Permission denied"), "permission denied"),
        (MemoryError(), "not enough memory"),
        (KeyboardInterrupt(), "interrupted"),
        (BadRecording("two\nlines\x1b[31m"), "two lines"),
    ],
)
def test_everything_becomes_one_line(error, said, call, c3d, monkeypatch):
    def fail(*_):
        raise error

    monkeypatch.setattr("kinesphere.io.read", fail)
    called = call("info", c3d)
    assert called.code == 2
    assert len(called.error_lines) == 1
    assert said in called.err
    assert "\x1b" not in called.err


def test_debug_shows_where(c3d, monkeypatch, capfd):
    def fail(_):
        raise ZeroDivisionError("oh")

    monkeypatch.setattr("kinesphere.io.read", fail)
    assert run(["info", str(c3d)], debug=True) == 2
    assert "Traceback" in capfd.readouterr().err


def test_an_error_without_words_still_says_what_it_is():
    assert "RuntimeError" in line_from_error(RuntimeError())
    assert "OSError" in line_from_error(OSError())


# --- as the shell sees it ---


def shell(*words, **more):
    return subprocess.run(
        [sys.executable, "-m", "kinesphere", *map(str, words)],
        capture_output=True,
        text=True,
        check=False,
        **more,
    )


def test_exit_codes_in_the_shell(tmp_path):
    assert shell("--version").returncode == 0
    ran = shell("info", tmp_path / "none.c3d")
    assert (ran.returncode, ran.stdout, ran.stderr.count("\n")) == (2, "", 1)
    ran = shell("--debug", "info", tmp_path / "none.c3d")
    assert ran.returncode == 2
    assert "Traceback" in ran.stderr


CLOSED_PIPE = 141
"""As the shell reports a program that SIGPIPE ended."""


def test_nobody_reads():
    words = [sys.executable, "-m", "kinesphere", "settings"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as ran:
        ran.stdout.close()
        told = ran.stderr.read()
    assert (ran.returncode, told) == (CLOSED_PIPE, "")


@pytest.mark.skipif(os.name == "nt", reason="signals are not the same there")
def test_interrupted(tmp_path):
    code = (
        "import os, signal, sys, time, kinesphere.io, kinesphere.cli.main as m;"
        # whoever starts the tests in the background has had the signal ignored
        "signal.signal(signal.SIGINT, signal.default_int_handler);"
        # another thread may take the signal: Python hears of it a little later
        "kinesphere.io.read = lambda path: (os.kill(os.getpid(), signal.SIGINT), time.sleep(10));"
        "sys.argv[1:] = ['info', 'x.c3d']; m.main()"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert ran.returncode == 2
    assert ran.stderr == "error: interrupted; no file was left half-written\n"


def test_a_label_cannot_steer_the_terminal(recording, call, monkeypatch):
    monkeypatch.setattr("kinesphere.io.read", lambda _: recording)
    called = call("info", "x.c3d", "--json")
    assert called.code == 0
    assert json.loads(called.out)["labels"][-1] == "[red]X[/red]\x1b[31m"
    assert "\x1b" not in called.out
