"""Which way is right, up and forward, seen from a limb: what landmarks are measured along."""

import numpy as np

from kinesphere.data import Array, TopologicalModel
from kinesphere.skeleton.averages import mean_seen, median_seen
from kinesphere.skeleton.body import Body

FLEXED_SHARE = 0.05
"""Least share of frames in which a hinge must be flexed for its axis to be believed."""
STEADINESS = 0.7
"""Least length of the mean of a hinge's normals, as a share of their mean length."""
STRAIGHT_SHARE = 0.05
"""Share of a recording in which a hinge counts as being as straight as it ever is."""
LIMB_AS_WAY = 0.1
"""What a limb's direction counts in the plane of flexion, as a way of so many lengths: enough to
complete short ways, too little to tilt long ones."""
FLAT = 0.25
"""Most scatter across a plane of flexion, as a share of that along its lesser direction."""
UPRIGHT = np.cos(np.deg2rad(30.0))
"""Least cosine between a trunk and the vertical for the world's up to be the body's."""


def unit(vector: Array) -> Array:
    """Return vectors of length 1; NaN for the zero vector."""
    with np.errstate(invalid="ignore", divide="ignore"):
        scaled: Array = vector / np.linalg.norm(vector, axis=-1, keepdims=True)
    return scaled


def beside(vector: Array, axis: Array) -> Array:
    """Return the unit direction of what of a vector is perpendicular to a unit axis."""
    return unit(vector - (vector @ axis) * axis)


def right_from_pairs(body: Body, model: TopologicalModel) -> Array | None:
    """Return the body's right from a limb's own mirror pairs, (3,); None if it has none."""
    at = {label: i for i, label in enumerate(body.labels)}
    across = [
        body.shape[at[right]] - body.shape[at[left]]
        for left, right in model.mirror
        if left in at and right in at
    ]
    right = unit(np.sum(across, axis=0)) if across else np.full(3, np.nan)
    return right if np.isfinite(right).all() else None


def right_from_parent(body: Body, parent: Body) -> Array | None:
    """Return the parent's right as the limb sees it on average, (3,); None if it never agrees."""
    if parent.right is None:
        return None
    seen = np.swapaxes(body.rotations, 1, 2) @ (parent.rotations @ parent.right)[..., None]
    mean = mean_seen(seen[..., 0])
    return unit(mean) if np.linalg.norm(mean) > 0.3 else None


def right_from_hinge(normals: Array) -> Array | None:
    """Return the normal of two limbs' plane as the proximal one sees it, (3,); None if too rare.

    Parameters
    ----------
    normals : (n_sample, 3)
        In the limb, NaN where the joint is not flexed.
    """
    known = np.isfinite(normals).all(axis=1)
    if known.sum() < max(5, FLEXED_SHARE * len(normals)):
        return None
    mean = normals[known].mean(axis=0)
    steadiness = np.linalg.norm(mean) / np.linalg.norm(normals[known], axis=1).mean()
    return unit(mean) if steadiness > STEADINESS else None


def right_from_bending(along: Array, seen: Array, sign: float, flexed: float) -> Array | None:
    """Return the same from how the limb beyond moves and not where it points; None if too little.

    Markers on one side of a joint make a straight knee look bent sideways, by 20° and more where
    those of the thigh are lateral and those of the shank in front. The ways that markers have come
    since the hinge was straightest lie in the plane of flexion wherever they sit. A short way has
    one direction alone; the limb itself is the other, which its far marker tells to 7 to 10°: where
    ways go along the limb, about a knee that stays bent by 90°, no plane is told. The way in which
    markers turned from the straightest tells right from left; how far behind the limb they came
    does not: beyond 90° they come forwards again.

    Parameters
    ----------
    along : (3,)
        Unit direction of the limb, in the limb.
    seen : (n_sample, n_markers, 3) m
        Markers of the limb beyond, in the limb, from its far end.
    sign
        +1 where cross(limb, limb beyond) points to the right, −1 where to the left.
    flexed
        rad, what a marker must have turned since.
    """
    straight = straightest(along, seen)
    length = np.linalg.norm(straight, axis=1)[:, None]
    ways = (seen - straight) / length
    turned = np.linalg.norm(ways, axis=2) > 2 * np.sin(flexed / 2)
    ways = np.where(turned[..., None], ways, np.nan)
    known = ways[np.isfinite(ways).all(axis=2)]
    if not len(known):
        return None
    spread = known.T @ known / len(known) + LIMB_AS_WAY**2 * np.outer(along, along)
    values, vectors = np.linalg.eigh(spread)
    if values[0] > FLAT * values[1]:
        return None
    turns = mean_seen(np.cross(straight / length, ways), axis=1) @ vectors[:, 0]
    return right_from_hinge(sign * turns[:, None] * vectors[:, 0])


def straightest(along: Array, seen: Array) -> Array:
    """Return where markers of the limb beyond are while the joint is straightest, (n_markers, 3) m.

    Parameters
    ----------
    along, seen
        As in `right_from_bending`.
    """
    found = np.full(seen.shape[1:], np.nan)
    for i, marker in enumerate(np.moveaxis(seen, 1, 0)):
        reach = marker @ along
        if np.isfinite(reach).any():
            found[i] = median_seen(marker[reach >= np.nanquantile(reach, 1 - STRAIGHT_SHARE)])
    return found


def up_of_trunk(body: Body, towards_head: Array) -> Array:
    """Return the body's up as the pelvis or trunk sees it, (3,).

    The world's up, averaged over the frames in which the body is upright; the way to the head where
    it never is.

    Parameters
    ----------
    towards_head : (n_sample, 3)
        In the world, along the trunk.
    """
    along = unit(towards_head)
    upright = along[:, 1] > UPRIGHT
    if upright.mean() > 0.02:
        local = body.rotations[upright][:, 1]  # world y seen from the limb
    else:
        local = (np.swapaxes(body.rotations, 1, 2) @ along[..., None])[..., 0]
    mean = mean_seen(local)
    return unit(mean) if np.isfinite(mean).all() else np.array([0.0, 1.0, 0.0])
