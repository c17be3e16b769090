"""Formats are recognised by what a file holds."""

import os
import subprocess
import sys

import numpy as np
import pytest

from kinesphere.data import Recording
from kinesphere.errors import UnknownFormat, UnreadableFile
from kinesphere.io import known_formats, read, write
from kinesphere.io.registry import function_named


@pytest.fixture
def recording(rng):
    return Recording(rng.normal(size=(4, 2, 3)), ("A", "B"), 100.0)


def test_the_content_counts_and_not_the_suffix(recording, tmp_path):
    write(recording, tmp_path / "right.c3d")
    (tmp_path / "right.c3d").rename(tmp_path / "wrong.csv")
    assert read(tmp_path / "wrong.csv").labels == ("A", "B")
    assert read(str(tmp_path / "wrong.csv")).labels == ("A", "B")


def test_the_suffix_counts_in_any_case(recording, tmp_path):
    write(recording, tmp_path / "LOUD.C3D")
    assert (tmp_path / "LOUD.C3D").read_bytes()[1] == 80


@pytest.mark.parametrize(
    ("content", "found"),
    [
        (b"time,x,y\n0,1,2\n", r"is called \.c3d but holds text that begins 'time,x,y'"),
        (b"\x07PRUBBISH", r"text that begins"),
        (b"XPos,YPos\n1,2\n", r"text that begins 'XPos,YPos'"),
        (b"\x89PNG\r\n\x1a\n\0\0", r"unknown binary data \(first bytes 89 50 4e 47\)"),
        (b" \n\n ", "nothing but blanks"),
    ],
)
def test_what_nobody_knows_is_described(tmp_path, content, found):
    path = tmp_path / "strange.c3d"
    path.write_bytes(content)
    with pytest.raises(UnknownFormat, match=found) as caught:
        read(path)
    assert str(path) in str(caught.value)
    assert "known: " in str(caught.value)
    assert "C3D" in str(caught.value)


def test_text_cut_inside_a_letter_is_still_text(tmp_path):
    path = tmp_path / "long.xyz"
    path.write_text("é" * 4096)
    with pytest.raises(UnknownFormat, match="holds text that begins 'ééé"):
        read(path)
    path.write_text("x" + "é" * 4096)
    with pytest.raises(UnknownFormat, match="holds text that begins 'xéé"):
        read(path)


def test_what_is_no_file(tmp_path):
    (tmp_path / "empty.c3d").touch()
    for path, message in (
        (tmp_path / "none.c3d", "there is no such file"),
        (tmp_path / "none" / "none.c3d", "there is no such file"),
        (tmp_path / "empty.c3d", "is empty"),
        (tmp_path / ("x" * 400), "cannot be read"),
        ("a\0b", "cannot be read"),
    ):
        with pytest.raises(UnreadableFile, match=message):
            read(path)
    with pytest.raises(UnknownFormat, match="is a folder, and none"):
        read(tmp_path)


@pytest.mark.skipif(sys.platform == "win32", reason="no such devices")
def test_a_device_is_not_read_for_ever():
    with pytest.raises(UnreadableFile, match="is a device or a pipe"):
        read("/dev/zero")


def test_writing_into_what_cannot_hold_it_names_what_can(recording, tmp_path):
    with pytest.raises(UnknownFormat, match=r"suffix '\.xyz' names no format .*\.c3d \(C3D\)"):
        write(recording, tmp_path / "a.xyz")
    with pytest.raises(UnknownFormat, match="no suffix names no format"):
        write(recording, tmp_path / "a")
    with pytest.raises(UnknownFormat, match="nothing can write a dict"):
        write({}, tmp_path / "a.c3d")
    assert list(tmp_path.iterdir()) == []


def test_every_format_can_be_found(recording):
    """The named functions exist: a misspelt one would show only when somebody needs it."""
    for known in known_formats():
        for name in (known.reader, *known.writers.values()):
            assert not name or callable(function_named(name)), (known.name, name)


def test_importing_the_package_loads_no_format():
    code = "import sys, kinesphere; print(*(m for m in sys.modules if 'kinesphere.' in m))"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "kinesphere.io" not in said.stdout


HUGE = 2**36  # bytes, all holes: reading them whole would take the machine's memory


@pytest.mark.parametrize("name", ["a.trc", "a.csv", "a.json"])
def test_a_huge_file_with_a_text_beginning_is_left_alone_soon(tmp_path, name):
    heads = {
        "a.trc": "PathFileType\t4\t(X/Y/Z)\ta.trc\n",
        "a.csv": "time_s,A.x_m,A.y_m,A.z_m\n",
        "a.json": '{"format": "kinesphere-model", ',
    }
    path = tmp_path / name
    path.write_text(heads[name])
    os.truncate(path, HUGE)
    with pytest.raises(UnreadableFile):
        read(path)


def test_a_c3d_file_with_a_huge_tail_is_read_without_it(tmp_path):
    path = tmp_path / "a.c3d"
    markers = np.arange(4 * 2 * 3, dtype=float).reshape(4, 2, 3) / 8
    write(Recording(markers=markers, labels=("A", "B"), rate=50.0), path)
    os.truncate(path, HUGE)
    np.testing.assert_allclose(read(path).markers, markers, atol=1e-7)
