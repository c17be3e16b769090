"""Whether what is called heel and what is called toe are the other way round."""

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.vectors import lengths
from kinesphere.quality.body import ANKLES, HEELS, TOES, Body

NEARER = 0.9
"""Times as far from the ankle as the heel; toes of nine layouts are 1.2 to 4 times as far."""


def exchanged_heel(body: Body, side: str) -> tuple[int, int] | None:
    """Return the columns of a heel and of the toe with which it was exchanged; None if it was not.

    A toe is farther from the ankle than the heel is. A foot is longest from heel to toe, whichever
    is called which: where it is not, it is the ankle that is elsewhere.
    """
    ankle = body.side(side, ANKLES)
    heels, toes = (body.columns(side, names) for names in (HEELS, TOES))
    if ankle is None or not heels or not toes:
        return None
    heel = body.markers[:, heels[0]]
    from_heel = _apart(heel, ankle)
    from_toe, toe = min((_apart(body.markers[:, c], ankle), c) for c in toes)
    long = _apart(heel, body.markers[:, toe])
    return (heels[0], toe) if from_toe < NEARER * from_heel and long > from_heel else None


def _apart(points: Array, others: Array) -> float:
    """Return the median distance between points, (n_frames, 3) m each; inf where never seen."""
    found = lengths(points - others)
    found = found[np.isfinite(found)]
    return float(np.median(found)) if len(found) else np.inf
