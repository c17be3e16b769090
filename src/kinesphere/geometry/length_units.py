"""Units of length taken for one another, told by how tall a person then is."""

import numpy as np

STATURE, SIZES = 1.6, 0.25
"""m, and standard deviation of its logarithm: from a child of two, 0.85 m, to a tall adult."""
NEAR_TEN = 0.25
"""How far the decimal logarithm of a stature may be off for another unit of length to be why: of
0.09 to 0.28 m it may be a person in a wrong unit, of 0.5 m a doll."""
NO_UNIT = 0.28
"""The same from which on no unit explains a stature: 0.84 to 3.0 m are explained."""
TENS = tuple(10.0**n for n in range(-6, 7))
INCHES_AND_FEET = (0.0254, 1 / 25.4, 2.54, 1 / 0.3048, 25.4, 39.37)
"""Factors between these and metres, centimetres or millimetres, either taken for the other. Not
those which make a doll of a person, 0.3048 and 1 / 2.54."""
RARER = 3.0
"""What inches and feet cost beside metric units, in squared standard deviations."""


def times_too_large(stature: float) -> float:
    """Return by which factor between units a person's lengths are too large, below 1 too small.

    The factor that makes the stature likeliest; 1 where it is a doll's. Where no such factor leads
    near a person's stature, the plain factor to the usual one.

    Parameters
    ----------
    stature
        m, above 0.
    """
    times = float(np.log10(stature / STATURE))
    if -1.0 < times < 0.0 and min(-times, 1.0 + times) >= NEAR_TEN:
        return 1.0
    factors = np.array([*TENS, *INCHES_AND_FEET])
    away = np.abs(times - np.log10(factors))
    cost = (away * np.log(10.0) / SIZES) ** 2
    cost[len(TENS) :] += RARER
    best = int(cost.argmin())
    return float(factors[best]) if away[best] < NO_UNIT else float(10.0**times)
