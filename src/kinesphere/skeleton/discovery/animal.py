"""A tree as an animal on four legs: what a person's proportions alone do not rule out."""

from collections.abc import Iterator, Sequence
from itertools import combinations, pairwise

import numpy as np

from kinesphere.data import Array
from kinesphere.skeleton.averages import median_seen
from kinesphere.skeleton.body_axes import unit
from kinesphere.skeleton.discovery.figure import Figure, Point
from kinesphere.skeleton.discovery.person import off

Pair = tuple[tuple[int, ...], tuple[int, ...]]
"""Bodies of two legs, from the trunk outward."""

RARE = 6.0
"""What it costs to see an animal at all, beside a person: one recording in twenty (2 log 20)."""
AS_LONG, SIDES = 0.15, 0.1
"""Standard deviations of the logarithm of forelegs' length to hind legs', and of left to right. A
person's arms are .68 of the legs without hands and feet, .64 with them."""
TRUNK, TRUNKS = 1.2, 0.35
"""From hips to shoulders in lengths of the hind legs' first two bodies, and standard deviation of
its logarithm; a person has .59."""
WIDE, WIDTHS = 0.3, 0.4
"""Left to right leg of a pair, as a share of that way, and standard deviation of its logarithm: arm
and leg of one side are no pair."""
ACROSS, LEAN = 90.0, 20.0
"""deg, usual angle of the legs to the trunk, and its standard deviation from animal to animal."""


def cost_of_animal(figure: Figure, tree: Sequence[int]) -> float:
    """Return what it costs to see an animal on four legs in a tree, in squared deviations.

    Two pairs of legs, as long as each other, stand across the trunk between them. A person's legs
    are in line with the trunk in whatever is done upright or lying, and arms are shorter than legs
    on hands and knees, too. Infinite where no four bodies can be such legs.
    """
    costs = (_cost(figure, *reading) for reading in _readings(figure, tree))
    return RARE + min((cost for cost in costs if np.isfinite(cost)), default=np.inf)


def _readings(figure: Figure, tree: Sequence[int]) -> Iterator[tuple[int, Pair, int, Pair]]:
    """Yield what hind legs hang from and they, and what forelegs hang from and they."""
    for trunk in tree:
        for base in (trunk, *figure.beside[trunk]):
            hind = _pairs(figure, base, but=trunk)
            fore = _pairs(figure, trunk, but=base)
            for one in hind:
                for other in fore:
                    if not {*one[0], *one[1]} & {*other[0], *other[1]}:
                        yield base, one, trunk, other


def _pairs(figure: Figure, at: int, but: int) -> list[Pair]:
    ways = [figure.chain(at, start)[:3] for start in figure.beside[at] if start != but]
    return list(combinations((way for way in ways if len(way) > 1), 2))


def _cost(figure: Figure, at: int, hind: Pair, before: int, fore: Pair) -> float:
    many = min(map(len, (*hind, *fore)))
    legs = [figure.ends(at, leg[:many]) for leg in hind]
    legs += [figure.ends(before, leg[:many]) for leg in fore]
    lengths = [sum(figure.length(*two) for two in pairwise(leg)) for leg in legs]
    two = [figure.length(leg[0], leg[1]) + figure.length(leg[1], leg[2]) for leg in legs[:2]]
    hips: Point = ("amid", legs[0][0], legs[1][0])
    shoulders: Point = ("amid", legs[2][0], legs[3][0])
    along = figure.place(shoulders) - figure.place(hips)
    offs = [
        off(lengths[0], lengths[1], SIDES),
        off(lengths[2], lengths[3], SIDES),
        off(lengths[2] + lengths[3], lengths[0] + lengths[1], AS_LONG),
        off(figure.length(hips, shoulders), TRUNK * sum(two) / 2, TRUNKS),
        off(figure.length(legs[0][0], legs[1][0]), WIDE * figure.length(hips, shoulders), WIDTHS),
        off(figure.length(legs[2][0], legs[3][0]), WIDE * figure.length(hips, shoulders), WIDTHS),
        _across(along, figure.place(("amid", legs[0][2], legs[1][2])) - figure.place(hips)),
        _across(along, figure.place(("amid", legs[2][2], legs[3][2])) - figure.place(shoulders)),
    ]
    return float((np.array(offs) ** 2).sum())


def _across(along: Array, down: Array) -> float:
    """Return how many deviations legs are usually off their angle to the trunk."""
    cosine = float(median_seen((unit(along) * unit(down)).sum(axis=1)))
    return (float(np.rad2deg(np.arccos(np.clip(cosine, -1, 1)))) - ACROSS) / LEAN
