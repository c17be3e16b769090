"""The surface of a glTF file: mesh, skin, and the nodes that spread twist over it."""

from typing import Any

import numpy as np

from kinesphere.data import Array, Motion, Surface, TwistJoints, poses_without_gaps
from kinesphere.geometry.rotations import quaternions_from_rotations
from kinesphere.io.gltf.document import INDICES, VERTICES, Document, float32
from kinesphere.io.gltf.poses import continuous


def add_twist_joints(document: Document, joints: TwistJoints) -> None:
    """Add the nodes that spread twist, below their limbs and after all of them."""
    for limb, name in zip(joints.limbs, joints.names, strict=True):
        node = document.add("nodes", {"name": name})
        document.json["nodes"][limb].setdefault("children", []).append(node)


def animate_twist_joints(
    document: Document,
    joints: TwistJoints,
    motion: Motion,
    times: int,
    channels: list[dict[str, Any]],
    samplers: list[dict[str, Any]],
) -> None:
    """Append the turns of the nodes that spread twist to an animation."""
    rotations, _ = poses_without_gaps(motion)
    turns = continuous(quaternions_from_rotations(joints.turns(rotations)))
    first = len(motion.skeleton.limbs)
    for k in range(turns.shape[1]):
        target = {"node": first + k, "path": "rotation"}
        channels.append({"sampler": len(samplers), "target": target})
        samplers.append({"input": times, "output": document.array(float32(turns[:, k]))})


def add_surface(document: Document, surface: Surface, joints: TwistJoints, rest: Array) -> int:
    """Add mesh, skin and the node that carries both; return that node."""
    places = np.vstack([rest, rest[joints.limbs]])
    limbs, shares = joints.weights
    inverse = np.tile(np.eye(4, dtype=np.float32), (len(places), 1, 1))
    inverse[:, 3, :3] = -places  # column by column, as glTF wants it
    skin = document.add(
        "skins",
        {
            "name": "body",
            "joints": list(range(len(places))),
            "skeleton": 0,
            "inverseBindMatrices": document.array(inverse),
        },
    )
    material = document.add(
        "materials",
        {
            "name": "body",
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.72, 0.66, 0.6, 1.0],
                "metallicFactor": 0.0,
                "roughnessFactor": 0.85,
            },
        },
    )
    index = np.uint16 if surface.n_vertices < 2**16 - 1 else np.uint32
    attributes = {
        "POSITION": document.array(float32(surface.vertices), VERTICES, bounds=True),
        "NORMAL": document.array(float32(surface.normals()), VERTICES),
        "JOINTS_0": document.array(
            limbs.astype(np.uint8 if len(places) < 256 else np.uint16), VERTICES
        ),
        "WEIGHTS_0": document.array(float32(shares), VERTICES),
    }
    primitive = {
        "attributes": attributes,
        "indices": document.array(surface.faces.ravel().astype(index), INDICES),
        "material": material,
    }
    mesh = document.add("meshes", {"name": "body", "primitives": [primitive]})
    return document.add("nodes", {"name": "body", "mesh": mesh, "skin": skin})
