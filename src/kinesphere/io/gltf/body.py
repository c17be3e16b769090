"""A rigged character as a body: its skin, with bones gathered into the limbs of the house."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Step, Surface
from kinesphere.errors import BadSurface, UnreadableFile
from kinesphere.io.gltf.bone_names import limb_of_bone
from kinesphere.io.gltf.read import GltfFile

_NEEDED = (
    *("pelvis", "trunk", "head"),
    *(
        f"{side}_{limb}"
        for side in ("left", "right")
        for limb in ("upper_arm", "forearm", "hand", "thigh", "shank", "foot")
    ),
)
_ORDER = (*_NEEDED, "left_clavicle", "right_clavicle")
_TRIANGLES = 4
_SAME = 1e-5
"""m; vertices nearer than this are one: files split them where textures do."""
_HEIGHTS = (0.3, 3.0)
"""m; a body is as tall as that."""
_MOST = 4
"""Limbs a vertex rides on."""


def read_body(path: str | Path) -> Surface:
    """Read the skin and bones of a rigged glTF file as it stands.

    Bones are told by their names, those of common rigs; bones that are no limb (fingers, twist
    bones) belong to the next limb inward. The body is turned to face x, y up.

    Raises
    ------
    UnreadableFile
        If it is no glTF, or holds no skinned mesh.
    BadSurface
        If a limb is not found by name, or the parts do not fit together.
    """
    path = Path(path)
    file = GltfFile(path)
    skin, primitives = _skinned(file)
    bones = [int(bone) for bone in skin["joints"]]
    world = file.world_from_node()
    limb_of, named = _limbs(file, bones, path)
    points, faces, shares = _mesh(file, primitives, skin, world[bones], path)
    order = [name for name in _ORDER if name in named]
    order.sort(key=lambda name: (_depth(file, named[name]), _ORDER.index(name)))
    order.remove("pelvis")
    order.insert(0, "pelvis")
    weights = np.zeros((len(points), len(order)))
    for bone, limb in enumerate(limb_of):
        weights[:, order.index(limb)] += shares[:, bone]
    weights = _heaviest(weights)
    starts = {name: world[node, :3, 3] for name, node in named.items()}
    turn = _house_from_file(starts, path)
    points = points @ turn.T
    if not _HEIGHTS[0] <= (tall := float(np.ptp(points[:, 1]))) <= _HEIGHTS[1]:
        raise BadSurface(
            f"{path}: the body is {tall:.3g} m tall; glTF is in metres, scale it when exporting"
        )
    centres = np.array([starts[name] @ turn.T for name in order])
    parents = np.array([_parent(name, order) for name in order])
    ends = _ends(order, centres, points, weights)
    step = Step(
        "read", settings={"file": path.name, "format": "glTF"}, findings={"bones": len(bones)}
    )
    return Surface(points, faces, tuple(order), parents, centres, ends, weights, history=(step,))


def _skinned(file: GltfFile) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """Return the skin that most triangles ride on, and its primitives."""
    meshes, skins = file.entries("meshes"), file.entries("skins")
    found: dict[int, list[dict[str, Any]]] = {}
    for node in file.entries("nodes"):
        if "skin" in node and "mesh" in node:
            whole = meshes[node["mesh"]]["primitives"]
            usable = [
                p
                for p in whole
                if p.get("mode", _TRIANGLES) == _TRIANGLES and "JOINTS_0" in p["attributes"]
            ]
            found.setdefault(node["skin"], []).extend(usable)
    found = {skin: parts for skin, parts in found.items() if parts}
    if not found:
        raise UnreadableFile(f"{file.path} holds no skinned mesh; a rigged character is wanted")
    sizes = {
        skin: sum(file.entries("accessors")[p["attributes"]["POSITION"]]["count"] for p in parts)
        for skin, parts in found.items()
    }
    best = max(sizes, key=lambda skin: sizes[skin])
    return skins[best], found[best]


def _limbs(file: GltfFile, bones: list[int], path: Path) -> tuple[list[str], dict[str, int]]:
    """Return each bone's limb, and the node that each limb begins with."""
    nodes = file.entries("nodes")
    parent = {child: i for i, node in enumerate(nodes) for child in node.get("children", ())}
    names = {i: limb_of_bone(str(node.get("name", ""))) for i, node in enumerate(nodes)}
    named: dict[str, int] = {}
    for node in sorted(bones, key=lambda i: _depth(file, i)):
        limb = names[node]
        if limb is not None:
            named.setdefault(limb, node)  # of several spine bones the lowest begins the trunk
    if missing := [name for name in _NEEDED if name not in named]:
        known = ", ".join(str(nodes[i].get("name", i)) for i in bones[:12])
        raise BadSurface(
            f"{path}: no bone is named like {', '.join(missing)}; there are {known}"
            + (", …" if len(bones) > 12 else "")
        )
    limb_of = []
    for node in bones:
        at: int | None = node
        while at is not None and (names[at] is None or names[at] not in named):
            at = parent.get(at)
        limb_of.append("pelvis" if at is None else str(names[at]))
    return limb_of, named


def _depth(file: GltfFile, node: int) -> int:
    parent = {c: i for i, n in enumerate(file.entries("nodes")) for c in n.get("children", ())}
    depth = 0
    while node in parent:
        node, depth = parent[node], depth + 1
    return depth


def _mesh(
    file: GltfFile,
    primitives: list[dict[str, Any]],
    skin: dict[str, Any],
    world_from_bone: Array,
    path: Path,
) -> tuple[Array, NDArray[np.intp], Array]:
    """Return the posed vertices, the faces and each vertex's share of every bone."""
    n_bones = len(world_from_bone)
    if "inverseBindMatrices" in skin:
        inverse = file.array(skin["inverseBindMatrices"]).astype(np.float64).transpose(0, 2, 1)
    else:
        inverse = np.tile(np.eye(4), (n_bones, 1, 1))
    if len(inverse) != n_bones:
        raise UnreadableFile(f"{path}: {n_bones} bones have {len(inverse)} bind matrices")
    moved = world_from_bone @ inverse
    points, faces, shares, count = [], [], [], 0
    for part in primitives:
        rest = file.array(part["attributes"]["POSITION"]).astype(np.float64)
        own = np.zeros((len(rest), n_bones))
        for i in range(4):
            if f"JOINTS_{i}" not in part["attributes"]:
                break
            which = file.array(part["attributes"][f"JOINTS_{i}"]).astype(np.intp)
            much = file.array(part["attributes"][f"WEIGHTS_{i}"]).astype(np.float64)
            if which.size and which.max() >= n_bones:
                raise UnreadableFile(f"{path}: a vertex rides on bone {which.max()} of {n_bones}")
            for bone, share in zip(which.T, much.T, strict=True):
                np.add.at(own, (np.arange(len(rest)), bone), share)
        own /= np.maximum(own.sum(axis=1, keepdims=True), 1e-12)
        homogeneous = np.concatenate([rest, np.ones((len(rest), 1))], axis=1)
        points.append(np.einsum("vb,bij,vj->vi", own, moved, homogeneous, optimize=True)[:, :3])
        indices = file.array(part["indices"]) if "indices" in part else np.arange(len(rest))
        faces.append(indices.astype(np.intp).reshape(-1, 3) + count)
        shares.append(own)
        count += len(rest)
    return _welded(np.concatenate(points), np.concatenate(faces), np.concatenate(shares))


def _welded(
    points: Array, faces: NDArray[np.intp], shares: Array
) -> tuple[Array, NDArray[np.intp], Array]:
    """Return the mesh with vertices at one place made one, and faces without area left out."""
    _, first, new = np.unique(
        np.round(points / _SAME).astype(np.int64), axis=0, return_index=True, return_inverse=True
    )
    faces = new.reshape(-1)[faces]
    a, b, c = faces.T
    return points[first], faces[(a != b) & (b != c) & (c != a)], shares[first]


def _heaviest(weights: Array) -> Array:
    """Return shares of the four heaviest limbs alone, adding up to one."""
    if weights.shape[1] > _MOST:
        least = -np.sort(-weights, axis=1)[:, _MOST - 1 : _MOST]
        weights = np.where(weights >= np.maximum(least, 1e-9), weights, 0.0)
    kept: Array = weights / weights.sum(axis=1, keepdims=True)
    return kept


def _house_from_file(starts: dict[str, Array], path: Path) -> Array:
    """Return the turn, (3, 3), to x ahead, y up, z to the right, by where the limbs are."""
    up = starts["head"] - starts["pelvis"]
    right = sum(starts[f"right_{n}"] - starts[f"left_{n}"] for n in ("thigh", "upper_arm"))
    up = np.eye(3)[np.abs(up).argmax()] * np.sign(up[np.abs(up).argmax()])
    right = right - (right @ up) * up
    length = float(np.linalg.norm(right))
    if not length > 0:
        raise BadSurface(f"{path}: left and right limbs begin at one place")
    right = right / length
    if (snapped := np.abs(right).max()) > np.cos(np.radians(10)):  # modelled along an axis
        right = np.where(np.abs(right) == snapped, np.sign(right), 0.0)
    return np.stack([np.cross(up, right), up, right])


def _parent(name: str, order: list[str]) -> int:
    side = next((s for s in ("left_", "right_") if name.startswith(s)), "")
    kind = name.removeprefix(side)
    inward = {
        "trunk": ("pelvis",),
        "head": ("trunk",),
        "clavicle": ("trunk",),
        "upper_arm": (f"{side}clavicle", "trunk"),
        "forearm": (f"{side}upper_arm",),
        "hand": (f"{side}forearm",),
        "thigh": ("pelvis",),
        "shank": (f"{side}thigh",),
        "foot": (f"{side}shank",),
    }.get(kind, ())
    return next((order.index(limb) for limb in inward if limb in order), -1)


def _ends(order: list[str], centres: Array, points: Array, weights: Array) -> Array:
    """Return where limbs end: at the next joint, or at their farthest skin."""
    at = {name: i for i, name in enumerate(order)}
    onward = {"pelvis": "trunk", "trunk": "head"}
    for side in ("left_", "right_"):
        onward |= {
            f"{side}clavicle": f"{side}upper_arm",
            f"{side}upper_arm": f"{side}forearm",
            f"{side}forearm": f"{side}hand",
            f"{side}thigh": f"{side}shank",
            f"{side}shank": f"{side}foot",
        }
    ends = np.empty_like(centres)
    for name, i in at.items():
        if name in onward:
            ends[i] = centres[at[onward[name]]]
            continue
        own = points[weights[:, i] > 0.5]
        if not len(own):
            own = centres[i][None]
        if name == "head":
            crown = own[own[:, 1] >= np.quantile(own[:, 1], 0.9)]
            ends[i] = [crown[:, 0].mean(), own[:, 1].max(), crown[:, 2].mean()]
        elif name.endswith("foot"):
            tip = own[own[:, 0] >= np.quantile(own[:, 0], 0.97)]
            ends[i] = tip.mean(axis=0)
        else:
            far = np.linalg.norm(own - centres[i], axis=1)
            ends[i] = own[far >= np.quantile(far, 0.97)].mean(axis=0)
    return ends
