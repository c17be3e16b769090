"""Is the tree a person, and which body is which limb: proportions decide."""

from collections.abc import Sequence

import numpy as np
from scipy.special import expit

from kinesphere.skeleton.discovery.figure import Figure
from kinesphere.skeleton.discovery.person import Person
from kinesphere.skeleton.discovery.proportions import judged
from kinesphere.skeleton.discovery.readings import readings

SHARPNESS = 2.0
"""Difference of costs that makes one reading e times likelier than another."""


def find_person(figure: Figure, tree: Sequence[int]) -> tuple[Person, float] | None:
    """Return the likeliest reading of a tree as a person and its confidence 0…1.

    The confidence compares with the best reading in which any body is another limb, and with
    seeing no person at all. Size plays no part: a doll is a person. None where no part of the tree
    can be two legs.

    Parameters
    ----------
    figure
    tree
        The bodies of the tree.
    """
    costed = [judged(figure, person, len(tree)) for person in readings(figure, tree)]
    costed = [person for person in costed if np.isfinite(person.cost)]
    if not costed:
        return None
    costed.sort(key=lambda person: person.cost)
    best = costed[0]
    rival = next((p.cost for p in costed[1:] if contradicts(p, best)), np.inf)
    return best, confidence_of(best.cost, min(rival, best.nobody))


def confidence_of(cost: float, rival: float) -> float:
    """Return 0…1 that a reading is right rather than one of another cost."""
    return float(expit((rival - cost) / SHARPNESS))


def contradicts(one: Person, best: Person) -> bool:
    """Return whether a body is another limb in the two, or another body the head."""
    others = best.limbs
    if None not in (one.head, best.head) and one.head != best.head:
        return True
    return any(others.get(body, kind) != kind for body, kind in one.limbs.items())
