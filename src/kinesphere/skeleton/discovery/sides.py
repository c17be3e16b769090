"""Left and right of a person: from where feet point, knees and elbows bend, and walks lead."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array
from kinesphere.skeleton.body_axes import unit
from kinesphere.skeleton.discovery.figure import Figure
from kinesphere.skeleton.discovery.person import Person

WEIGHTS = {"feet": 1.0, "knees": 0.5, "elbows": 0.25}
"""How much each witness counts, as where normalization asks which way a body faces."""
FLEXED = np.sin(np.deg2rad(20.0))
"""Below this a joint a little off its place outvotes the bend."""
ALONG = np.cos(np.deg2rad(60.0))
"""Least cosine between a thigh or upper arm and the trunk's downward for its bend to tell a front:
a thigh raised level bends its shank down."""
LEAST = 0.4
"""Weighted score from which there is an answer: on recordings at hand .74 and more where it is
right, up to .28 where it is wrong."""


@dataclass(frozen=True)
class Sides:
    """Which leg and which arm are the left ones."""

    left_leg: int
    left_arm: int | None
    """Index among the person's arms; None where there is none."""
    confidence: float
    """0…1."""
    scores: dict[str, float]
    """Witness → +1 where it fully agrees … −1."""


def find_sides(figure: Figure, person: Person) -> Sides | None:
    """Return which leg is the left one, in a right-handed world; None where nothing tells."""

    def places(root: int, chain: tuple[int, ...]) -> list[Array]:
        return [figure.place(point) for point in figure.ends(root, chain)]

    legs = [places(person.hips_at, leg) for leg in person.legs]
    arms = [places(at, arm) for at, arm in person.arms]
    across = unit(legs[1][0] - legs[0][0])
    hips = (legs[0][0] + legs[1][0]) / 2
    top = _top(figure, person, arms)
    up = unit((top - hips) - _along(top - hips, across))
    front = np.cross(up, across)  # y × z = x, if the second leg is the right one
    voices = {
        "feet": [_foot(leg, up, front) for leg in legs if len(leg) > 3],
        "knees": [-bend(leg[0], leg[1], leg[2], -up, front) for leg in legs],
        "elbows": [bend(arm[0], arm[1], arm[2], -up, front) for arm in arms if len(arm) > 2],
    }
    scores = {
        name: float(np.mean([s for s in said if np.isfinite(s)]))
        for name, said in voices.items()
        if any(np.isfinite(said))
    }
    total = sum(WEIGHTS[name] for name in scores)
    score = sum(WEIGHTS[name] * s for name, s in scores.items()) / total if total else 0.0
    if abs(score) < LEAST:
        return None
    left_leg = 0 if score > 0 else 1
    sign = 1.0 if score > 0 else -1.0
    return Sides(
        left_leg=left_leg,
        left_arm=_left_arm(arms, hips, sign * across),
        confidence=(1 + abs(score)) / 2,
        scores={name: sign * s for name, s in scores.items()},
    )


def _top(figure: Figure, person: Person, arms: list[list[Array]]) -> Array:
    if arms:
        return np.asarray(np.mean([arm[0] for arm in arms], axis=0))
    if person.head is not None:
        return figure.middles[:, person.head]
    return figure.middles[:, person.trunk]


def _left_arm(arms: list[list[Array]], hips: Array, right: Array) -> int | None:
    """Return the arm whose shoulder lies to the left of the other, or of the hips' middle."""
    if not arms:
        return None
    other = arms[1][0] if len(arms) > 1 else hips
    to_right = ((arms[0][0] - other) * right).sum(axis=1)
    known = to_right[np.isfinite(to_right)]
    first_is_left = bool(len(known) and np.median(known) < 0)
    if len(arms) > 1:
        return 0 if first_is_left else 1
    return 0 if first_is_left else None


def _along(vectors: Array, axis: Array) -> Array:
    return np.asarray((vectors * axis).sum(axis=1, keepdims=True) * axis)


def _foot(leg: list[Array], up: Array, front: Array) -> float:
    """Return how far a foot points to the front, −1…1."""
    toes = leg[3] - leg[2]
    return _score(unit(toes - _along(toes, up)), front)


def bend(upper: Array, middle: Array, lower: Array, down: Array, front: Array) -> float:
    """Return which way a joint bends the limb below: 1 to the front … −1 to the back.

    NaN if it does not bend.
    """
    shaft, beyond = unit(middle - upper), unit(lower - middle)
    off = beyond - _along(beyond, shaft)
    with np.errstate(invalid="ignore"):
        tells = (np.linalg.norm(off, axis=1) > FLEXED) & ((shaft * down).sum(axis=1) > ALONG)
    if tells.sum() < 5:
        return np.nan
    return _score(unit(off[tells]), front[tells])


def _score(directions: Array, front: Array) -> float:
    cosine = (directions * front).sum(axis=1)
    known = cosine[np.isfinite(cosine)]
    return float(known.mean()) if len(known) else np.nan
