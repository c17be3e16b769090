"""How much a person's proportions are off.

Shares of stature after Drillis & Contini (1966), *Body segment parameters*, report 1166-03, as
printed in Winter (2009), *Biomechanics and motor control of human movement*, figure 4.1: thigh
.245, shank .246, upper arm .186, forearm .146; joint centres of hips .10 apart, of shoulders .23.
"""

from dataclasses import replace

import numpy as np

from kinesphere.skeleton.discovery.figure import Figure, Point
from kinesphere.skeleton.discovery.person import Person, off

THIGH, SHANK, UPPER_ARM, FOREARM, FOOT, HAND = 0.245, 0.246, 0.186, 0.146, 0.12, 0.06
HIPS, SHOULDERS, TRUNK, HEAD = 0.10, 0.23, 0.29, 0.42
"""Hip to hip, shoulder to shoulder, hips to shoulders, hips to the middle of the head."""
LONE_ARMS = {"whole": UPPER_ARM + FOREARM, "upper": UPPER_ARM}
"""Of an arm of one body, from the shoulder to its end."""
LONE_ARM, PLAIN_LENGTH = 0.25, 0.75
"""Standard deviation of that length's logarithm, and how many of them off it is plainly such an
arm: whole arms of a person had 0.30 to 0.35 of stature, half of one with the hand 0.26."""
SHORT = 0.3
"""Standard deviation of the logarithm of a shank's length to its farthest marker."""
MISSING = 4.0
"""Cost of a foot, a forearm, an arm or the head that is not there, or not by itself: as much as two
standard deviations."""
HEADS, ABOVE = 0.2, 4.0
"""Standard deviation of the logarithm of a head's distance, and what it costs if another body on
the trunk is as far as heads are and farther than this one: what lies between is the trunk's."""
EXTRA = 2.0
"""Cost of a body between trunk and upper arm: a shoulder blade of its own."""
HELD, UNEXPLAINED = 2.0, 6.0
"""Costs of a body that is no limb of the person: beyond the end of one, a racket; and elsewhere,
what one person in twenty has (2 log 20). With 2 for both, dropouts of 5 % made a walker's legs hang
from the trunk; with 4 to 8 for both, a racket was a hand."""


def judged(figure: Figure, person: Person, n_bodies: int) -> Person:
    """Return the reading with what its proportions cost, in squared standard deviations."""
    legs = [figure.ends(person.hips_at, leg) for leg in person.legs]
    thighs = [figure.length(leg[0], leg[1]) for leg in legs]
    shanks = [figure.length(leg[1], leg[2]) for leg in legs]
    ankles = min(len(leg) for leg in person.legs) > 2
    # without feet a shank ends at a marker, wherever that is
    bones, share = (thighs + shanks, THIGH + SHANK) if ankles else (thighs, THIGH)
    stature = sum(bones) / 2 / share
    if not stature > 0:
        return person
    offs = [
        *(off(length, THIGH * stature, 0.15) for length in thighs),
        *(off(length, SHANK * stature, 0.15 if ankles else SHORT) for length in shanks),
        off(thighs[0], thighs[1], 0.1),
        off(shanks[0], shanks[1], 0.1 if ankles else SHORT),
        off(figure.length(legs[0][0], legs[1][0]), HIPS * stature, 0.4),
    ]
    missing = 0.0
    for leg, ends in zip(person.legs, legs, strict=True):
        if len(leg) > 2:
            offs.append(off(figure.length(ends[2], ends[3]), FOOT * stature, 0.5))
        else:
            missing += MISSING
    hips = ("amid", legs[0][0], legs[1][0])
    arms = [figure.ends(at, arm) for at, arm in person.arms]
    for arm in arms:
        if len(arm) < 3:
            offs += _lone_arm(figure, arm, hips, stature)
            missing += MISSING
            continue
        offs.append(off(figure.length(arm[0], arm[1]), UPPER_ARM * stature, 0.25))
        offs.append(off(figure.length(arm[1], arm[2]), FOREARM * stature, 0.35))
        if len(arm) > 3:
            offs.append(off(figure.length(arm[2], arm[3]), HAND * stature, 0.5))
    if len(arms) == 2:
        offs.append(off(figure.length(arms[0][0], arms[1][0]), SHOULDERS * stature, 0.35))
        uppers = [figure.length(arm[0], arm[1]) for arm in arms]
        if min(map(len, arms)) > 2 or max(map(len, arms)) < 3:
            offs.append(off(uppers[0], uppers[1], 0.15))
    if arms:
        shoulders = ("amid", *(arm[0] for arm in arms))
        offs.append(off(figure.length(hips, shoulders), TRUNK * stature, 0.25))
    if person.head is not None:
        head = ("body", person.head)
        offs.append(off(figure.length(hips, head), HEAD * stature, HEADS))
        missing += ABOVE * _rather_the_head(figure, person, hips, stature)
    missing += MISSING * (2 - len(arms)) + MISSING * (person.head is None)
    blades = sum(at != person.trunk for at, _ in person.arms)
    held = _held(figure, person)
    unexplained = n_bodies - blades - len(person.limbs) - held
    missing += EXTRA * blades + HELD * held + UNEXPLAINED * unexplained
    square = np.nan_to_num(np.array(offs) ** 2, nan=np.inf)
    known = replace(person, lengths=len(offs), stature=stature * figure.unit)
    return replace(known, cost=float(square.sum()) + missing)


def _held(figure: Figure, person: Person) -> int:
    """Return how many bodies hang from the ends of a person's limbs."""
    chains = [(person.hips_at, *leg) for leg in person.legs]
    chains += [(at, *arm) for at, arm in person.arms]
    return sum(_beyond(figure, chain[-1], chain[-2]) for chain in chains)


def _beyond(figure: Figure, body: int, before: int) -> int:
    others = [other for other in figure.beside[body] if other != before]
    return len(others) + sum(_beyond(figure, other, body) for other in others)


def kind_of_lone_arm(figure: Figure, at: int, body: int, stature: float) -> str:
    """Return what the one body of an arm is: "whole" arm, "upper" arm, or nothing if in doubt.

    Forearm and hand below an upper arm that stays with the trunk lie between the two.

    Parameters
    ----------
    figure
    at, body
        What the arm hangs from, and the arm.
    stature
        m, of the person.
    """
    length = figure.length(*figure.ends(at, (body,))) * figure.unit
    offs = {kind: off(length, share * stature, LONE_ARM) for kind, share in LONE_ARMS.items()}
    return next((kind for kind, how in offs.items() if abs(how) < PLAIN_LENGTH), "")


def _rather_the_head(figure: Figure, person: Person, hips: Point, stature: float) -> bool:
    """Return whether a body that is no limb is rather the head: farther from the hips."""
    taken = {*person.limbs, *(at for at, _ in person.arms)}
    ways = [figure.length(hips, ("body", b)) for b in figure.beside[person.trunk] if b not in taken]
    farthest = max((w for w in ways if abs(off(w, HEAD * stature, HEADS)) < 2), default=0.0)
    return farthest > figure.length(hips, ("body", person.head))


def _lone_arm(figure: Figure, arm: list[Point], hips: Point, stature: float) -> list[float]:
    """Return how far the one body of an arm is off, and how far its joint is from a shoulder."""
    length = figure.length(arm[0], arm[1])
    ways = [off(length, share * stature, LONE_ARM) for share in LONE_ARMS.values()]
    shoulder = float(np.hypot(TRUNK, SHOULDERS / 2)) * stature
    return [min(ways, key=abs), off(figure.length(hips, arm[0]), shoulder, 0.25)]
