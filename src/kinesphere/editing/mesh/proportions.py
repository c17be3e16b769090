"""A linear map for every limb, from the body as it comes to the skeleton's default position."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array, Skeleton, Surface, default_origins, pivots
from kinesphere.geometry.rotations import rotation_between

_OWN = 0.5  # weight from which a vertex belongs to a foot
_RAISED = 0.03  # m, at most
DOWN = np.array([0.0, -1.0, 0.0])
_SQUAT, _STOUT = 0.6, 1.6  # limits of a scale: beyond, the skeleton is wrong rather than the body
_CHAINS = ("upper_arm", "forearm", "thigh", "shank")


@dataclass(frozen=True, eq=False)
class LimbMaps:
    """``turn @ (p - pivot) * scale + place``, for each limb; scales along the body's own axes."""

    turns: Array
    """(n_limbs, 3, 3) from the body as it comes to the default position, before scaling."""
    pivots: Array
    """(n_limbs, 3) m, in the body as it comes."""
    scales: Array
    """(n_limbs, 3) along x, y and z of the default position."""
    places: Array
    """(n_limbs, 3) m, where the pivots go."""

    def matrices(self) -> tuple[Array, Array]:
        """Return matrices and shifts, (n_limbs, 3, 3) and (n_limbs, 3)."""
        matrices = self.scales[:, :, None] * self.turns
        return matrices, self.places - (matrices @ self.pivots[:, :, None])[..., 0]


def begins_of(skeleton: Skeleton) -> Array:
    """Return where each limb begins in the default position, (n_limbs, 3) m."""
    begins: Array = default_origins(skeleton) + pivots(skeleton)
    return begins


def fit_limbs(
    body: Surface, skeleton: Skeleton, ups: Array, ankles: Array | None = None
) -> LimbMaps:
    """Return the map of each limb.

    Arms and legs are straightened one after another, each by the least turn onto its neighbour,
    and stretched to the skeleton's length; thickness follows the whole body's size until markers
    tell better. Trunk and pelvis keep upright and are stretched between their joints. Hands and
    head grow as the whole body does, for nothing tells where they end; feet, too, and stand flat.

    Parameters
    ----------
    body
        With the skeleton's limbs and about its shape.
    ups : (n_limbs, 3)
        Which way is up, in the frame of each foot, while it stands; other rows are not used.
    ankles : (n_limbs,) m
        How high the ankle of each foot is above the floor while it stands; NaN where unknown.
    """
    n = len(body.limbs)
    begins = begins_of(skeleton)
    kinds = [name.removeprefix("left_").removeprefix("right_") for name in body.limbs]
    lengths = np.full(n, np.nan)
    for limb in (i for i, kind in enumerate(kinds) if kind in _CHAINS):
        if len(below := np.flatnonzero(body.parents == limb)):
            lengths[limb] = np.linalg.norm(begins[below[0]] - begins[limb])
    stretch = lengths / np.linalg.norm(body.ends - body.joint_centres, axis=1)
    size = float(np.nanmedian(stretch)) if np.isfinite(stretch).any() else 1.0
    size = float(np.clip(size, _SQUAT, _STOUT))

    scales, places = np.full((n, 3), size), begins.copy()
    known = np.isfinite(stretch)
    scales[known, 1] = np.clip(stretch[known], _SQUAT, _STOUT)
    for limb, scale, place in _torso(body, begins, size):
        scales[limb], places[limb] = scale, place
    turns = np.tile(np.eye(3), (n, 1, 1))
    for limb, kind in enumerate(kinds):
        parent = int(body.parents[limb])
        if kind == "foot":
            turns[limb] = rotation_between(np.array([0.0, 1.0, 0.0]), ups[limb])
            if ankles is not None and np.isfinite(ankles[limb]):
                places[limb] += _onto_floor(body, limb, size, float(ankles[limb])) * ups[limb]
        if kind not in (*_CHAINS, "hand") or parent < 0:
            continue
        target = DOWN
        if kind == "upper_arm":
            # half-way between the skeleton's shoulder and the trunk's, which keeps the armpit whole
            armhole = places[parent] + scales[parent] * (
                turns[parent] @ (body.joint_centres[limb] - body.joint_centres[parent])
            )
            places[limb, ::2] = (begins[limb, ::2] + armhole[::2]) / 2
            if len(below := np.flatnonzero(body.parents == limb)):
                target = _unit(begins[below[0]] - places[limb])
        points = turns[parent] @ _unit(body.ends[limb] - body.joint_centres[limb])
        turns[limb] = rotation_between(points, target) @ turns[parent]
    return LimbMaps(turns, body.joint_centres.copy(), scales, places)


def _onto_floor(body: Surface, limb: int, size: float, ankle: float) -> float:
    """Return by how much a foot is raised so that its sole is on the floor, m.

    An ankle's centre is known to a centimetre or two, which would show as a foot in the floor.
    """
    own = body.vertices[body.weights[:, limb] > _OWN, 1]
    if not len(own):
        return 0.0
    deep = size * float(body.joint_centres[limb, 1] - own.min())
    return float(np.clip(deep - ankle, -_RAISED, _RAISED))


def _torso(body: Surface, begins: Array, size: float) -> list[tuple[int, Array, Array]]:
    """Return limb, scale and place of pelvis, trunk and head: a block upright from hips to neck.

    Where one ends and the other begins (the lumbar joint) is the surest of no skeleton, so it is
    not asked. The breadth of the trunk is that of the shoulders.
    """
    block = [i for i, name in enumerate(body.limbs) if name in ("pelvis", "trunk")]
    joints = [i for i, parent in enumerate(body.parents) if parent in block and i not in block]
    source, target = body.joint_centres[joints], begins[joints]
    scale = np.full(3, size)
    if len(joints) and np.ptp(source[:, 1]) > 0.2:  # m: from hips to shoulders, not one alone
        scale[1] = np.clip(_slope(source[:, 1], target[:, 1]), _SQUAT, _STOUT)
    shift = (target - scale * source).mean(axis=0) if joints else begins[0]
    found = []
    for limb in block:
        own = [i for i in joints if body.limbs[i].endswith("_upper_arm")]
        wide = scale.copy()
        if body.limbs[limb] == "trunk" and len(own) == 2:
            wide[2] = np.clip(
                _slope(body.joint_centres[own, 2], begins[own, 2]), 0.8 * size, 1.25 * size
            )
        found.append((limb, wide, shift + scale * body.joint_centres[limb]))
    for limb in (i for i in joints if body.limbs[i] == "head"):
        # on the neck of this trunk: a joint that landmarks give may lie before or behind it
        found.append((limb, np.full(3, size), shift + scale * body.joint_centres[limb]))
    return found


def _slope(source: Array, target: Array) -> float:
    wide = source - source.mean()
    return float(wide @ (target - target.mean()) / (wide @ wide))


def _unit(vector: Array) -> Array:
    return np.asarray(vector / max(float(np.linalg.norm(vector)), 1e-12))
