"""A motion as glTF: the skeleton standing at rest, its animation, the surface that rides on it."""

from pathlib import Path
from typing import Any

import numpy as np

from kinesphere import __version__
from kinesphere.data import (
    Array,
    Motion,
    Recording,
    Solution,
    Surface,
    TwistJoints,
)
from kinesphere.errors import BadSurface
from kinesphere.geometry.rotations import quaternions_from_rotations
from kinesphere.io.gltf.document import Document, float32
from kinesphere.io.gltf.markers import add_markers
from kinesphere.io.gltf.poses import FRONT_FROM_BODY, node_poses, rest_places
from kinesphere.io.gltf.surface import add_surface, add_twist_joints, animate_twist_joints

_STILL = 1e-7  # m; a joint that strays less from its mean place is not animated
_CONVENTIONS = {
    "length": "m",
    "angle": "rad",
    "world": "right-handed, y up; the axes of the solved motion",
    "limb_axes": "x anterior, y superior, z to the right while standing in the default position",
    "rest": "the default position, standing, arms hanging, looking along +z",
    "node": "named after its limb, turned as its limb, at the joint towards its parent; where a "
    "joint was measured to come apart its node follows the child",
    "gaps": "an unseen limb keeps its last place in its parent; an unseen marker has scale zero",
    "skinning": "linear blend; nodes LIMB_twist_1 to _4 of upper arms, forearms and thighs turn "
    "back about the long axis: skin along the limb takes 0, 1/4, 1/2, 3/4 of its twist",
}


def write_gltf(
    motion: Motion,
    path: str | Path,
    surface: Surface | None = None,
    markers: Recording | None = None,
) -> None:
    """Write a motion as glTF 2.0: binary (``.glb``), or text (``.gltf``) with its bytes inside.

    Parameters
    ----------
    motion
        World with y up. Its limb frames aligned with the body, if the rest pose is to stand.
    surface
        Bound to the motion's skeleton in its default position, as `editing.attach_surface` does.
    markers
        Shown as nodes of their own; its frames are the motion's.

    Raises
    ------
    BadSurface
        If the surface rides on other limbs than the motion has.
    """
    skeleton = motion.skeleton
    if surface is not None and surface.limbs != skeleton.limb_names:
        raise BadSurface(
            f"the surface rides on {', '.join(surface.limbs)}, the motion has "
            f"{', '.join(skeleton.limb_names)}"
        )
    document = Document(_asset(motion))
    rest = rest_places(skeleton)
    ground = rest[:, 1].min() if surface is None else surface.vertices[:, 1].min()
    joints = None if surface is None else TwistJoints(surface)
    _add_limbs(document, motion, rest, float(ground))
    roots = [0]
    if surface is not None and joints is not None:
        add_twist_joints(document, joints)
        roots.append(add_surface(document, surface, joints, rest))
    channels: list[dict[str, Any]] = []
    samplers: list[dict[str, Any]] = []
    times = None
    if motion.n_frames:
        times = document.array(motion.times.astype(np.float32), bounds=True)
        _animate_limbs(document, motion, times, channels, samplers)
        if joints is not None:
            animate_twist_joints(document, joints, motion, times, channels, samplers)
    if markers is not None:
        group = add_markers(document, markers, times, channels, samplers)
        roots += [] if group is None else [group]
    if channels:
        document.add("animations", {"name": "motion", "channels": channels, "samplers": samplers})
    document.add("scenes", {"name": "scene", "nodes": roots})
    document.json["scene"] = 0
    document.write(path)


def write_solution_gltf(solution: Solution, path: str | Path) -> None:
    """Write a solution as glTF: skeleton, animation, markers, and its surface, if it has one."""
    write_gltf(solution.motion, path, solution.surface, solution.recording)


def _asset(motion: Motion) -> dict[str, Any]:
    said = {**_CONVENTIONS, "rate_hz": motion.rate, "first_frame": motion.first_frame}
    return {"version": "2.0", "generator": f"Kinesphere {__version__}", "extras": said}


def _add_limbs(document: Document, motion: Motion, rest: Array, ground: float) -> None:
    """Add a node per limb, in the skeleton's order and so with its indices."""
    skeleton = motion.skeleton
    for limb, name in enumerate(skeleton.limb_names):
        parent = skeleton.parents[limb]
        node: dict[str, Any] = {"name": name}
        if parent < 0:
            node["translation"] = _numbers(FRONT_FROM_BODY @ rest[limb] - [0.0, ground, 0.0])
            node["rotation"] = _numbers(quaternions_from_rotations(FRONT_FROM_BODY))
        else:
            node["translation"] = _numbers(rest[limb] - rest[parent])
        if children := np.flatnonzero(skeleton.parents == limb).tolist():
            node["children"] = children
        document.add("nodes", node)


def _animate_limbs(
    document: Document,
    motion: Motion,
    times: int,
    channels: list[dict[str, Any]],
    samplers: list[dict[str, Any]],
) -> None:
    translations, rotations = node_poses(motion)
    for limb in range(len(motion.skeleton.limbs)):
        tracks = {"rotation": rotations[:, limb]}
        way = translations[:, limb]
        if limb == 0 or np.abs(way - rest_way(document, limb)).max() > _STILL:
            tracks["translation"] = way
        for path, values in tracks.items():
            channels.append({"sampler": len(samplers), "target": {"node": limb, "path": path}})
            samplers.append({"input": times, "output": document.array(float32(values))})


def rest_way(document: Document, limb: int) -> Array:
    """Return the translation a node has at rest, (3,) m."""
    return np.array(document.json["nodes"][limb]["translation"])


def _numbers(vector: Array) -> list[float]:
    return [float(x) for x in np.asarray(vector, dtype=np.float32)]
