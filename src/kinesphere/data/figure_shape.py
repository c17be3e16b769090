"""The parts of a human figure by the shape of its rest pose alone, where names tell nothing."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data.arrays import Array
from kinesphere.data.tree import way_to_root

_ALIKE = 0.25
"""Share by which the two legs or arms may differ in length."""

_AS_LONG = 0.9
"""Of two pairs of steps that are nearly as long the one farther out counts: before it lies a
collar bone."""


def parts_by_shape(parents: NDArray[np.intp], places: Array) -> dict[str, int]:
    """Return part → limb of a figure that stands, or nothing if it does not look like one.

    The two lowest ends on either side are feet; what both hang from is the pelvis. Of what does
    not hang from the pelvis by a leg, the two ends farthest out are hands and the highest one is
    the head. In a leg or an arm the two longest steps one after the other are its long limbs.

    Parameters
    ----------
    parents : (n_limbs,)
    places : (n_limbs, 3) m
        Where each limb hangs in the rest pose: x front, y up, z to the right.
    """
    ends = np.setdiff1d(np.arange(len(parents)), parents)
    if len(ends) < 3:
        return {}
    middle = float(np.median(places[:, 2]))
    height = float(np.ptp(places[:, 1]))
    floor = float(places[:, 1].min())
    low = [int(i) for i in ends if places[i, 1] < floor + 0.15 * height]
    legs = _farthest(low, places, middle)
    if legs is None:
        return {}
    ways = [way_to_root(parents, i)[::-1] for i in legs]
    fork = _fork(ways)
    leg_ways = [way[fork:] for way in ways]
    if fork == 0 or min(map(len, leg_ways)) < 2 or not _alike(leg_ways, places):
        return {}
    in_legs = {leg_ways[0][0], leg_ways[1][0]}
    upper = [int(i) for i in ends if not in_legs & set(way_to_root(parents, int(i)))]
    parts: dict[str, int] = {}
    for side, way in zip(("left", "right"), leg_ways, strict=True):
        _name(parts, side, ("thigh", "shank", "foot", "toes"), way, places)
    hands = _farthest(upper, places, middle)
    if hands is None:
        return parts
    arm_ways = [way_to_root(parents, i)[::-1] for i in hands]
    at = _fork(arm_ways)
    arm_ways = [way[at:] for way in arm_ways]
    if at == 0 or min(map(len, arm_ways)) < 2:
        return parts
    for side, way in zip(("left", "right"), arm_ways, strict=True):
        _name(parts, side, ("upper_arm", "forearm", "hand"), way, places)
    in_arms = {arm_ways[0][0], arm_ways[1][0]}
    heads = [i for i in upper if not in_arms & set(way_to_root(parents, i))]
    if heads:
        parts["head"] = max(heads, key=lambda i: places[i, 1])
    return parts


def _farthest(ends: list[int], places: Array, middle: float) -> tuple[int, int] | None:
    """Return the ends farthest out to the left and to the right, which is +z."""
    if len(ends) < 2:
        return None
    left = min(ends, key=lambda i: float(places[i, 2]))
    right = max(ends, key=lambda i: float(places[i, 2]))
    return (left, right) if places[left, 2] < middle < places[right, 2] else None


def _fork(ways: list[list[int]]) -> int:
    """Return at which step two ways from the root part."""
    return next(
        (k for k, (a, b) in enumerate(zip(*ways, strict=False)) if a != b), min(map(len, ways))
    )


def _alike(ways: list[list[int]], places: Array) -> bool:
    a, b = (float(np.linalg.norm(np.diff(places[way], axis=0), axis=1).sum()) for way in ways)
    return abs(a - b) <= _ALIKE * max(a, b)


def _name(
    parts: dict[str, int], side: str, names: tuple[str, ...], way: list[int], places: Array
) -> None:
    steps = np.linalg.norm(np.diff(places[way], axis=0), axis=1)
    if len(steps) == 1:
        first = 0
    else:
        pairs = steps[:-1] + steps[1:]
        first = int(np.flatnonzero(pairs >= _AS_LONG * pairs.max())[-1])
    for name, limb in zip(names, way[first:], strict=False):
        parts[f"{side}_{name}"] = limb
