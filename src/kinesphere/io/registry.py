"""Which formats there are: read by what a file holds, written by how it is called."""

import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import Any, BinaryIO

from kinesphere.errors import UnknownFormat, UnreadableFile

HEAD_BYTES = 4096
"""How much of a file a format may look at to recognise it."""
_PART_BYTES = 2**24


@dataclass(frozen=True)
class Format:
    """One kind of file or folder.

    Functions are named ``"module:function"`` and imported when they are first used, so that
    knowing many formats costs nothing.
    """

    name: str
    """What people call it: ``C3D``."""
    suffixes: tuple[str, ...]
    """Lower case, with the dot; the first is the usual one. A folder has the suffix ``""``."""
    recognises: Callable[[bytes], bool] | None = None
    """Given the first ``HEAD_BYTES`` of a file: is it one of these? Cheap, never raises."""
    recognises_folder: Callable[[Path], bool] | None = None
    """The same for a folder."""
    reader: str = ""
    """Called with a path."""
    writers: Mapping[str, str] = field(default_factory=dict)
    """Name of a container (``Recording``) → function called with the container and a path."""

    def is_named_by(self, path: Path) -> bool:
        """Return whether a path is called as one of these; ``a.limbs.csv`` is a ``.csv``, too."""
        suffix = "" if path.is_dir() else path.suffix.lower()
        longer = path.name.lower().endswith(tuple(s for s in self.suffixes if s))
        return suffix in self.suffixes or (suffix != "" and longer)


_formats: list[Format] = []


def register(new: Format) -> None:
    """Add a format; those registered first are asked first."""
    _formats.append(new)


def known_formats() -> tuple[Format, ...]:
    """Return every format, in the order they are asked."""
    return tuple(_formats)


def read(path: str | Path) -> Any:
    """Read a file or folder of any known format, recognised by its content.

    Raises
    ------
    UnreadableFile
        If there is nothing at ``path``, nothing in it, or it is damaged.
    UnknownFormat
        If no reader recognises it.
    """
    path = Path(path)
    return function_named(_recognise(path).reader)(path)


def write(obj: Any, path: str | Path) -> None:
    """Write a container in the format that the suffix of ``path`` names.

    Raises
    ------
    UnknownFormat
        If no format has that suffix, or the one that has cannot hold such a container.
    """
    path = Path(path)
    kind = type(obj).__name__
    able = [f for f in _formats if kind in f.writers]
    if not able:
        raise UnknownFormat(f"{path}: nothing can write a {kind}")
    for candidate in able:
        if candidate.is_named_by(path):
            function_named(candidate.writers[kind])(obj, path)
            return
    raise no_format(path, kind)


def no_format(path: Path, kind: str, *others: str) -> UnknownFormat:
    """Return the error that no format of a container, or of what can be made of it, is named so."""
    suffix = path.suffix.lower() if not path.is_dir() else ""
    able = [f for f in _formats if {kind, *others} & set(f.writers)]
    named = (f"{', '.join(s or 'a folder' for s in f.suffixes)} ({f.name})" for f in able)
    shown = f"suffix {suffix!r}" if suffix else "no suffix"
    known = ", ".join(named)
    return UnknownFormat(f"{path}: {shown} names no format that holds a {kind}; known: {known}")


def read_bytes(path: Path, limit: int | None = None, stop: bytes = b"") -> bytes:
    """Return the (first ``limit``) bytes of a file, or say plainly why there are none.

    Reading ends soon after the first ``stop``, so that a huge file that is none of ours costs
    neither time nor memory.
    """
    try:
        if path.is_dir():
            raise UnreadableFile(f"{path} is a folder, not a file")
        if path.exists() and not path.is_file():
            raise UnreadableFile(f"{path} is a device or a pipe, not a file")
        with path.open("rb") as file:
            if stop:
                content = b"".join(_until(file, stop))
            else:
                size = max(os.fstat(file.fileno()).st_size, HEAD_BYTES)
                content = file.read(size if limit is None else min(limit, size))
    except FileNotFoundError:
        raise UnreadableFile(f"{path}: there is no such file") from None
    except (OSError, ValueError) as error:  # ValueError: a null character in the path
        raise UnreadableFile(f"{path}: cannot be read ({error})") from None
    if not content:
        raise UnreadableFile(f"{path} is empty")
    return content


def _until(file: BinaryIO, stop: bytes) -> Iterator[bytes]:
    while part := file.read(_PART_BYTES):
        yield part
        if stop in part:
            return


def _recognise(path: Path) -> Format:
    readable = [f for f in _formats if f.reader]
    names = ", ".join(f.name for f in readable)
    if _is_folder(path):
        for candidate in readable:
            if candidate.recognises_folder and candidate.recognises_folder(path):
                return candidate
        raise UnknownFormat(f"{path} is a folder, and none that Kinesphere wrote; known: {names}")
    head = read_bytes(path, HEAD_BYTES)
    for candidate in readable:
        if candidate.recognises and candidate.recognises(head):
            return candidate
    named = [f.name for f in readable if path.suffix.lower() in f.suffixes and path.suffix]
    claim = f"is called {path.suffix} but holds" if named else "holds"
    raise UnknownFormat(f"{path} {claim} {_describe(head)}; known: {names}")


def _is_folder(path: Path) -> bool:
    try:
        return path.is_dir()
    except (OSError, ValueError):  # read_bytes says it better
        return False


def _describe(head: bytes) -> str:
    try:
        text = head.decode("utf-8")
    except UnicodeDecodeError as error:
        cut_short = error.start > len(head) - 4 and len(head) == HEAD_BYTES
        text = head[: error.start].decode("utf-8") if cut_short else ""
    if text and "\0" not in text:
        line = next((line.strip() for line in text.splitlines() if line.strip()), "")
        return f"text that begins {line[:40]!r}" if line else "nothing but blanks"
    return f"unknown binary data (first bytes {head[:4].hex(' ')})"


def function_named(name: str) -> Callable[..., Any]:
    """Import what a format calls ``"module:function"``."""
    module, _, function = name.partition(":")
    found: Callable[..., Any] = getattr(import_module(module), function)
    return found
