"""Read a mesh: where its triangles lie and, of a rigged glTF, what carries them."""

from pathlib import Path

import numpy as np

from kinesphere.data import Step, Surface
from kinesphere.errors import UnreadableFile
from kinesphere.io.meshes.cleaning import cleaned
from kinesphere.io.meshes.marks import is_ply, is_stl
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
