"""A tree as the upper half of a person: trunk, head and two arms, the legs without markers."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from kinesphere.skeleton.body_axes import unit
from kinesphere.skeleton.discovery.figure import Figure, Point
from kinesphere.skeleton.discovery.likeliest import confidence_of, contradicts
from kinesphere.skeleton.discovery.person import Person, off
from kinesphere.skeleton.discovery.proportions import (
    FOREARM,
    HEAD,
    SHOULDERS,
    TRUNK,
    UNEXPLAINED,
    UPPER_ARM,
)
from kinesphere.skeleton.discovery.sides import LEAST, Sides, bend

NECK = HEAD - TRUNK
"""Shoulders to the middle of the head, as a share of stature; to the pelvis it is `TRUNK`."""
NO_LEGS = 8.0
"""What this reading costs beside one with legs in another tree of the same bodies: two missing
limbs (`proportions.MISSING`)."""


def find_upper_half(figure: Figure, tree: Sequence[int]) -> tuple[Person, float] | None:
    """Return the likeliest reading of a tree as an upper half and its confidence 0…1.

    Arms have two bodies at least, and a head is asked for: five lengths with less are anybody's.
    The legs do not tell the stature, so the arms do. None where no part of the tree can be one.
    """
    costed = [_judged(figure, person, len(tree)) for person in _readings(figure, tree)]
    costed = [person for person in costed if np.isfinite(person.cost)]
    if not costed:
        return None
    costed.sort(key=lambda person: person.cost)
    best = costed[0]
    rival = next((p.cost for p in costed[1:] if contradicts(p, best)), np.inf)
    return best, confidence_of(best.cost, min(rival, best.nobody))


def sides_of_upper_half(figure: Figure, person: Person) -> Sides | None:
    """Return which arm is the left one by the way elbows bend; None where they do not tell."""
    arms = [[figure.place(p) for p in figure.ends(at, arm)] for at, arm in person.arms]
    assert person.head is not None
    across = unit(arms[1][0] - arms[0][0])
    top = figure.middles[:, person.head] - (arms[0][0] + arms[1][0]) / 2
    up = unit(top - (top * across).sum(axis=1, keepdims=True) * across)
    front = np.cross(up, across)  # if the second arm is the right one
    said = np.array([bend(arm[0], arm[1], arm[2], -up, front) for arm in arms])
    if not np.isfinite(said).any():
        return None
    score = float(np.nanmean(said))
    if abs(score) < LEAST:
        return None
    return Sides(0, 0 if score > 0 else 1, (1 + abs(score)) / 2, {"elbows": abs(score)})


def _readings(figure: Figure, tree: Sequence[int]) -> Iterator[Person]:
    for trunk in tree:
        chains = [figure.chain(trunk, b)[:3] for b in figure.beside[trunk]]
        ends = [chain[0] for chain in chains if len(chain) == 1]
        for one, other in combinations([chain for chain in chains if len(chain) > 1], 2):
            for head in ends:
                for pelvis in (None, *(b for b in ends if b != head)):
                    yield Person(trunk, pelvis, (), ((trunk, one), (trunk, other)), head)


def _judged(figure: Figure, person: Person, n_bodies: int) -> Person:
    arms = [figure.ends(at, arm) for at, arm in person.arms]
    uppers = [figure.length(arm[0], arm[1]) for arm in arms]
    lowers = [figure.length(arm[1], arm[2]) for arm in arms]
    stature = (sum(uppers) + sum(lowers)) / 2 / (UPPER_ARM + FOREARM)
    if not stature > 0:
        return person
    shoulders: Point = ("amid", arms[0][0], arms[1][0])
    offs = [
        *(off(length, UPPER_ARM * stature, 0.15) for length in uppers),
        *(off(length, FOREARM * stature, 0.25) for length in lowers),
        off(uppers[0], uppers[1], 0.1),
        off(lowers[0], lowers[1], 0.2),
        off(figure.length(arms[0][0], arms[1][0]), SHOULDERS * stature, 0.35),
        off(figure.length(shoulders, ("body", person.head)), NECK * stature, 0.4),
    ]
    if person.pelvis is not None:
        offs.append(off(figure.length(shoulders, ("body", person.pelvis)), TRUNK * stature, 0.3))
    square = np.nan_to_num(np.array(offs) ** 2, nan=np.inf)
    cost = float(square.sum()) + UNEXPLAINED * (n_bodies - len(person.limbs))
    return replace(person, cost=cost, lengths=len(offs), stature=stature * figure.unit)
