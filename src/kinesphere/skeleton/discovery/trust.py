"""What doubt in bodies and joints leaves of the names that stand on them."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from kinesphere.data import Json
from kinesphere.skeleton.discovery.forest import DOUBTFUL, Forest
from kinesphere.skeleton.discovery.names import Names, numbered

EVEN = 0.6
"""Confidence below which names are told to be unsure: of thirds and halves of recordings one of two
between .5 and this has a wrong one."""
GIVEN = 0.45
"""Least confidence for names to be given: below, 4 of 9 parts of recordings had wrong ones, above
1 of 19; all whole recordings at hand are above."""
DOUBTFUL_COUNT = 0.3
"""Confidence below which another number of bodies would do about as well: it is above .7 on
synthetic bodies and rigid plates, .27 to .73 on sparse markers of a person."""


def shaken(names: Names, forest: Forest, count_confidence: float, shown: float = 1.0) -> Names:
    """Return the names with what doubt in the bodies they stand on leaves of their confidence.

    A name is no surer than the tree it was read off: where the most doubtful edge of a named limb
    has a rival of the same cost, or another number of bodies would do as well, half is left. Where
    too little is, limbs are numbered, and the likely names are told.

    Parameters
    ----------
    names
        As proportions and sides give them.
    forest
        Of all bodies.
    count_confidence
        0…1 that there are so many bodies.
    shown
        0…1, what is left where trajectories are missing that may be limbs.
    """
    if not names.given:
        return names
    named = {body for body, limb in names.limbs.items() if not limb.startswith("limb_")}
    edges = [edge.confidence for edge in forest.edges if named & {edge.a, edge.b}]
    tree = (1 + min(1.0, min(edges, default=1.0) / DOUBTFUL)) / 2
    count = (1 + min(1.0, count_confidence / DOUBTFUL_COUNT)) / 2
    sure = names.confidence * tree * count * shown
    account = names.account | {"bodies_confidence": round(tree * count * shown, 3)}
    doubt = names.doubt
    if sure < GIVEN:
        of_names = next(bodies for bodies in forest.trees if bodies[0] in names.limbs)
        return _withheld(replace(names, confidence=sure, account=account), of_names)
    if sure < EVEN:
        told = f"names of limbs are unsure and may be wrong (confidence {sure:.2f}): check them"
        doubt = f"{doubt}; {told}" if doubt else told
    return replace(names, confidence=sure, account=account, doubt=doubt)


def _withheld(names: Names, tree: Sequence[int]) -> Names:
    """Return numbers for the named limbs too, and which names were likely."""
    numbers = numbered({}, tree)
    likely: dict[str, Json] = {
        numbers[body]: names.limbs[body]
        for body in tree
        if not names.limbs[body].startswith("limb_")
    }
    account = names.account | {
        "person": False,
        "likely_names": likely,
        "likely_confidence": round(names.confidence, 3),
    }
    told = (
        f"names of limbs were too unsure to be given (confidence {names.confidence:.2f}): limbs "
        f"are numbered; likely were {', '.join(f'{k} {limb}' for k, limb in likely.items())}"
    )
    return Names(numbers, np.nan, account, told, names.cost)
