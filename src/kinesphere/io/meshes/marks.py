"""What meshes are recognised by."""

import numpy as np

_BEFORE_VERTICES = (b"mtllib", b"usemtl", b"o", b"g", b"s", b"vn", b"vt")


def is_ply(head: bytes) -> bool:
    """Return whether a file begins as PLY does."""
    return head.startswith((b"ply\n", b"ply\r"))


def is_stl(head: bytes) -> bool:
    """Return whether a file begins as STL does, as text or in binary.

    Binary STL has no mark: a count, then a first triangle whose normal is of unit length or zero.
    """
    text = head.lstrip()
    if text.startswith(b"solid") and b"facet" in text:
        return True
    if len(head) < 134:
        return False
    count = int.from_bytes(head[80:84], "little")
    normal = np.frombuffer(head, "<f4", 12, 84).astype(np.float64)
    if not np.isfinite(normal).all() or not 0 < count < 10**8:
        return False
    length = float(np.linalg.norm(normal[:3]))
    return length < 1e-6 or abs(length - 1) < 1e-2


def is_obj(head: bytes) -> bool:
    """Return whether a file begins as OBJ does: comments, names, then a vertex."""
    if b"\0" in head:
        return False
    for line in head.removeprefix(b"\xef\xbb\xbf").splitlines():
        word, *rest = line.split() or [b""]
        if word == b"v":
            return _numbers(rest)
        if word and not word.startswith(b"#") and word not in _BEFORE_VERTICES:
            return False
    return False


def _numbers(words: list[bytes]) -> bool:
    try:
        return len([float(word) for word in words]) >= 3
    except ValueError:
        return False
