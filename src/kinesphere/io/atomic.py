"""Files and folders appear whole or not at all."""

import errno
import os
import shutil
import stat
import tempfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from kinesphere.errors import UnwritableFile

LISTED = 5
"""Names of files that are told of those that would be lost."""
_MAY_WRITE = stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Give a path to write to; when the block ends well, the file there takes ``path``'s place.

    The file is made beside ``path``, flushed to the disk and moved over it in one step; when the
    block fails it is removed and whatever was at ``path`` stays as it was.

    Raises
    ------
    UnwritableFile
        If the place cannot be written to.
    """
    path = Path(path)
    check_file_place(path)
    with _said_plainly(path):
        # the suffix stays: writers that choose by it must not notice
        handle, name = tempfile.mkstemp(
            prefix=f".{path.stem[:40]}.", suffix=path.suffix, dir=path.parent
        )
    temporary = Path(name)
    try:
        os.close(handle)
        with _said_plainly(path):  # the block's own writing, too: a disk may fill up
            yield temporary
            _copy_permissions(path, temporary)
            _flush(temporary)
            os.replace(temporary, path)
            _flush(path.parent)
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def replacing_directory(
    path: str | Path, others: Callable[[Path], Iterable[str]]
) -> Iterator[Path]:
    """Give a new folder to fill; when the block ends well it takes the place of ``path``.

    Parameters
    ----------
    path
        Where the folder shall be: nothing, an empty folder, or one of ours.
    others
        Returns what in a folder is not ours and would be lost; none where it may be replaced.

    Raises
    ------
    UnwritableFile
        If ``path`` is a file or somebody else's folder, or cannot be written to.
    """
    path = Path(os.path.abspath(path))  # "here/." must have a name to be swapped under
    check_directory_place(path, others)
    with _said_plainly(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        beside = Path(tempfile.mkdtemp(prefix=f".{path.name[:40]}.", dir=path.parent))
    new, old = beside / "new", beside / "old"
    try:
        with _said_plainly(path):
            new.mkdir()
        with _said_plainly(path):
            yield new
            for file in new.rglob("*"):
                _flush(file)
            _swap(path, new, old)
            _flush(path.parent)
    finally:
        shutil.rmtree(beside, ignore_errors=True)


def check_file_place(path: str | Path) -> None:
    """Raise UnwritableFile unless a file can be made at ``path``, or take the place of one there.

    Nothing is written: who works long before writing asks first.
    """
    path = Path(path)
    with _said_plainly(path):
        if path.is_dir():
            raise UnwritableFile(f"{path} is a folder; a file cannot take its place")
        if path.exists() and not path.stat().st_mode & _MAY_WRITE:
            # replacing asks the folder alone, so a protected recording would be lost in silence
            raise UnwritableFile(f"{path} is write-protected; name another file")
        if not path.parent.exists():
            raise UnwritableFile(
                f"{path}: cannot be written: there is no folder {path.parent}; make it first"
            )
        _check_may_write(path.parent)


def check_directory_place(path: str | Path, others: Callable[[Path], Iterable[str]]) -> None:
    """Raise UnwritableFile unless a folder can be made at ``path``, or take the place of ours.

    As `replacing_directory` would, but nothing is written.
    """
    path = Path(os.path.abspath(path))
    with _said_plainly(path):
        if path.exists() and not path.is_dir():
            raise UnwritableFile(f"{path} is a file; a folder cannot take its place")
        if path.is_dir() and (lost := sorted(others(path))):
            listed = ", ".join(lost if len(lost) <= LISTED else [*lost[:LISTED], "…"])
            raise UnwritableFile(
                f"{path} holds other files, which would be lost ({listed}); move them elsewhere, "
                "or name a new or empty folder"
            )
        # the folder itself is swapped for a new one, so its parent is what must be open to us
        _check_may_write(next(above for above in path.parents if above.exists()))


def _check_may_write(folder: Path) -> None:
    if not folder.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
    if not os.access(folder, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))


def _swap(path: Path, new: Path, old: Path) -> None:
    if not path.exists():
        os.replace(new, path)
        return
    os.replace(path, old)
    try:
        os.replace(new, path)
    except OSError:
        os.replace(old, path)
        raise


def _copy_permissions(path: Path, temporary: Path) -> None:
    # mkstemp lets the owner alone read; a file should be as open as the one it replaces
    if path.exists():
        shutil.copymode(path, temporary)
    else:
        mask = os.umask(0)
        os.umask(mask)
        temporary.chmod(0o666 & ~mask)


def _flush(path: Path) -> None:
    if path.is_dir() and os.name == "nt":  # Windows cannot open a folder
        return
    flags = os.O_RDONLY if path.is_dir() else os.O_RDWR
    handle = os.open(path, flags)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


@contextmanager
def _said_plainly(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise UnwritableFile(f"{path}: cannot be written ({error.strerror or error})") from None
