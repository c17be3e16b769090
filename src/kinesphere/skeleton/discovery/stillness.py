"""Joints at which nothing moves, and people who do not."""

import numpy as np

from kinesphere.data import Array
from kinesphere.skeleton.discovery.forest import Pair
from kinesphere.skeleton.discovery.joint_costs import Members
from kinesphere.skeleton.discovery.partition import Partition

STILL = 1.5
"""Times the wander of distances within two bodies up to which those between them tell nothing: in
the first 30 s of animals and hands, most of whose joints have not moved yet, 2 to 10 joints a
recording have less, of 321 joints of whole recordings one has."""

HARDLY = 0.01
"""m at a person's size, `Rigidity.most` up to which nobody moved: 0.0015 to 0.0038 in four static
trials, 0.029 and more in thirty recordings of people and things that move."""


def told_of_stillness(partition: Partition) -> str:
    """Return what a person should know where hardly anything moves; nothing of a single body."""
    most = partition.rigidity.most
    if most >= HARDLY or sum(size > 0 for size in partition.sizes) < 2:
        return ""
    return (
        "the markers hardly move against each other (95 % of distances wander by less than "
        f"{most * partition.unit * 1e3:.2g} mm, as on somebody who stands still): bodies, joints "
        "and names are not to be trusted; record a motion of every joint, or give a model"
    )


def still_pairs(partition: Partition) -> frozenset[Pair]:
    """Return the pairs of bodies that meet and move against each other no more than within."""
    wander, bodies = partition.rigidity.wander, partition.bodies
    within = [_rms(wander[np.ix_(b, b)][np.triu_indices(len(b), 1)]) for b in bodies]
    return frozenset(
        (edge.a, edge.b)
        for edge in partition.forest.edges
        if _between(wander, bodies[edge.a], bodies[edge.b])
        < STILL * max(partition.usual, within[edge.a], within[edge.b])
    )


def _between(wander: Array, a: Members, b: Members) -> float:
    known = wander[np.ix_(a, b)]
    return _rms(known) if np.isfinite(known).any() else np.inf


def _rms(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if len(known) else 0.0
