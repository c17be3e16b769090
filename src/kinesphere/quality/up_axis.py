"""The judgement: up from the user, the body, the file, the scene, in this order, said aloud."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from kinesphere.data import DIRECTIONS, UpAxis
from kinesphere.quality.upright import Evidence

Source = Literal["user", "body", "file", "floor", "extent", "assumed"]

STRONG = 0.8
"""Share of frames upright along one direction that leaves no doubt: an acrobatic recording has
0.86, all others at hand 0.95 and more."""
CANDIDATE = 0.25
"""Share from which on a direction is worth comparing by its floor: kneeling, then lying prone,
gives 0.47 and 0.51."""
STEADIER = 0.5
"""A floor moves at most this much of what its rival does."""
MOVING = 0.02
"""Sway, in sizes of the scene, below which nothing moves and all ends look like floors."""
ON_FLOOR = 0.06
"""Distance of a floor from the file's zero, in sizes: 10 cm for a standing adult."""
TALLER = 1.5
"""Extent over the next smaller one from which on the scene stands."""


@dataclass(frozen=True)
class Judgement:
    """Which way is up and who says so."""

    up: UpAxis
    source: Source
    warnings: tuple[str, ...] = ()


def judge_up(evidence: Evidence, field: UpAxis | None, wanted: UpAxis | None) -> Judgement:
    """Decide which direction of the file is up.

    Parameters
    ----------
    field
        What the file says.
    wanted
        What the user says; it wins.
    """
    seen, strong = _body(evidence)
    if wanted is not None:
        doubt = seen is not None and strong and seen != wanted
        said = (
            f"up is {wanted} as asked, although the head is along {seen} from the {evidence.below}"
        )
        return Judgement(wanted, "user", (said,) if doubt else ())
    if seen is None:
        if field is None:
            return _from_scene(evidence)
        return Judgement(field, "file", _overhead_floor(evidence, field))
    if seen == field:
        return Judgement(field, "file")
    share = evidence.upright[DIRECTIONS.index(seen)]
    found = f"in {share:.0%} of the frames the head is along {seen} from the {evidence.below}"
    if field is None:
        said = f"the file names no up axis, and only {found}, with a steady floor: up is {seen}"
        if strong:
            said = (
                f"the file names no up axis and no floor shows it: up is {seen} because the head "
                f"is there from the {evidence.below}; set orientation.up if this person lies, or "
                "stands on the head, all the time"
            )
            return Judgement(seen, "body", () if _has_floor(evidence, seen) else (said,))
        return Judgement(seen, "body", (said,))
    if strong and (seen[1] == field[1] or _stands(evidence, seen, field)):
        said = f"the file says up is {field}, but {found}: up is {seen}"
        return Judgement(seen, "body", (said,))
    said = (
        f"up is {field} as the file says, although {found}: a person who lies or turns over, or "
        "else a wrong axis field; set orientation.up if so"
    )
    return Judgement(field, "file", (said,))


def _body(evidence: Evidence) -> tuple[UpAxis | None, bool]:
    """Return what the body says, if anything, and whether that leaves no doubt."""
    share = np.nan_to_num(evidence.upright)
    best = int(share.argmax())
    if share[best] >= STRONG:
        return DIRECTIONS[best], True
    rivals = np.flatnonzero(share >= CANDIDATE)
    if len(rivals) == 0:
        return None, False
    steady = rivals[np.argsort(evidence.sway[rivals], kind="stable")]
    first = int(steady[0])
    if len(steady) == 1 or evidence.sway[first] <= STEADIER * evidence.sway[steady[1]]:
        return DIRECTIONS[first], False
    return None, False


def _stands(evidence: Evidence, seen: UpAxis, field: UpAxis) -> bool:
    """Tell a standing person in a file with a wrong field from one who lies across a right one.

    Who stands has a floor under the feet: it stays, or it is the file's zero, while the end of the
    body along the field's axis does neither.
    """
    under, across = DIRECTIONS.index(seen), DIRECTIONS.index(field)
    sway, floor = evidence.sway, np.abs(evidence.floor)
    is_zero = bool(floor[under] <= ON_FLOOR < floor[across])
    return is_zero or _stays(float(sway[under]), float(sway[across]))


def _has_floor(evidence: Evidence, seen: UpAxis) -> bool:
    """Tell a person who stands from one who does nothing but lie, or stand on the head.

    As `_stands`, against every other end of the body: of somebody on the head it is the end at the
    head that stays, and lies at zero.
    """
    under = DIRECTIONS.index(seen)
    sway, floor = evidence.sway, np.abs(evidence.floor)
    opposite, across = under ^ 1, [i for i in range(6) if i // 2 != under // 2]
    if sway[under] > sway[opposite] and floor[under] > ON_FLOOR:
        return False
    is_zero = bool(floor[under] <= ON_FLOOR)
    return is_zero or _stays(float(sway[under]), float(sway[across].min()))


def _overhead_floor(evidence: Evidence, field: UpAxis) -> tuple[str, ...]:
    """Return a warning where nobody shows up, and what stays in place is on top by the field."""
    under = DIRECTIONS.index(field)
    floor, top = float(evidence.sway[under]), float(evidence.sway[under ^ 1])
    if not (top < MOVING and top <= STEADIER * floor):  # also catches NaN
        return ()
    return (
        f"up is {field} as the file says, but the upper end stays in place as feet on a floor do, "
        f"and the lower one does not: set orientation.up to {DIRECTIONS[under ^ 1]} if the body "
        "is upside down",
    )


def _stays(floor: float, rival: float) -> bool:
    return rival > MOVING and floor <= STEADIER * rival


def _from_scene(evidence: Evidence) -> Judgement:
    """Without a body and without a field: a steady floor, a tall scene, or the custom."""
    said = "nothing in the file names the up axis and no body shows it; taken from {}: {}"
    if np.isfinite(evidence.sway).all():
        sway = evidence.sway.reshape(3, 2)  # axes, ends
        steady, next_steady = np.argsort(sway.min(axis=1), kind="stable")[:2]
        if _stays(float(sway[steady].min()), float(sway[next_steady].min())):
            up = DIRECTIONS[int(2 * steady + sway[steady].argmin())]
            return Judgement(up, "floor", (said.format("the end that stays in place", up),))
        tall, next_tall = np.argsort(-evidence.extent, kind="stable")[:2]
        if evidence.extent[tall] > TALLER * evidence.extent[next_tall]:
            ends = np.abs(evidence.floor[2 * tall : 2 * tall + 2])
            up = DIRECTIONS[int(2 * tall + (ends[1] < ends[0]))]  # the floor is nearer to zero
            return Judgement(up, "extent", (said.format("the longest extent", up),))
    return Judgement("+z", "assumed", (said.format("custom", "+z"),))
