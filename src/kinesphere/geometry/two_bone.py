"""A chain of two bones reaching for a point: closed form, the middle joint a hinge."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.rotations import hat, rotation_between
from kinesphere.geometry.vectors import lengths

Array = NDArray[np.float64]


class Reach(NamedTuple):
    """How the two bones turn in the world, and how far the goal was out of reach."""

    upper: Array
    """(n_frames, 3, 3), to be multiplied from the left to the upper bone's ``world_from_limb``."""
    lower: Array
    """(n_frames, 3, 3), the same for the lower bone."""
    missed: Array
    """(n_frames,) m between the goal and the end; 0 where it is reached."""


def reach_for(start: Array, middle: Array, end: Array, hinge: Array, goal: Array) -> Reach:
    """Turn two bones so that the end of the second comes to a goal.

    The lower bone turns about the hinge until start and end are as far apart as start and goal
    (law of cosines); then both turn together by the least rotation that takes end to goal. Of the
    two ways to bend, the lower bone takes the one that is a negative turn about the hinge.

    Parameters
    ----------
    start, middle, end, goal : (n_frames, 3) m
        Hip, knee, ankle, and where the ankle should be.
    hinge : (n_frames, 3)
        Unit vectors in the world.
    """
    first, second = middle - start, end - middle
    long, short = lengths(first)[:, None], lengths(second)[:, None]
    u, v = first / long, second / short
    wanted = lengths(goal - start)[:, None]
    cosine = (wanted**2 - long**2 - short**2) / (2 * long * short)
    # u · (v turned by θ about the hinge) = along + a cos θ + b sin θ
    along = _dot(u, hinge) * _dot(v, hinge)
    a, b = _dot(u, v) - along, _dot(u, np.cross(hinge, v))
    most = np.hypot(a, b)
    straight = np.arctan2(b, a)
    bend = np.arccos(np.clip((cosine - along) / np.where(most > 0, most, 1.0), -1.0, 1.0))
    bent = _about(hinge, (straight - bend)[:, 0])
    tip = start + first + (bent @ second[..., None])[..., 0]
    way, aim = tip - start, goal - start
    far = lengths(aim)[:, None]
    # a goal at the start itself has no direction
    aimed = np.where(far > 0, aim / np.where(far > 0, far, 1.0), way / lengths(way)[:, None])
    both = rotation_between(way / lengths(way)[:, None], aimed)
    missed = np.abs(lengths(way) - far[:, 0])
    return Reach(both, both @ bent, missed)


def longest_reach(start: Array, middle: Array, end: Array, hinge: Array) -> Array:
    """Return how far from its start the chain reaches by turning about the hinge, (n_frames,) m.

    Less than both bones together where they do not lie in a plane across the hinge.
    """
    first, second = middle - start, end - middle
    along = _dot(first, hinge) * _dot(second, hinge)
    a, b = _dot(first, second) - along, _dot(first, np.cross(hinge, second))
    squares = _dot(first, first) + _dot(second, second) + 2 * (along + np.hypot(a, b))
    return np.asarray(np.sqrt(squares[:, 0]))


def _dot(a: Array, b: Array) -> Array:
    return np.asarray((a * b).sum(axis=-1, keepdims=True))


def _about(axes: Array, angles: Array) -> Array:
    """Return rotations each about an axis of its own, (n, 3) and (n,) rad → (n, 3, 3)."""
    k = hat(axes)
    s, c = np.sin(angles)[:, None, None], np.cos(angles)[:, None, None]
    turned: Array = np.eye(3) + s * k + (1 - c) * (k @ k)
    return turned
