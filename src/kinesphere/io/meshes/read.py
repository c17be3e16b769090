"""Read a mesh: where its triangles lie and, of a rigged glTF, what carries them."""

from pathlib import Path

import numpy as np

from kinesphere.data import Step, Surface
from kinesphere.errors import UnreadableFile
from kinesphere.io.meshes.cleaning import cleaned
from kinesphere.io.registry import read_bytes

_MOST_BYTES = 500_000_000


def read_mesh(path: str | Path) -> Surface:
    """Read OBJ, PLY or STL: a mesh without limbs, in its own unit and axes.

    Several objects are taken as one. Colours, textures and materials are left behind.

    Raises
    ------
    UnreadableFile
        If the file is missing or damaged.
    BadSurface
        If it holds no triangles, too many, or vertices that are nowhere.
    """
    path = Path(path)
    kind = mesh_format(path)
    if path.stat().st_size > _MOST_BYTES:
        raise UnreadableFile(f"{path} is over {_MOST_BYTES // 10**6} MB: decimate the mesh first")
    import trimesh  # half a second, and few need it

    try:
        scene = trimesh.load_scene(
            str(path), file_type=kind, process=False, maintain_order=True, skip_materials=True
        )
        mesh = scene.to_mesh()
        vertices = np.asarray(mesh.vertices, dtype=np.float64).reshape(-1, 3)
        faces = np.asarray(mesh.faces, dtype=np.intp).reshape(-1, 3)
    except Exception as error:  # a reader of files from anywhere fails in any way
        reason = f"{type(error).__name__}: {error}".splitlines()[0]
        raise UnreadableFile(f"{path} is a damaged {kind.upper()} file ({reason:.120})") from None
    kept, faces = cleaned(vertices, faces, str(path))
    step = Step("read", {"format": kind, "file": path.name}, {"n_triangles": len(faces)})
    return Surface.without_limbs(vertices[kept], faces, (step,))


def mesh_format(path: Path) -> str:
    """Return ``obj``, ``ply`` or ``stl`` by content."""
    head = read_bytes(path, 4096)
    if is_ply(head):
        return "ply"
    return "stl" if is_stl(head) else "obj"


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
        if word and not word.startswith(b"#") and word not in (b"mtllib", b"o", b"g", b"s", b"usemtl"):
            return False
    return False


def _numbers(words: list[bytes]) -> bool:
    try:
        return len([float(word) for word in words]) >= 3
    except ValueError:
        return False
