"""Files and folders appear whole or not at all."""

import errno
import os
import sys

import pytest

from kinesphere.errors import UnwritableFile
from kinesphere.io import (
    check_directory_place,
    check_file_place,
    replacing,
    replacing_directory,
)


class Failure(Exception):
    pass


def fail_halfway(path):
    path.write_text("half")
    raise Failure


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_a_file_takes_the_place_of_the_old_one(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old")
    with replacing(path) as new:
        assert (new.parent, new.suffix) == (path.parent, ".txt")
        new.write_text("new")
        assert path.read_text(encoding="utf-8") == "old"
    assert path.read_text(encoding="utf-8") == "new"
    assert names(tmp_path) == ["a.txt"]


def test_a_failure_leaves_everything_as_it_was(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old")
    with pytest.raises(Failure), replacing(path) as new:
        fail_halfway(new)
    assert path.read_text(encoding="utf-8") == "old"
    assert names(tmp_path) == ["a.txt"]


@pytest.mark.parametrize("put", [replacing, lambda path: replacing_directory(path, names)])
def test_a_disk_that_fills_up_is_said_plainly(tmp_path, put):
    full = OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    with (
        pytest.raises(UnwritableFile, match=r"a\.bvh: cannot be written \("),
        put(tmp_path / "a.bvh"),
    ):
        raise full
    assert names(tmp_path) == []


@pytest.mark.skipif(sys.platform == "win32", reason="no such permissions")
def test_permissions_are_those_of_the_old_file_or_the_usual_ones(tmp_path):
    usual, old = tmp_path / "usual", tmp_path / "old"
    usual.touch()
    old.touch()
    old.chmod(0o600)
    for name in ("new", "old"):
        with replacing(tmp_path / name) as new:
            new.write_text("x")
    assert (tmp_path / "new").stat().st_mode == usual.stat().st_mode
    assert old.stat().st_mode & 0o777 == 0o600


def test_places_that_cannot_be_written_to(tmp_path):
    (tmp_path / "file").touch()
    for path, message in (
        (tmp_path, "is a folder"),
        (
            tmp_path / "none" / "a.txt",
            "cannot be written: there is no folder .*none; make it first",
        ),
        (tmp_path / "file" / "a.txt", "cannot be written"),
    ):
        with pytest.raises(UnwritableFile, match=message), replacing(path):
            pytest.fail("nothing may be done here")
        with pytest.raises(UnwritableFile, match=message):
            check_file_place(path)


def test_asking_writes_nothing(tmp_path):
    (tmp_path / "file").touch()
    (tmp_path / "empty").mkdir()
    for name in ("file", "new"):
        check_file_place(tmp_path / name)
    for name in ("empty", "new", "deep/er"):
        check_directory_place(tmp_path / name, ours)
    assert names(tmp_path) == ["empty", "file"]


@pytest.mark.skipif(
    sys.platform == "win32" or os.geteuid() == 0, reason="no such permissions, or all of them"
)
def test_asking_finds_a_closed_folder(tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(UnwritableFile, match="ermission"):
        check_file_place(tmp_path / "new")
    with pytest.raises(UnwritableFile, match="ermission"):
        check_directory_place(tmp_path / "deep" / "er", ours)


def ours(folder):
    return [] if (folder / "mark").exists() else names(folder)


def fill(folder, text):
    (folder / "mark").write_text(text)
    (folder / "inner").mkdir()
    (folder / "inner" / "deep").write_text(text)


def test_a_folder_appears_and_is_replaced_whole(tmp_path):
    place = tmp_path / "some" / "where"
    for text in ("first", "second"):
        with replacing_directory(place, ours) as new:
            assert names(new) == []
            fill(new, text)
        assert (place / "inner" / "deep").read_text(encoding="utf-8") == text
        assert names(place) == ["inner", "mark"]
        assert names(place.parent) == ["where"]


def test_an_empty_folder_is_anybodys(tmp_path):
    place = tmp_path / "empty"
    place.mkdir()
    with replacing_directory(str(place) + os.sep, ours) as new:
        fill(new, "x")
    assert names(place) == ["inner", "mark"]


def test_a_folder_of_others_is_left_alone(tmp_path):
    place = tmp_path / "photos"
    place.mkdir()
    (place / "holiday.jpg").touch()
    with (
        pytest.raises(
            UnwritableFile,
            match=r"photos holds other files, which would be lost \(holiday\.jpg\); move them "
            r"elsewhere, or name a new or empty folder$",
        ),
        replacing_directory(place, ours),
    ):
        pytest.fail("nothing may be done here")
    assert names(place) == ["holiday.jpg"]
    with (
        pytest.raises(UnwritableFile, match="is a file"),
        replacing_directory(place / "holiday.jpg", ours),
    ):
        pytest.fail("nothing may be done here")


def test_a_failure_leaves_the_folder_as_it_was(tmp_path):
    place = tmp_path / "place"
    with replacing_directory(place, ours) as new:
        fill(new, "first")
    with pytest.raises(Failure), replacing_directory(place, ours) as new:
        fail_halfway(new / "mark")
    assert (place / "inner" / "deep").read_text(encoding="utf-8") == "first"
    assert names(tmp_path) == ["place"]
