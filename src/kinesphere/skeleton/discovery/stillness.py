"""Joints at which nothing moves: bodies that nearness alone told apart."""

import numpy as np

from kinesphere.data import Array
from kinesphere.skeleton.discovery.forest import Pair
from kinesphere.skeleton.discovery.joint_costs import Members
from kinesphere.skeleton.discovery.partition import Partition

STILL = 1.5
"""Times the wander of distances within two bodies up to which those between them tell nothing: in
the first 30 s of animals and hands, most of whose joints have not moved yet, 2 to 10 joints a
recording have less, of 321 joints of whole recordings one has."""


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
