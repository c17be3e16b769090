"""A person's proportions: lengths, girths and sizes of limbs as factors of a surface."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from kinesphere.data import Array, Json
from kinesphere.data.surface import Surface
from kinesphere.errors import BadSetting

_ARM, _LEG = ("upper_arm", "forearm", "hand"), ("thigh", "shank", "foot")

FACTORS: Mapping[str, float] = {
    "size": 0.10,
    "trunk_length": 0.06,
    "trunk_width": 0.08,
    "trunk_depth": 0.12,
    "upper_arm_length": 0.06,
    "forearm_length": 0.06,
    "arm_girth": 0.12,
    "thigh_length": 0.06,
    "shank_length": 0.06,
    "leg_girth": 0.10,
    "foot_size": 0.06,
    "head_size": 0.06,
    "sex": 0.10,
    "proportions": 0.10,
    "weight": 0.10,
    "muscle": 0.10,
}
"""Factor → how much its logarithm varies between people (standard deviation), about.

The last four are no factors but tenths of a step along the surface's directions of shape, where it
has them: what varies together from body to body, as shoulders and hips do, and where joints lie
below the skin."""
DIRECTIONS = ("sex", "proportions", "weight", "muscle")
_TENTHS = 10.0


def shaped(surface: Surface, logs: Mapping[str, float] | Array) -> Surface:
    """Return a surface of other proportions, its pelvis' centre where it was.

    Every limb is stretched along and across itself about its joint; what hangs from it moves
    along, and the skin between two limbs is blended as in any pose.

    Parameters
    ----------
    surface
        With the limbs of a human body in the bind pose: y up, x ahead, z to the right.
    logs
        Logarithms of ``FACTORS``, by name or in their order; a direction of shape that the surface
        does not have changes nothing.

    Raises
    ------
    BadSetting
        If a factor has no such name.
    """
    if not isinstance(logs, Mapping):
        logs = dict(zip(FACTORS, logs, strict=True))
    if unknown := sorted(set(logs) - set(FACTORS)):
        raise BadSetting(f"no factor is called {', '.join(unknown)}; known: {', '.join(FACTORS)}")
    steps = {name: _TENTHS * logs.get(name, 0.0) for name in DIRECTIONS if name in surface.shapes}
    if any(steps.values()):
        surface = surface.shaped(steps)
    factor = {name: float(np.exp(logs.get(name, 0.0))) for name in FACTORS}
    centres, ends = surface.joint_centres, surface.ends
    n = len(surface.limbs)
    stretch = np.empty((n, 3, 3))
    moved = np.empty((n, 3))
    for limb, (name, parent) in enumerate(zip(surface.limbs, surface.parents, strict=True)):
        stretch[limb] = factor["size"] * _stretch(name, ends[limb] - centres[limb], factor)
        if parent < 0:
            moved[limb] = centres[limb]
        else:
            moved[limb] = moved[parent] + stretch[parent] @ (centres[limb] - centres[parent])
    vertices = np.zeros_like(surface.vertices)
    for limb in range(n):
        share = surface.weights[:, limb]
        on = share > 0
        away = (surface.vertices[on] - centres[limb]) @ stretch[limb].T + moved[limb]
        vertices[on] += share[on, None] * away
    new_ends = np.einsum("lij,lj->li", stretch, ends - centres) + moved
    return replace(surface, vertices=vertices, joint_centres=moved, ends=new_ends)


def found_shape(logs: Array) -> dict[str, Json]:
    """Return logarithms of ``FACTORS`` as factors, and as steps along directions of shape."""
    named = {name: float(log) for name, log in zip(FACTORS, logs, strict=True)}
    return {
        "factors": {k: float(np.exp(v)) for k, v in named.items() if k not in DIRECTIONS},
        "shape_steps": {k: _TENTHS * named[k] for k in DIRECTIONS},
    }


def _stretch(name: str, along: Array, factor: Mapping[str, float]) -> Array:
    stem = name.removeprefix("left_").removeprefix("right_")
    if stem in ("pelvis", "trunk", "clavicle"):
        sizes = [factor["trunk_depth"], factor["trunk_length"], factor["trunk_width"]]
        return np.diag(sizes)
    if stem in ("head", "foot"):
        return factor[f"{stem}_size"] * np.eye(3)
    if stem not in _ARM + _LEG:
        return np.eye(3)
    length = factor["forearm_length" if stem == "hand" else f"{stem}_length"]
    girth = factor["arm_girth" if stem in _ARM else "leg_girth"]
    a = along / np.linalg.norm(along)
    return np.asarray(girth * np.eye(3) + (length - girth) * np.outer(a, a))
