"""A rig that stands as its maker left it, brought to stand as the bundled body does.

Joint limits, rest and first poses count from the bind pose. Characters are bound with their arms
out (T), half down (A) or hanging; one whose arms hang would have its limits in the wrong place.
"""

from dataclasses import replace

import numpy as np

from kinesphere.data import Array, Step, Surface, bundled_body
from kinesphere.geometry.rotations import rotation_between

_TURNED = ("upper_arm", "forearm", "hand", "thigh", "shank", "foot")
"""Limbs whose direction is a matter of pose; where pelvis, trunk and head end is one of anatomy."""


def standing_as_bundled(surface: Surface) -> Surface:
    """Return a body whose arms and legs point where those of the bundled body do.

    Each limb is turned the shortest way, what hangs from it moves along, and the skin is blended
    between limbs as in any pose.
    """
    model = bundled_body()
    turns = np.tile(np.eye(3), (len(surface.limbs), 1, 1))
    centres = surface.joint_centres.copy()
    largest = 0.0
    for limb, (name, parent) in enumerate(zip(surface.limbs, surface.parents, strict=True)):
        if parent < 0:
            continue
        arm = surface.joint_centres[limb] - surface.joint_centres[parent]
        centres[limb] = centres[parent] + turns[parent] @ arm
        turns[limb] = turns[parent]
        if name.split("_", 1)[-1] in _TURNED and name in model.limbs:
            own = _along(surface, limb)
            wanted = _along(model, model.limbs.index(name))
            turns[limb] = rotation_between(turns[parent] @ own, wanted) @ turns[parent]
            largest = max(largest, float(np.degrees(np.arccos(np.clip(own @ wanted, -1, 1)))))
    ends = (turns @ (surface.ends - surface.joint_centres)[..., None])[..., 0] + centres
    limbs, shares = surface.weight_limbs, surface.weight_shares
    shifts = centres - (turns @ surface.joint_centres[..., None])[..., 0]
    blended = np.einsum("vk,vkij->vij", shares, turns[limbs])
    vertices = (blended @ surface.vertices[..., None])[..., 0]
    vertices += np.einsum("vk,vki->vi", shares, shifts[limbs])
    step = Step("bind pose", findings={"turned_most_deg": round(largest, 1)})
    return replace(
        surface,
        vertices=vertices,
        joint_centres=centres,
        ends=ends,
        shapes=(),
        history=(*surface.history, step),
    )


def _along(surface: Surface, limb: int) -> Array:
    reach = surface.ends[limb] - surface.joint_centres[limb]
    along: Array = reach / np.linalg.norm(reach)
    return along
