"""Where markers sit on an actor."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Literal, TypeAlias

import numpy as np

from kinesphere.data import Array, JointModel, Limb, Segment, Skeleton, TopologicalModel
from kinesphere.errors import BadSetting
from kinesphere.synthetic.actor import Actor
from kinesphere.synthetic.cmu41 import cmu41_markers, cmu41_twin
from kinesphere.synthetic.plan import other_side, side_of

Layout: TypeAlias = Literal["bodies", "cmu41"]
Placed: TypeAlias = dict[str, tuple[list[str], Array]]
"""Limb → labels and (n_markers, 3) m in the limb frame."""

_SPREAD_M = (0.05, 0.10)  # rms distance of a body's markers from their centroid
_SPREAD_SHARE = (0.3, 0.55)  # of the limb's length, where that is less: fingers are thin
_SLACK = 1 + 1e-9
_LENGTHWISE = 1.3  # of a chain's last limb: extent along its axis against that across
_LEAST_WIDTH = 0.35  # of the second principal extent against the first: far from a line
_LEAST_GAP = 0.35  # of the closest pair against the spread: two markers stay two


def marker_bodies(rng: np.random.Generator, actor: Actor) -> Placed:
    """Place a body of three to five markers at random on each limb.

    Its centroid lies anywhere about the limb's middle. On a limb that carries no other, nothing but
    markers tells where it points: there the long axis goes from the joint through the centroid, and
    is the line closest to joint and markers.

    Returns
    -------
    dict
        Limb → labels (``left_thigh1``…) and (n_markers, 3) m in the limb frame.
    """
    carriers = {limb.parent for limb in actor.skeleton.limbs}
    bodies = {}
    for limb in actor.skeleton.limbs:
        n_markers = int(rng.integers(3, 6))
        along = rng.uniform(-0.2, 0.2) * limb.length * limb.long_axis
        if limb.name in carriers:
            least, _ = _spread_of(limb)
            off_axis = rng.normal(scale=0.4 * least, size=3)
            points = along + off_axis + _scattered(rng, n_markers, limb)
        else:
            points = _pointing(rng, n_markers, limb, along)
        bodies[limb.name] = [f"{limb.name}{i + 1}" for i in range(n_markers)], points
    return bodies


def _spread_of(limb: Limb) -> tuple[float, float]:
    """Return the least and largest spread of the limb's markers in m."""
    least, most = (
        min(metres, share * limb.length)
        for metres, share in zip(_SPREAD_M, _SPREAD_SHARE, strict=True)
    )
    return least, most


def _scattered(rng: np.random.Generator, n_markers: int, limb: Limb) -> Array:
    """Draw points about the origin, neither in a line nor on top of each other."""
    while True:
        points = rng.normal(size=(n_markers, 3))
        points -= points.mean(axis=0)
        points *= rng.uniform(*_spread_of(limb)) / np.sqrt((points**2).sum(axis=1).mean())
        if _is_body(points, limb):
            return points


def _pointing(rng: np.random.Generator, n_markers: int, limb: Limb, along: Array) -> Array:
    """Draw points that tell the long axis: it goes through their centroid, lengthwise."""
    across = np.eye(3) - np.outer(limb.long_axis, limb.long_axis)
    while True:
        points = along + _scattered(rng, n_markers, limb)
        points = balanced(points, points @ limb.long_axis, across)
        with_joint = np.vstack([points, -limb.length / 2 * limb.long_axis])
        extent = with_joint - with_joint.mean(axis=0)
        lengthwise = np.linalg.norm(extent @ limb.long_axis)
        if lengthwise > _LENGTHWISE * np.linalg.norm(extent @ across, ord=2) and _is_body(
            points - points.mean(axis=0), limb
        ):
            return points


def balanced(points: Array, reach: Array, across: Array) -> Array:
    """Move points least across an axis so that it is the line closest to them.

    Parameters
    ----------
    points : (n, 3) m
        From a point of the axis.
    reach : (n,) m
        How far along the axis each of them is.
    across : (3, 3)
        Projection onto the plane across the axis.
    """
    line = np.column_stack([np.ones_like(reach), reach])
    slanting, *_ = np.linalg.lstsq(line, points @ across, rcond=None)
    return np.asarray(points - line @ slanting)


def _is_body(points: Array, limb: Limb) -> bool:
    least, most = _spread_of(limb)
    extents = np.linalg.svd(points, compute_uv=False)
    gaps = np.linalg.norm(points[:, None] - points, axis=2)[np.triu_indices(len(points), 1)]
    spread = np.sqrt((points**2).sum(axis=1).mean())
    fits = least <= spread * _SLACK and spread <= most * _SLACK
    return bool(
        fits and extents[1] > _LEAST_WIDTH * extents[0] and gaps.min() > _LEAST_GAP * spread
    )


def _twin(label: str) -> str:
    return other_side(label) if side_of(label) else label


_LAYOUTS: Mapping[
    Layout, tuple[Callable[[np.random.Generator, Actor], Placed], Callable[[str], str]]
] = {"bodies": (marker_bodies, _twin), "cmu41": (cmu41_markers, cmu41_twin)}


def place_markers(
    rng: np.random.Generator, actor: Actor, layout: Layout
) -> tuple[Skeleton, TopologicalModel]:
    """Return the actor's skeleton with markers, and the topological model that is true for it.

    Raises
    ------
    BadSetting
        If there is no such layout, or the body lacks a limb that it needs.
    """
    if layout not in _LAYOUTS:
        raise BadSetting(f"layout is {layout!r}; known are {', '.join(_LAYOUTS)}")
    place, twin = _LAYOUTS[layout]
    placed = place(rng, actor)
    limbs = tuple(_dressed(limb, *placed[limb.name]) for limb in actor.skeleton.limbs)
    skeleton = replace(actor.skeleton, limbs=limbs)
    labels = tuple(label for limb in limbs for label in limb.markers)
    model = TopologicalModel(
        name=f"{actor.plan.name}-{layout}",
        segments=tuple(Segment(limb.name, limb.markers) for limb in limbs),
        joints=tuple(
            JointModel(joint.name, joint.parent, joint.child, n_axes=joint.n_axes)
            for joint in skeleton.joints
        ),
        root=limbs[0].name,
        required=labels,
        mirror=tuple(
            (label, twin(label))
            for label in labels
            if label < twin(label) and twin(label) in labels
        ),
        description="the truth of a synthetic actor",
    )
    return skeleton, model


def _dressed(limb: Limb, labels: list[str], positions: Array) -> Limb:
    return replace(limb, markers=tuple(labels), marker_positions=positions)
