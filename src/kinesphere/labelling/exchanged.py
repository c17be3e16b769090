"""Labels that were exchanged while few markers were known, seen when most of them are.

Two markers of a foot that take each other's label early are consistent with themselves, and teach
the person's own distances what is wrong. With the whole body labelled, other people's statistics
tell them apart.
"""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, TopologicalModel
from kinesphere.labelling.labelled import Labelled, give, length_of, take
from kinesphere.labelling.pair_statistics import match_pair_statistics


def exchange_labels(
    state: Labelled,
    markers: Array,
    model: TopologicalModel,
    least_confidence: float,
    fixed: set[int],
) -> bool:
    """Let labels change places, all their tracks at once, where that is sure.

    A label moves into one that is free, or that moves on itself: no other marker loses its label.
    Those that are unsure, but the best so far, stay. Taken away, they would leave their neighbours
    unsure. Return whether any moved.
    """
    held = sorted({label for label in state.labels if label >= 0})
    match = match_pair_statistics(state.points[:, held], model, np.array(held, dtype=np.int64))
    if match.note:
        return False
    kept = {state.labels[k] for k in fixed if state.labels[k] >= 0}
    sure = (match.confidence >= least_confidence) & ~np.isin(held, list(kept))
    into = followed(np.array(held, dtype=np.int64), match.labels, sure)
    moving = [(k, into[of], state.confidence[k]) for k, of in enumerate(state.labels) if of in into]
    for k, _, _ in moving:
        take(state, k)
    for k, label, sure_ in sorted(moving, key=lambda one: (-length_of(state, one[0]), one[0])):
        give(state, markers, k, label, sure_)
    return bool(moving)


def followed(
    held: NDArray[np.int64], wanted: NDArray[np.int64], sure: NDArray[np.bool_]
) -> dict[int, int]:
    """Return which labels move where: surely, and not into the place of one that stays.

    Parameters
    ----------
    held, wanted : (n,)
        Label that is borne, and that which should be; −1 for none.
    sure : (n,)
    """
    into = {
        int(a): int(b)
        for a, b, certain in zip(held, wanted, sure, strict=True)
        if certain and b >= 0 and a != b
    }
    there = set(held.tolist())
    while True:
        stuck = [a for a, b in into.items() if b in there and b not in into]
        if not stuck:
            return into
        for a in stuck:
            del into[a]
