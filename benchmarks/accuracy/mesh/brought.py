"""Meshes without limbs: what is found of them beside what is known."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from kinesphere.data import Array, Motion, Surface, bundled_body
from kinesphere.editing import attach_surface
from kinesphere.editing.mesh.rigging import rigged
from kinesphere.editing.mesh.rigging.puppet import Puppet
from kinesphere.io.meshes.gltf_limbs import limbs_of_rig
from kinesphere.io.rig_motion import Bone, skeleton_of_bones

POSES = {"T-pose": 45.0, "A-pose": 0.0, "arms lower": -20.0}
"""Degrees that the bundled body's arms are raised by."""
_OTHER = {"sex": -1.0, "weight": 0.6, "proportions": -0.4}
_Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])  # from z up


def brought_bodies(folder: Path, motion: Motion) -> dict[str, Any]:
    """Return how far joints and weights are off, of the bundled body and of others.

    Parameters
    ----------
    folder
        Real recordings; ``meshes`` in it holds bodies with bones of their own.
    motion
        What they are attached to.
    """
    turn = Rotation.from_euler("x", 90, degrees=True).as_matrix()  # z up
    rows = {}
    for name, shape in (*((pose, {}) for pose in POSES), ("T-pose, another shape", _OTHER)):
        vertices, joints = _posed(POSES.get(name, 45.0), shape)
        body = bundled_body()
        rows[f"bundled, {name}, mm, z up"] = _row(
            (1000 * vertices @ turn.T, body.faces),
            (1000 * joints @ turn.T, body.weights, body.limbs),
            motion,
        )
    for path in sorted(folder.glob("meshes/*_10000.npz")):
        with np.load(path) as stored:
            mesh, known = (stored["vertices"], stored["faces"]), _bones(stored)
        rows[path.stem] = _row(mesh, known, motion)
    return rows


def _row(
    mesh: tuple[Array, NDArray[np.intp]],
    known: tuple[Array, Array, tuple[str, ...]],
    motion: Motion,
) -> dict[str, Any]:
    vertices, faces = mesh
    joints, weights, limbs = known
    body = rigged(Surface.without_limbs(vertices, faces))
    into = np.linalg.lstsq(np.c_[vertices, np.ones(len(vertices))], body.vertices, rcond=None)[0]
    at = [body.limbs.index(name) for name in limbs]
    off = np.linalg.norm(
        np.c_[joints, np.ones(len(joints))] @ into - body.joint_centres[at], axis=1
    )
    wrong = np.abs(body.weights[:, at] - weights).sum(axis=1) / 2
    by_limb = dict(zip(limbs, (1e3 * off).tolist(), strict=True))
    surface = attach_surface(motion, body)
    return {
        "joints_mm": by_limb,
        "lumbar_mm": by_limb.pop("trunk"),
        "mean_mm": float(np.mean(list(by_limb.values()))),
        "worst_mm": max(by_limb.values()),
        "worst": max(by_limb, key=by_limb.__getitem__),
        "weights_percent": 100 * float(wrong.mean()),
        "inverted": surface.history[-1].findings["inverted_triangles"],
        "said": dict(body.history[-1].findings),
    }


def _posed(up_deg: float, shape: dict[str, float]) -> tuple[Array, Array]:
    body = bundled_body().shaped(shape)
    puppet = Puppet(body)
    vector = np.zeros(puppet.parts["shapes"].stop)
    bends = vector[puppet.parts["bends"]].reshape(-1, 3)
    for side, sign in (("left", 1), ("right", -1)):
        bends[body.limbs.index(f"{side}_upper_arm") - 1, 0] = sign * np.radians(up_deg)
    return puppet.vertices(vector), puppet.maps(vector[None])[2][0]


def _bones(stored: Any) -> tuple[Array, Array, tuple[str, ...]]:
    """Return joints, weights and names of our limbs, from a body of another rig."""
    heads, parents = stored["bone_heads"], stored["bone_parents"]
    upright = heads @ _Y_UP.T
    bones = [
        Bone(str(name), int(parent), upright[i] - (upright[parent] if parent >= 0 else 0.0), None)
        for i, (name, parent) in enumerate(zip(stored["bone_names"], parents, strict=True))
    ]
    limbs = limbs_of_rig(skeleton_of_bones(bones, 1.0, np.eye(3)))
    assert limbs is not None
    weights = np.zeros((len(stored["vertices"]), len(limbs.names)))
    for bone, limb in enumerate(limbs.of_joint):
        weights[:, limb] += stored["weights"][:, bone]
    return heads[limbs.begins], weights, limbs.names
