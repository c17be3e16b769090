"""Text files, with every way they can fail to be text said in one line."""

from pathlib import Path

from kinesphere.errors import UnreadableFile
from kinesphere.io.registry import read_bytes


def read_text(path: Path) -> str:
    r"""Return a text file's content with every line end as ``\n``.

    UTF-8 with or without a byte-order mark; what is no UTF-8 is taken for Latin-1, which old
    programs wrote.

    Raises
    ------
    UnreadableFile
        If the file is missing, a folder, empty or binary.
    """
    raw = read_bytes(path, stop=b"\0")
    if not raw.strip():
        raise UnreadableFile(f"{path} holds nothing but blanks")
    if (at := raw.find(b"\0")) >= 0:
        line = raw.count(b"\n", 0, at) + 1
        raise UnreadableFile(f"{path}: line {line} holds binary data; text was expected")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")
    return text.replace("\r\n", "\n").replace("\r", "\n")
