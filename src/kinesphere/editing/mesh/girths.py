"""How thick each limb is, told by the markers on its skin."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Array, Skeleton, Surface, default_origins
from kinesphere.editing.mesh.proportions import LimbMaps
from kinesphere.geometry.hits import farthest_hits
from kinesphere.geometry.skinning import linear_blend

_LIKELY = 0.12
"""Share by which people's limbs differ in thickness from those of their size; a guess kept wide."""
_SHIFT = 0.02  # m, the same of where torso and head lie about their joints
_SKIN = 0.01  # m, how well a marker tells where the skin is
_OWN = 0.25  # weight from which a triangle belongs to a limb
_FLESH = 0.85
"""Share of an arm's or leg's length up to which markers count: bars at the wrist stand off by
several cm, and what sits on a joint slides over it."""
_UPRIGHT = ("pelvis", "trunk", "head")


def fit_girths(body: Surface, skeleton: Skeleton, maps: LimbMaps, marker_height: float) -> LimbMaps:
    """Return the maps with scales across the limbs such that the skin lies beneath the markers.

    Each marker is looked at from the axis of its limb, level with it: how far is the skin there,
    how far is the marker. Depth and breadth (x and z) of a limb, left and right alike, follow by
    least squares about what is likely; those of the torso also shift.

    Parameters
    ----------
    marker_height
        m, from the skin to the middle of a marker.
    """
    matrices, shifts = maps.matrices()
    shares = body.weight_limbs, body.weight_shares
    vertices = linear_blend(body.vertices, *shares, matrices[None], shifts[None])[0]
    scales, places = maps.scales.copy(), maps.places.copy()
    origins = default_origins(skeleton)
    joints, ends = (
        np.einsum("lij,lj->li", matrices, at) + shifts for at in (body.joint_centres, body.ends)
    )
    kinds = [name.removeprefix("left_").removeprefix("right_") for name in body.limbs]
    for kind in dict.fromkeys(kinds):
        if kind in ("hand", "foot"):
            continue  # a marker or two there tell of shoes and knuckles
        rows, values, sides = [], [], []
        for limb in (i for i, k in enumerate(kinds) if k == kind):
            points = skeleton.limbs[limb].marker_positions + origins[limb]
            points = points[np.isfinite(points).all(axis=1)]
            if kind not in _UPRIGHT:
                along = ends[limb, 1] - joints[limb, 1]  # zero for a limb the body lacks
                reach = (points[:, 1] - joints[limb, 1]) * np.sign(along)
                points = points[reach < _FLESH * abs(along)]
            row, value = _seen_from_axis(body, vertices, limb, maps.places[limb], points)
            rows.append(row)
            values.append(value - marker_height)
            sides.append(np.full(len(row), limb))
        change, shift = _across(np.vstack(rows), np.concatenate(values), kind in _UPRIGHT)
        for limb in (i for i, k in enumerate(kinds) if k == kind):
            scales[limb, ::2] *= change
            places[limb, ::2] += shift
    return replace(maps, scales=scales, places=places)


def _seen_from_axis(
    body: Surface, vertices: Array, limb: int, place: Array, points: Array
) -> tuple[Array, Array]:
    """Return skin (n, 2) and marker (n,) of a limb: where (x, z) and how far from its axis."""
    own = body.weights[body.faces, limb].max(axis=1) > _OWN
    out = points - place
    out[:, 1] = 0.0
    distance = np.linalg.norm(out, axis=1)
    along = out / np.maximum(distance, 1e-9)[:, None]
    starts = np.stack(
        [np.full(len(points), place[0]), points[:, 1], np.full(len(points), place[2])], 1
    )
    skin = farthest_hits(vertices, body.faces[own], starts, along)
    seen = np.isfinite(skin) & (distance > 1e-3)
    return (skin[:, None] * along[:, ::2])[seen], distance[seen]


def _across(skin: Array, distance: Array, shifts: bool) -> tuple[Array, Array]:
    """Return the change of scale (2,) and the shift (2,) m along x and z."""
    length = np.linalg.norm(skin, axis=1, keepdims=True)
    along = skin / np.maximum(length, 1e-9)
    rows = np.hstack([along * skin, along]) / _SKIN
    wanted = (distance - length[:, 0]) / _SKIN
    prior = np.diag([1 / _LIKELY] * 2 + [1 / _SHIFT] * 2)
    if not shifts:
        rows[:, 2:] = 0.0
    found = np.linalg.lstsq(
        np.vstack([rows, prior]), np.concatenate([wanted, np.zeros(4)]), rcond=None
    )[0]
    return np.clip(1 + found[:2], 0.7, 1.5), found[2:]
