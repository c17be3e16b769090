"""Where markers sit on an actor."""

from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

import numpy as np

from kinesphere.data import Array, JointModel, Limb, Segment, Skeleton, TopologicalModel
from kinesphere.synthetic.actor import Actor
from kinesphere.synthetic.plan import other_side, side_of

Layout: TypeAlias = Literal["bodies", "cmu41"]

_SPREAD_M = (0.05, 0.10)  # rms distance of a body's markers from their centroid
_LEAST_WIDTH = 0.35  # of the second principal extent against the first: far from a line
_LEAST_GAP = 0.35  # of the closest pair against the spread: two markers stay two


def marker_bodies(rng: np.random.Generator, actor: Actor) -> dict[str, tuple[list[str], Array]]:
    """Place a body of three to five markers at random on each limb.

    The centroid lies anywhere about the limb's middle; on a limb that carries no other it lies on
    the long axis, since there nothing but the markers tells where the limb points.

    Returns
    -------
    dict
        Limb → labels (``left_thigh1``…) and (n_markers, 3) m in the limb frame.
    """
    carriers = {limb.parent for limb in actor.skeleton.limbs}
    bodies = {}
    for limb in actor.skeleton.limbs:
        n_markers = int(rng.integers(3, 6))
        centre = rng.uniform(-0.2, 0.2) * limb.length * limb.long_axis
        if limb.name in carriers:
            centre = centre + rng.normal(scale=0.02, size=3)
        labels = [f"{limb.name}{i + 1}" for i in range(n_markers)]
        bodies[limb.name] = labels, centre + _scattered(rng, n_markers)
    return bodies


def _scattered(rng: np.random.Generator, n_markers: int) -> Array:
    """Draw points about the origin, neither in a line nor on top of each other."""
    while True:
        points = rng.normal(size=(n_markers, 3))
        points -= points.mean(axis=0)
        extents = np.linalg.svd(points, compute_uv=False)
        gaps = np.linalg.norm(points[:, None] - points, axis=2)[np.triu_indices(n_markers, 1)]
        spread = np.sqrt((points**2).sum(axis=1).mean())
        if extents[1] > _LEAST_WIDTH * extents[0] and gaps.min() > _LEAST_GAP * spread:
            return np.asarray(points * rng.uniform(*_SPREAD_M) / spread)


def skeleton_with_markers(
    skeleton: Skeleton, placed: dict[str, tuple[list[str], Array]]
) -> Skeleton:
    """Return the skeleton whose limbs own the markers placed on them."""

    def dressed(limb: Limb) -> Limb:
        labels, positions = placed[limb.name]
        return replace(limb, markers=tuple(labels), marker_positions=positions)

    return replace(skeleton, limbs=tuple(dressed(limb) for limb in skeleton.limbs))


def model_from_skeleton(skeleton: Skeleton, name: str) -> TopologicalModel:
    """Return the topological model that is true for a skeleton: every segment, marker, joint."""
    labels = {label for limb in skeleton.limbs for label in limb.markers}
    return TopologicalModel(
        name=name,
        segments=tuple(Segment(limb.name, limb.markers) for limb in skeleton.limbs),
        joints=tuple(
            JointModel(joint.name, joint.parent, joint.child, n_axes=joint.n_axes)
            for joint in skeleton.joints
        ),
        root=skeleton.limb_names[0],
        required=tuple(label for limb in skeleton.limbs for label in limb.markers),
        mirror=tuple(
            (label, twin)
            for limb in skeleton.limbs
            for label in limb.markers
            if (twin := _twin(label)) in labels and label < twin
        ),
        description="the truth of a synthetic actor",
    )


def _twin(label: str) -> str:
    return other_side(label) if side_of(label) else label
