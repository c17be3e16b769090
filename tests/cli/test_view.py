"""``kinesphere view``: what it refuses before it opens anything."""

import json
import signal
import subprocess
import sys
import urllib.request

import pytest

pytest.importorskip("viser")

ANOTHER = """
[[edit]]
joint = "tail"
axis = 1
add_deg = 30.0
"""


def test_there_must_be_something(call, tmp_path):
    called = call("view", tmp_path / "nothing.c3d", "--no-open")
    assert called.code == 2
    assert called.error_lines == [f"error: {tmp_path / 'nothing.c3d'}: there is no such file"]


def test_a_model_is_no_motion(call, tmp_path):
    (tmp_path / "a.txt").write_text("words", encoding="utf-8")
    called = call("view", tmp_path / "a.txt", "--no-open")
    assert called.code == 2
    assert len(called.error_lines) == 1


def test_a_recording_has_no_edits(call, c3d, tmp_path):
    called = call("view", c3d, "--no-open", "--edits", tmp_path / "e.toml")
    assert called.code == 2
    assert "solve it first" in called.err


def test_edits_of_another_skeleton_are_refused(call, c3d, tmp_path):
    assert call("solve", c3d, "-o", tmp_path / "walk").code == 0
    (tmp_path / "e.toml").write_text(ANOTHER, encoding="utf-8")
    called = call("view", tmp_path / "walk", "--no-open", "--edits", tmp_path / "e.toml")
    assert called.code == 2
    assert "edit 1: there is no joint 'tail'" in called.err


@pytest.mark.parametrize("port", ["0", "70000", "x"])
def test_a_port_is_a_port(call, c3d, port):
    called = call("view", c3d, "--no-open", "--port", port)
    assert called.code == 2
    assert len(called.error_lines) == 1


def test_it_serves_until_it_is_interrupted(c3d):
    command = [sys.executable, "-m", "kinesphere", "view", str(c3d), "--no-open", "--json"]
    # whoever starts the tests in the background has had the signal ignored
    with subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    ) as process:
        lines = [process.stdout.readline()]
        while lines[-1].strip() not in (b"}", b""):
            lines.append(process.stdout.readline())
        told = json.loads(b"".join(lines))
        assert told["address"].startswith("http://127.0.0.1:")
        assert told["edits"] is None
        with urllib.request.urlopen(told["address"], timeout=20) as page:
            assert b"<html" in page.read(10_000)
        process.send_signal(signal.SIGINT)
        try:
            out, err = process.communicate(timeout=20)
        finally:
            process.kill()
    assert process.returncode == 0
    assert (out, err) == (b"", b"")
