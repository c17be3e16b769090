"""The skeleton of a glTF file, and a motion of it as that file's animation.

Everything else in the file (meshes, skins, materials, extensions) stays as it is. The rest pose is
the one its nodes stand in; glTF has y up and faces +z.
"""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from kinesphere.data import Array, Motion, Skeleton, Step
from kinesphere.errors import BadModel, UnreadableFile
from kinesphere.geometry.rotations import nearest_rotation, quaternions_from_rotations
from kinesphere.io.atomic import replacing
from kinesphere.io.bones import Bone, skeleton_of_bones
from kinesphere.io.bvh import BVH_FROM_BODY
from kinesphere.io.bvh_hierarchy import MOST_JOINTS
from kinesphere.io.gltf_file import external_files, parse_gltf


class RigJoints(NamedTuple):
    """The nodes of a file's skeleton, parents first."""

    nodes: list[int]
    """Number of each in the file."""
    names: list[str]
    parents: list[int]
    """Index among these; −1 for the first."""
    rest: Array
    """(n, 4, 4) where each stands, in the file's world."""
    around: Array
    """(4, 4) what the first one hangs from, which does not move."""


def read_gltf_skeleton(path: str | Path) -> Skeleton:
    """Read the skeleton of the first skin; without one, that of the nodes that are animated.

    Raises
    ------
    UnreadableFile
        If the file is damaged or holds no skeleton.
    """
    path = Path(path)
    return rig_skeleton(rig_joints(parse_gltf(path).json, path), path)


def rig_skeleton(joints: RigJoints, path: Path) -> Skeleton:
    """Return the joints of a file as a skeleton, its limbs in their order."""
    places = joints.rest[:, :3, 3]
    bones = [
        Bone(name, parent, places[i] - places[parent] if parent >= 0 else places[i], None)
        for i, (name, parent) in enumerate(zip(joints.names, joints.parents, strict=True))
    ]
    skeleton = skeleton_of_bones(bones, 1.0, BVH_FROM_BODY)
    step = Step("read", {"format": "gltf", "file": path.name}, {"n_limbs": len(bones)})
    return Skeleton(skeleton.limbs, skeleton.joints, (step,))


def write_gltf_rig(motion: Motion, rig: Path, path: Path) -> tuple[str, ...]:
    """Write a rig's file with the motion as its first animation; return what is to be known."""
    file = parse_gltf(rig)
    joints = rig_joints(file.json, rig)
    if tuple(joints.names) != motion.skeleton.limb_names:
        raise BadModel(f"the motion is not on the skeleton of {rig}")
    rest = nearest_rotation(joints.rest[:, :3, :3])
    turns = motion.rotations @ BVH_FROM_BODY.T @ rest
    if not (np.isfinite(turns).all() and np.isfinite(motion.origins).all()):
        raise BadModel("the motion has gaps; a rig plays none")
    times = file.add_floats(motion.times, "SCALAR", bounds=True)
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []

    def add(node: int, what: str, values: Array, kind: str) -> None:
        accessor = file.add_floats(values, kind)
        samplers.append({"input": times, "output": accessor, "interpolation": "LINEAR"})
        target = {"node": node, "path": what}
        channels.append({"sampler": len(samplers) - 1, "target": target})

    around = np.linalg.inv(joints.around)
    place = np.c_[motion.origins[:, 0], np.ones(motion.n_frames)] @ around.T
    add(joints.nodes[0], "translation", place[:, :3], "VEC3")
    fixed = nearest_rotation(joints.around[:3, :3])
    for i, (node, parent) in enumerate(zip(joints.nodes, joints.parents, strict=True)):
        above = turns[:, parent] if parent >= 0 else np.broadcast_to(fixed, turns[:, i].shape)
        local = np.swapaxes(above, -1, -2) @ turns[:, i]
        add(node, "rotation", _continuous(quaternions_from_rotations(local)), "VEC4")
        _as_parts(file.json["nodes"][node])
    animation = {"name": "kinesphere", "samplers": samplers, "channels": channels}
    file.json["animations"] = [animation, *file.json.get("animations", [])]
    with replacing(path) as temporary:
        temporary.write_bytes(file.content())
    if file.binary is None and path.parent.resolve() != rig.parent.resolve():
        beside = external_files(file.json)
        if beside:
            return (f"{path.name} needs {', '.join(beside[:5])} beside it, as {rig.name} does",)
    return ()


def rig_joints(document: dict[str, Any], path: Path) -> RigJoints:
    """Return the joints of a file's skeleton; raises UnreadableFile as `read_gltf_skeleton`."""
    try:
        return _found_joints(document, path)
    except (KeyError, IndexError, TypeError, ValueError, AttributeError) as error:
        raise UnreadableFile(
            f"{path}: its nodes or skins are damaged ({type(error).__name__}: {error})"
        ) from None


def _found_joints(document: dict[str, Any], path: Path) -> RigJoints:
    nodes = document.get("nodes", [])
    parent_of = {child: i for i, node in enumerate(nodes) for child in node.get("children", [])}
    inside = _inside(document)
    if not inside:
        raise UnreadableFile(f"{path} has no skin and no nodes that turn: no skeleton to move")
    if len(inside) > MOST_JOINTS:
        raise UnreadableFile(f"{path}: {len(inside)} joints; at most {MOST_JOINTS} are read")
    ways = [_way(joint, parent_of, path) for joint in sorted(inside)]
    shared = [
        step[0] for step in zip(*(w[::-1] for w in ways), strict=False) if len(set(step)) == 1
    ]
    tops = {next(n for n in way[::-1] if n in inside) for way in ways}
    top = tops.pop() if len(tops) == 1 else (shared[-1] if shared else None)
    if top is None:
        raise UnreadableFile(f"{path}: its joints hang from nothing they share")
    wanted = {n for way in ways for n in way[: way.index(top) + 1]}
    order, stack = [], [top]
    while stack:
        node = stack.pop()
        order.append(node)
        stack += [c for c in reversed(nodes[node].get("children", [])) if c in wanted]
    at = {node: i for i, node in enumerate(order)}
    around = np.eye(4)
    for node in _way(top, parent_of, path)[:0:-1]:
        around = around @ node_matrix(nodes[node])
    rest = np.empty((len(order), 4, 4))
    parents = []
    for i, node in enumerate(order):
        parents.append(at.get(parent_of.get(node, -1), -1) if i else -1)
        rest[i] = (rest[parents[i]] if i else around) @ node_matrix(nodes[node])
    if not np.isfinite(rest).all() or (np.abs(np.linalg.det(rest[:, :3, :3])) < 1e-12).any():
        raise UnreadableFile(f"{path}: a node of its skeleton has no size")
    names: list[str] = []
    for i, node in enumerate(order):
        name = str(nodes[node].get("name") or f"joint_{i}")
        names.append(name if name not in names else f"{name}_{node}")
    return RigJoints(order, names, parents, rest, around)


def _inside(document: dict[str, Any]) -> set[int]:
    """Return the joints of the first skin; without one the nodes that an animation turns."""
    if skins := document.get("skins", []):
        return {int(joint) for joint in skins[0]["joints"]}
    turned = {
        int(channel["target"]["node"])
        for animation in document.get("animations", [])
        for channel in animation["channels"]
        if channel["target"]["path"] == "rotation" and "node" in channel["target"]
    }
    bare = {
        i
        for i, node in enumerate(document.get("nodes", []))
        if not {"mesh", "camera", "extensions"} & set(node)
    }
    return turned or bare


def _way(node: int, parent_of: dict[int, int], path: Path) -> list[int]:
    way = [node]
    while way[-1] in parent_of:
        way.append(parent_of[way[-1]])
        if len(way) > MOST_JOINTS:
            raise UnreadableFile(f"{path}: its nodes hang from each other in a circle")
    return way


def node_matrix(node: dict[str, Any]) -> Array:
    """Return where a node stands in its parent, (4, 4)."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    matrix = np.eye(4)
    turn = Rotation.from_quat(node.get("rotation", (0.0, 0.0, 0.0, 1.0))).as_matrix()
    matrix[:3, :3] = turn * np.array(node.get("scale", (1.0, 1.0, 1.0)), dtype=np.float64)
    matrix[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return matrix


def _as_parts(node: dict[str, Any]) -> None:
    """Tell a node's place in parts, as animated nodes must be told."""
    if "matrix" not in node:
        return
    matrix = node_matrix(node)
    del node["matrix"]
    sizes = np.linalg.norm(matrix[:3, :3], axis=0)
    node["translation"] = matrix[:3, 3].tolist()
    node["rotation"] = Rotation.from_matrix(nearest_rotation(matrix[:3, :3])).as_quat().tolist()
    node["scale"] = sizes.tolist()


def _continuous(quaternions: Array) -> Array:
    """Return the same rotations with signs that let programs go the shorter way between them."""
    flips = (quaternions[1:] * quaternions[:-1]).sum(axis=1) < 0
    signs = np.where(np.logical_xor.accumulate(np.concatenate([[False], flips])), -1.0, 1.0)
    return np.asarray(quaternions * signs[:, None])
