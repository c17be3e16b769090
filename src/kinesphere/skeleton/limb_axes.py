"""Each limb's right and up, from the root outward."""

import numpy as np

from kinesphere.data import Array, TopologicalModel
from kinesphere.geometry.rigid import into_frame, out_of_frame
from kinesphere.skeleton.averages import mean_seen
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.body_axes import (
    beside,
    right_from_bending,
    right_from_hinge,
    right_from_pairs,
    right_from_parent,
    straightest,
    unit,
    up_of_trunk,
)
from kinesphere.skeleton.neighbours import (
    HINGE_SIGN,
    cloud,
    flexed_normals,
    hinge_sign,
    next_normals,
)
from kinesphere.skeleton.settings import SkeletonSettings
from kinesphere.skeleton.tree import Tree

UPPER = ("head", "trunk")
"""Limbs towards which a pelvis or trunk points up."""
SURELY_FLEXED = np.deg2rad(45.0)
"""rad, from which a knee does not only look bent for markers beside it."""


def find_axes(
    body: Body,
    parent: Body | None,
    tree: Tree,
    model: TopologicalModel,
    sample: dict[str, Array],
    settings: SkeletonSettings,
) -> None:
    """Find the limb's right and up; written into it.

    Pelvis, trunk and head (the root, and whatever has mirror pairs of its own) take the body's:
    right from the pairs, up from the world while the body is upright. Every other limb has its
    proximal direction as up; its right is the axis of the hinge beyond it where that bends enough
    (knee, elbow), else its parent's, averaged over time.

    Parameters
    ----------
    sample
        Label → (n_sample, 3) m, every marker of the recording in the sampled frames.
    """
    own = cloud(body.labels, sample)
    pairs = right_from_pairs(body, model)
    if pairs is not None or parent is None or body.centre is None:
        above = tuple(label for limb in UPPER for label in tree.markers.get(limb, ()))
        own_middle = mean_seen(own, axis=1)
        upward = np.broadcast_to([0.0, 1.0, 0.0], own_middle.shape)
        if above and body.name != "head":
            upward = mean_seen(cloud(above, sample), axis=1) - own_middle
        body.up, body.right = up_of_trunk(body, upward), pairs
        if pairs is not None:
            body.up = beside(body.up, pairs)
        return
    arms = body.shape - body.centre
    far = int(np.nan_to_num(np.linalg.norm(arms, axis=1), nan=-1.0).argmax())
    long = unit(arms[far])
    body.up, right = -long, right_from_parent(body, parent)
    if body.borrow is not None:
        right = body.borrow
    elif any(hinge_sign(joint) for joint in tree.joints if joint.parent == body.name):
        hinge = _right_of_hinge(body, own, far, tree, sample, np.deg2rad(settings.flexed_deg))
        right = right if hinge is None else hinge
    if not np.isfinite(long).all():
        body.up = right = None
    body.right = None if right is None else beside(right, long)


def _right_of_hinge(
    body: Body, own: Array, far: int, tree: Tree, sample: dict[str, Array], flexed: float
) -> Array | None:
    """Return the axis of the hinge beyond a limb as the limb sees it; None where it hardly bends.

    Knees straighten whenever somebody stands, which tells what is bent from what only looks so;
    elbows may never, and pronation moves the markers of a forearm. A knee that never straightens,
    of somebody seated or kneeling, is bent for certain: where the shank points tells it, too.
    """
    assert body.centre is not None
    beyond = [joint for joint in tree.joints if joint.parent == body.name]
    if len(beyond) == 1 and hinge_sign(beyond[0]) == HINGE_SIGN["knee"]:
        shank = cloud(tree.markers[beyond[0].child], sample)
        seen = into_frame(body.rotations, body.shifts, shank) - body.shape[far]
        along = unit(body.shape[far] - body.centre)
        least = mean_seen(unit(straightest(along, seen)))
        if not unit(least) @ along < np.cos(SURELY_FLEXED):
            right = right_from_bending(along, seen, HINGE_SIGN["knee"], flexed)
            if right is not None:
                return right
            flexed = max(flexed, SURELY_FLEXED)
    centre = out_of_frame(body.rotations, body.shifts, body.centre[None])[:, 0]
    towards = unit(own[:, far] - centre)
    normals = flexed_normals(next_normals(body.name, towards, own[:, far], tree, sample), flexed)
    return right_from_hinge((np.swapaxes(body.rotations, 1, 2) @ normals[..., None])[..., 0])
