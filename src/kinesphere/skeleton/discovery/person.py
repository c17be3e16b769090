"""Is the tree a person, and which body is which limb: proportions decide.

Shares of stature after Drillis & Contini (1966), *Body segment parameters*, report 1166-03, as
printed in Winter (2009), *Biomechanics and motor control of human movement*, figure 4.1: thigh
.245, shank .246, upper arm .186, forearm .146; joint centres of hips .10 apart, of shoulders .23.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product

import numpy as np

from kinesphere.skeleton.discovery.figure import Figure

THIGH, SHANK, UPPER_ARM, FOREARM, FOOT, HAND = 0.245, 0.246, 0.186, 0.146, 0.12, 0.06
HIPS, SHOULDERS, TRUNK, HEAD = 0.10, 0.23, 0.29, 0.42
"""Hip to hip, shoulder to shoulder, hips to shoulders, hips to the middle of the head."""
MISSING = 4.0
"""Cost of a foot, an arm or the head that is not there: as much as two standard deviations."""
EXTRA = 2.0
"""Cost of a body between trunk and upper arm: a shoulder blade of its own."""
HELD, UNEXPLAINED = 2.0, 6.0
"""Costs of a body that is no limb of the person: beyond the end of one, a racket; and elsewhere,
what one person in twenty has (2 log 20). With 2 for both, dropouts of 5 % made a walker's legs hang
from the trunk; with 4 to 8 for both, a racket was a hand."""
LIKELY = 2.0
"""Most cost for each length that is judged, in squared standard deviations: of a person 1 at most
is expected, of what is none far more."""
STATURE, SIZES = 1.6, 0.25
"""m, and standard deviation of its logarithm: from a child of two, 0.85 m, to a tall adult."""
SHARPNESS = 2.0
"""Difference of costs that makes one reading e times likelier than another."""


_Arm = tuple[int, tuple[int, ...]]


@dataclass(frozen=True)
class Person:
    """One reading of a tree as a person, left and right not yet told apart."""

    trunk: int
    pelvis: int | None
    """None where trunk and pelvis are one body."""
    legs: tuple[tuple[int, ...], tuple[int, ...]]
    """Thigh, shank and, if there is one, foot; the bodies beyond stay out."""
    arms: tuple[_Arm, ...]
    """What each arm hangs from, the trunk or a shoulder blade of its own; and upper arm, forearm
    and, if there is one, hand."""
    head: int | None
    cost: float = np.inf
    """Squared standard deviations of the proportions, and of what is missing or too much; of a
    person of any size."""
    lengths: int = 0
    """How many lengths were judged."""
    stature: float = np.nan
    """m, what the legs are the legs of."""

    @property
    def nobody(self) -> float:
        """What it costs to see no person at all."""
        return LIKELY * self.lengths

    @property
    def size(self) -> float:
        """What the stature alone costs."""
        return _off(self.stature, STATURE, SIZES) ** 2

    @property
    def convincing(self) -> bool:
        """Whether the proportions are those of a person, of any size."""
        return self.cost <= self.nobody

    @property
    def of_human_size(self) -> bool:
        """Whether proportions and size together are those of a person."""
        return self.cost + self.size <= self.nobody

    @property
    def hips_at(self) -> int:
        """The body the legs hang from."""
        return self.trunk if self.pelvis is None else self.pelvis


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
    readings = [_judged(figure, person, len(tree)) for person in _readings(figure, tree)]
    readings = [person for person in readings if np.isfinite(person.cost)]
    if not readings:
        return None
    readings.sort(key=lambda person: person.cost)
    best = readings[0]
    mine = _limbs(best)
    rival = next((p.cost for p in readings[1:] if _contradicts(_limbs(p), mine)), np.inf)
    return best, confidence_of(best.cost, min(rival, best.nobody))


def confidence_of(cost: float, rival: float) -> float:
    """Return 0…1 that a reading is right rather than one of another cost."""
    return float(1 / (1 + np.exp(-(rival - cost) / SHARPNESS)))


def _readings(figure: Figure, tree: Sequence[int]) -> Iterator[Person]:
    """Yield every way to see two legs, up to two arms and up to one head in a tree."""
    for trunk in tree:
        for pelvis in (None, *figure.beside[trunk]):
            base = trunk if pelvis is None else pelvis
            lower = [b for b in figure.beside[base] if b != trunk]
            for pair in combinations(lower, 2):
                legs = tuple(figure.chain(base, start)[:3] for start in pair)
                if min(len(leg) for leg in legs) < 2:
                    continue
                used = {pelvis, *pair}
                upper = [b for b in figure.beside[trunk] if b not in used]
                for arms in _arm_sets(figure, trunk, upper):
                    taken = {b for at, arm in arms for b in (at, *arm)}
                    for head in (None, *(b for b in upper if b not in taken)):
                        yield Person(trunk, pelvis, (legs[0], legs[1]), arms, head)


def _arm_sets(figure: Figure, trunk: int, upper: list[int]) -> Iterator[tuple[_Arm, ...]]:
    """Yield up to two arms; the first of three and more bodies in a row may be a shoulder blade."""
    chains = [chain for b in upper if len(chain := figure.chain(trunk, b)) > 1]
    for count in range(3):
        for chosen in combinations(chains, count):
            yield from product(*(_ways(trunk, chain) for chain in chosen))


def _ways(trunk: int, chain: tuple[int, ...]) -> list[_Arm]:
    """Return how a chain can be an arm: with or without a shoulder blade, a hand, a tool in it."""
    whole = [(trunk, chain[:3]), *([(chain[0], chain[1:4])] if len(chain) > 2 else [])]
    return [*whole, *((at, arm[:2]) for at, arm in whole if len(arm) > 2)]


def _judged(figure: Figure, person: Person, n_bodies: int) -> Person:
    """Return the reading with what its proportions cost, in squared standard deviations."""
    legs = [figure.ends(person.hips_at, leg) for leg in person.legs]
    thighs = [figure.length(leg[0], leg[1]) for leg in legs]
    shanks = [figure.length(leg[1], leg[2]) for leg in legs]
    stature = (sum(thighs) + sum(shanks)) / 2 / (THIGH + SHANK)
    if not stature > 0:
        return person
    off = [
        *(_off(length, THIGH * stature, 0.15) for length in thighs),
        *(_off(length, SHANK * stature, 0.15) for length in shanks),
        _off(thighs[0], thighs[1], 0.1),
        _off(shanks[0], shanks[1], 0.1),
        _off(figure.length(legs[0][0], legs[1][0]), HIPS * stature, 0.4),
    ]
    missing = 0.0
    for leg, ends in zip(person.legs, legs, strict=True):
        if len(leg) > 2:
            off.append(_off(figure.length(ends[2], ends[3]), FOOT * stature, 0.5))
        else:
            missing += MISSING
    hips = ("amid", legs[0][0], legs[1][0])
    arms = [figure.ends(at, arm) for at, arm in person.arms]
    for arm in arms:
        off.append(_off(figure.length(arm[0], arm[1]), UPPER_ARM * stature, 0.25))
        off.append(_off(figure.length(arm[1], arm[2]), FOREARM * stature, 0.35))
        if len(arm) > 3:
            off.append(_off(figure.length(arm[2], arm[3]), HAND * stature, 0.5))
    if len(arms) == 2:
        off.append(_off(figure.length(arms[0][0], arms[1][0]), SHOULDERS * stature, 0.35))
        uppers = [figure.length(arm[0], arm[1]) for arm in arms]
        off.append(_off(uppers[0], uppers[1], 0.15))
    if arms:
        shoulders = ("amid", *(arm[0] for arm in arms))
        off.append(_off(figure.length(hips, shoulders), TRUNK * stature, 0.25))
    if person.head is not None:
        head = ("body", person.head)
        off.append(_off(figure.length(hips, head), HEAD * stature, 0.2))
    missing += MISSING * (2 - len(arms)) + MISSING * (person.head is None)
    blades = sum(at != person.trunk for at, _ in person.arms)
    held = _held(figure, person)
    unexplained = n_bodies - blades - len(_limbs(person)) - held
    missing += EXTRA * blades + HELD * held + UNEXPLAINED * unexplained
    square = np.nan_to_num(np.array(off) ** 2, nan=np.inf)
    judged = replace(person, lengths=len(off), stature=stature * figure.unit)
    return replace(judged, cost=float(square.sum()) + missing)


def _held(figure: Figure, person: Person) -> int:
    """Return how many bodies hang from the ends of a person's limbs."""
    ends = [leg[-2:] for leg in person.legs] + [arm[-2:] for _, arm in person.arms]
    return sum(_beyond(figure, last, before) for before, last in ends)


def _beyond(figure: Figure, body: int, before: int) -> int:
    others = [other for other in figure.beside[body] if other != before]
    return len(others) + sum(_beyond(figure, other, body) for other in others)


def _off(found: float, expected: float, deviation: float) -> float:
    """Return how many deviations of its logarithm a length is off."""
    if not (found > 0 and expected > 0):
        return np.nan
    return float(np.log(found / expected) / deviation)


def _limbs(person: Person) -> dict[int, str]:
    """Return body → kind of limb."""
    kinds = {person.trunk: "trunk"}
    if person.pelvis is not None:
        kinds[person.pelvis] = "pelvis"
    for leg in person.legs:
        kinds |= dict(zip(leg, ("thigh", "shank", "foot"), strict=False))
    for _, arm in person.arms:
        kinds |= dict(zip(arm, ("upper_arm", "forearm", "hand"), strict=False))
    if person.head is not None:
        kinds[person.head] = "head"
    return kinds


def _contradicts(kinds: dict[int, str], others: dict[int, str]) -> bool:
    return any(others.get(body, kind) != kind for body, kind in kinds.items())
