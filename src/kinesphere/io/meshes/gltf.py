"""Read the mesh of a glTF file, with the limbs and weights of its own where it is rigged."""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from kinesphere.data import Array, Skeleton, Step, Surface
from kinesphere.errors import BadSurface, UnreadableFile
from kinesphere.io.gltf_file import GltfFile, parse_gltf
from kinesphere.io.meshes.cleaning import cleaned
from kinesphere.io.meshes.gltf_arrays import GltfArrays
from kinesphere.io.meshes.gltf_limbs import limbs_of_rig
from kinesphere.io.meshes.gltf_surface import rigged_surface
from kinesphere.io.rig_gltf import (
    node_matrix,
    read_gltf_skeleton,
    rig_joints,
    rig_skeleton,
)

_TRIANGLES = 4
_MOST_DEEP = 1000


class Part(NamedTuple):
    """One list of triangles of a file."""

    node: int
    vertices: Array
    """(n, 3), as stored."""
    faces: np.ndarray[Any, np.dtype[np.intp]]
    joints: Array | None
    """(n, k) which of its skin's joints carry each vertex."""
    weights: Array | None
    """(n, k)."""


def read_gltf(path: str | Path) -> Surface | Skeleton:
    """Read the mesh of a ``.glb`` or ``.gltf`` file; of a file without one, its skeleton.

    A mesh that rides on a skeleton whose arms and legs can be told, by name or by the shape of the
    tree, comes with our limbs, as bound; any other without limbs. In the axes of the file.

    Raises
    ------
    UnreadableFile
        If the file is damaged or compressed.
    BadSurface
        If its mesh cannot be used: too many triangles, too few, vertices that are nowhere.
    """
    path = Path(path)
    file = parse_gltf(path)
    if not file.json.get("meshes"):
        return read_gltf_skeleton(path)
    try:
        return _surface(file, path)
    except (KeyError, IndexError, TypeError, ValueError, AttributeError, OverflowError) as error:
        raise UnreadableFile(
            f"{path}: its meshes are damaged ({type(error).__name__}: {error})"
        ) from None


def _surface(file: GltfFile, path: Path) -> Surface:
    arrays = GltfArrays(file, path)
    parts = [
        part
        for node, told in enumerate(file.json.get("nodes", []))
        if "mesh" in told
        for part in _parts(file.json, arrays, node)
    ]
    settings: dict[str, Any] = {"format": "gltf", "file": path.name}
    skins = file.json.get("skins", [])
    warnings: tuple[str, ...] = ()
    if skins and any(part.joints is not None for part in parts):
        joints = rig_joints(file.json, path)
        if (limbs := limbs_of_rig(rig_skeleton(joints, path))) is not None:
            return rigged_surface(file, path, arrays, parts, joints, limbs, settings)
        warnings = (
            f"the joints of {path.name} could not be matched to arms and legs "
            f"({', '.join(joints.names[:4])}…): its weights are not used",
        )
    if any(part.joints is not None for part in parts):
        parts = [part for part in parts if part.joints is not None]  # what lies about is no body
    places = [_place(file.json["nodes"], part) for part in parts]
    vertices = [
        part.vertices @ place[:3, :3].T + place[:3, 3]
        for part, place in zip(parts, places, strict=True)
    ]
    starts = np.cumsum([0, *map(len, vertices)])
    faces = [part.faces + start for part, start in zip(parts, starts[:-1], strict=True)]
    whole = np.vstack([np.zeros((0, 3)), *vertices])
    kept, joined = cleaned(whole, np.vstack([np.zeros((0, 3), dtype=np.intp), *faces]), str(path))
    step = Step("read", settings, {"n_triangles": len(joined)}, warnings)
    return Surface.without_limbs(whole[kept], joined, (step,))


def _parts(document: dict[str, Any], arrays: GltfArrays, node: int) -> list[Part]:
    found = []
    told = document["nodes"][node]
    for primitive in document["meshes"][told["mesh"]]["primitives"]:
        if primitive.get("mode", _TRIANGLES) != _TRIANGLES:
            continue
        if "KHR_draco_mesh_compression" in primitive.get("extensions", {}):
            raise UnreadableFile(f"{arrays.path} is compressed; export it without compression")
        names = primitive["attributes"]
        vertices = arrays[names["POSITION"]]
        corners = (
            arrays[primitive["indices"]].astype(np.intp).ravel()
            if "indices" in primitive
            else np.arange(len(vertices))
        )
        if len(corners) % 3:
            raise BadSurface(f"{arrays.path}: {len(corners)} corners make no triangles")
        joints = weights = None
        sets = [k for k in range(4) if f"JOINTS_{k}" in names and f"WEIGHTS_{k}" in names]
        if "skin" in told and sets:
            joints = np.hstack([arrays[names[f"JOINTS_{k}"]] for k in sets])
            weights = np.hstack([arrays[names[f"WEIGHTS_{k}"]] for k in sets])
        found.append(Part(node, vertices, corners.reshape(-1, 3), joints, weights))
    return found


def _place(nodes: list[dict[str, Any]], part: Part) -> Array:
    """Return where a part lies, (4, 4); what is skinned does not lie where its node does."""
    return np.eye(4) if part.joints is not None else _world(nodes, part.node)


def _world(nodes: list[dict[str, Any]], node: int) -> Array:
    above = {child: i for i, told in enumerate(nodes) for child in told.get("children", [])}
    matrix, at = node_matrix(nodes[node]), node
    for _ in range(_MOST_DEEP):
        if at not in above:
            return matrix
        at = above[at]
        matrix = node_matrix(nodes[at]) @ matrix
    raise UnreadableFile("nodes hang from each other in a circle")
