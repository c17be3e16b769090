"""A rigged glTF mesh as a surface on our limbs."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from kinesphere.data import Array, Step, Surface
from kinesphere.errors import BadSurface
from kinesphere.io.gltf_file import GltfFile
from kinesphere.io.meshes.cleaning import cleaned
from kinesphere.io.meshes.gltf_arrays import GltfArrays
from kinesphere.io.meshes.gltf_limbs import RigLimbs
from kinesphere.io.rig_gltf import RigJoints

if TYPE_CHECKING:
    from kinesphere.io.meshes.gltf import Part

_MINE = 0.5  # share from which a vertex tells where a limb ends


def rigged_surface(
    file: GltfFile,
    path: Path,
    arrays: GltfArrays,
    parts: "list[Part]",
    joints: RigJoints,
    limbs: RigLimbs,
    settings: dict[str, Any],
) -> Surface:
    """Return the skinned parts of a file as they were bound, on our limbs.

    Joints lie where the inverse bind matrices say; one that carries nothing, where it stands among
    those that do. Several skins are brought into the space of the first by a joint they share.
    """
    skinned = [part for part in parts if part.joints is not None]
    index = {node: i for i, node in enumerate(joints.nodes)}
    binds = _binds(file, arrays, index)
    first = next(iter(binds.values()))
    vertices, faces, weights, count = [], [], [], 0
    for part in skinned:
        assert part.joints is not None
        assert part.weights is not None
        skin = int(file.json["nodes"][part.node]["skin"])
        of_skin = np.array([index[int(n)] for n in file.json["skins"][skin]["joints"]])
        shared = next((k for k in binds[skin] if k in first), None)
        if shared is None:
            raise BadSurface(f"{path}: its skins share no joint")
        into = first[shared] @ np.linalg.inv(binds[skin][shared])
        vertices.append(part.vertices @ into[:3, :3].T + into[:3, 3])
        faces.append(part.faces + count)
        count += len(part.vertices)
        carried = np.zeros((len(part.vertices), len(limbs.names)))
        chosen = limbs.of_joint[of_skin[part.joints.astype(np.intp)]]
        for column, share in zip(chosen.T, part.weights.T, strict=True):
            carried[np.arange(len(carried)), column] += np.maximum(share, 0.0)
        weights.append(carried)
    whole, kept_faces = np.vstack(vertices), np.vstack(faces)
    kept, kept_faces = cleaned(whole, kept_faces, str(path))
    places = _places(first, joints)
    begins = places[limbs.begins]
    shares = _four(np.vstack(weights)[kept])
    step = Step(
        "read",
        settings,
        {
            "n_triangles": len(kept_faces),
            "limbs_from": limbs.source,
            "joints": {
                limb: joints.names[k] for limb, k in zip(limbs.names, limbs.begins, strict=True)
            },
        },
    )
    return Surface(
        vertices=whole[kept],
        faces=kept_faces,
        limbs=limbs.names,
        parents=limbs.parents,
        joint_centres=begins,
        ends=_ends(whole[kept], shares, limbs, begins),
        weights=shares,
        history=(step,),
    )


def _binds(
    file: GltfFile, arrays: GltfArrays, index: dict[int, int]
) -> dict[int, dict[int, Array]]:
    """Return skin → joint → ``mesh_from_joint`` (4, 4) as bound."""
    found = {}
    for number, skin in enumerate(file.json["skins"]):
        nodes = [int(node) for node in skin["joints"]]
        if any(node not in index for node in nodes):
            continue
        inverse = (
            arrays[skin["inverseBindMatrices"]].reshape(-1, 4, 4).transpose(0, 2, 1)
            if "inverseBindMatrices" in skin
            else np.tile(np.eye(4), (len(nodes), 1, 1))
        )
        found[number] = {
            index[node]: np.linalg.inv(matrix) for node, matrix in zip(nodes, inverse, strict=True)
        }
    return found


def _places(bound: dict[int, Array], joints: RigJoints) -> Array:
    """Return where joints are in the space of the mesh, (n_joints, 3)."""
    some = next(iter(bound))
    into = bound[some] @ np.linalg.inv(joints.rest[some])
    standing = joints.rest[:, :3, 3] @ into[:3, :3].T + into[:3, 3]
    for joint, matrix in bound.items():
        standing[joint] = matrix[:3, 3]
    return np.asarray(standing)


def _ends(vertices: Array, weights: Array, limbs: RigLimbs, begins: Array) -> Array:
    """Return where limbs end: at the next joint, or at the farthest vertex that is theirs."""
    ends = begins.copy()
    for limb, name in enumerate(limbs.names):
        below = [
            k
            for k in np.flatnonzero(limbs.parents == limb)
            if name != "trunk" or limbs.names[k] == "head"
        ]
        own = vertices[weights[:, limb] > _MINE]
        if name == "pelvis":
            below = [k for k in below if limbs.names[k] == "trunk"]
        if len(below):
            ends[limb] = begins[below[0]]
        elif len(own):
            ends[limb] = own[np.linalg.norm(own - begins[limb], axis=1).argmax()]
    return ends


def _four(weights: Array) -> Array:
    """Return weights of four limbs at most that add up to one; without any, the root's."""
    weights = weights.copy()
    weights[weights.sum(axis=1) <= 0, 0] = 1.0
    order = np.argsort(-weights, axis=1, kind="stable")[:, 4:]
    np.put_along_axis(weights, order, 0.0, axis=1)
    return np.asarray(weights / weights.sum(axis=1, keepdims=True))
