"""Names of limbs: a person's where the tree is a person, ``limb_01``… elsewhere."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from kinesphere.data import Json
from kinesphere.skeleton.discovery.figure import Figure
from kinesphere.skeleton.discovery.likeliest import confidence_of, find_person
from kinesphere.skeleton.discovery.person import Person
from kinesphere.skeleton.discovery.proportions import kind_of_lone_arm
from kinesphere.skeleton.discovery.sides import Sides, find_sides
from kinesphere.skeleton.discovery.upper_half import (
    NO_LEGS,
    find_upper_half,
    sides_of_upper_half,
)

SURE = 0.75
"""Least confidence of a reading for names to be given."""
NOBODY = (
    "no person is seen in the tree of bodies; limbs are numbered. If it was a person, bodies or "
    "joints are wrong, or limbs have no markers"
)
ANIMAL = (
    "by proportions alone the tree could be a person, but four legs of equal length across the "
    "trunk are rather an animal's: limbs are numbered"
)
SIDES = ("left_", "right_")
LEG = ("thigh", "shank", "foot")
ARM = ("upper_arm", "forearm", "hand")


@dataclass(frozen=True)
class Names:
    """What the limbs are called."""

    limbs: dict[int, str]
    """Body of the tree → name."""
    confidence: float
    """0…1 that the names are right; NaN where none is given."""
    account: dict[str, Json]
    """For the history."""
    doubt: str = ""
    """Why there are no names, or not all; for a person."""
    cost: float = np.inf
    """Of the likeliest reading as a person, convincing or not; infinite where there is none."""
    unnamed: frozenset[int] = frozenset()
    """Bodies that are a person's limbs, though not told which."""
    refused: str = ""
    """Why these names are not given after all: the reading is good, the size is not a person's."""
    too_large: float = 1.0
    """By which factor lengths are too large, or below 1 too small, if this is a person."""
    straight: dict[int, str] = field(default_factory=dict)
    """Body that is a whole arm at whose elbow no bend shows → its side."""

    @property
    def sided(self) -> bool:
        """Whether arms and legs have names, so that a numbered limb is an exception."""
        return any(limb.startswith(SIDES) for limb in self.limbs.values())

    @property
    def given(self) -> bool:
        """Whether any limb has a name."""
        return bool(np.isfinite(self.confidence))


def find_names(figure: Figure, tree: Sequence[int], animal: float = np.inf) -> Names:
    """Name the bodies of a tree.

    A person needs two legs of two bodies at least, or trunk, head and two such arms and little
    else; left and right need feet, bent knees or bent elbows. Without sides pelvis, trunk and head
    keep their names and the rest is numbered.

    Parameters
    ----------
    figure
    tree
        The bodies of the tree.
    animal
        What it costs to see an animal instead, in this tree or one that is about as likely.
    """
    found = find_person(figure, tree)
    nobody = no_names(tree, NOBODY)
    if found is None or not found[0].convincing:
        half = find_upper_half(figure, tree)
        if half is None or not half[0].convincing:
            return nobody if found is None else replace(nobody, cost=found[0].cost)
        found = half
    person, confidence = found
    dear = person.cost if person.legs else person.cost + NO_LEGS
    beside_animal = confidence_of(person.cost, animal)
    confidence = min(confidence, beside_animal)
    account: dict[str, Json] = {
        "person": True,
        "tree_confidence": round(confidence, 3),
        "cost_per_length": round(person.cost / person.lengths, 2),
        "stature_m": float(f"{person.stature:.3g}"),
    }
    if beside_animal < SURE:
        account |= {"person": False}
        return replace(no_names(tree, ANIMAL), account=account, cost=dear)
    if confidence < SURE:
        return replace(no_names(tree, _ambiguous(confidence)), account=account, cost=dear)
    refused, times = "", 1.0
    if not person.of_human_size:
        times = person.times_too_large
        refused = (
            "by its proportions the tree could be a person, but the size is not a person's "
            f"({'legs' if person.legs else 'arms'} of someone of {person.stature:.4g} m): limbs "
            "are numbered; if it was a person, the unit of length is wrong"
        )
        if times != 1:
            refused += f", and joints are judged as if lengths were {1 / times:.4g} times as large"
    elif (sized := confidence_of(person.cost + person.size, person.nobody)) < confidence:
        confidence = sized
        refused = "" if sized >= SURE else _ambiguous(sized)
    sides = find_sides(figure, person) if person.legs else sides_of_upper_half(figure, person)
    given = _torso(person)
    if sides is None:
        doubt = "nothing tells left from right; arms and legs are numbered"
        unnamed = frozenset(person.limbs.keys() - given.keys())
        return Names(
            numbered(given, tree), confidence, account, doubt, dear, unnamed, refused, times
        )
    account |= {"sides_confidence": round(sides.confidence, 3)}
    account |= {f"sides_from_{name}": round(score, 2) for name, score in sides.scores.items()}
    lone = {
        arm[0]: kind_of_lone_arm(figure, at, arm[0], person.stature)
        for at, arm in person.arms
        if len(arm) == 1
    }
    sided = _sided(person, sides)
    given |= {b: limb for b, limb in sided.items() if lone.get(b, "upper") == "upper"}
    sure = confidence * sides.confidence
    limbs = numbered(given, tree)
    straight = {b: sided[b].partition("_")[0] for b, kind in lone.items() if kind == "whole"}
    unnamed = frozenset(person.limbs.keys() - given.keys())
    doubt = _doubt_about(limbs, straight)
    return Names(limbs, sure, account, doubt, dear, unnamed, refused, times, straight)


def renumbered(names: Names, tree: Sequence[int]) -> Names:
    """Return the names for a tree that some bodies have left: numbers close up.

    Doubts speak of the limbs that are there, by what they are called now.
    """
    given = {b: names.limbs[b] for b in tree if not names.limbs[b].startswith("limb_")}
    limbs = numbered(given, tree)
    straight = {body: side for body, side in names.straight.items() if body in limbs}
    doubt = _doubt_about(limbs, straight) if names.sided else names.doubt
    return replace(names, limbs=limbs, doubt=doubt, straight=straight)


def settled(names: Names, tree: Sequence[int]) -> Names:
    """Return the names, or numbers where the size says that they are not to be given."""
    if not names.refused:
        return names
    account = names.account | {"person": False}
    return replace(no_names(tree, names.refused), account=account, cost=names.cost)


def _ambiguous(confidence: float) -> str:
    return (
        f"the tree can be read as a person in more than one way (confidence {confidence:.2f}); "
        "limbs are numbered"
    )


def no_names(tree: Sequence[int], doubt: str = "") -> Names:
    """Return numbers for the bodies of a tree."""
    return Names(numbered({}, tree), np.nan, {"person": False}, doubt)


def _torso(person: Person) -> dict[int, str]:
    if person.pelvis is None:
        # with nothing above it, what legs hang from is the pelvis of half a body
        alone = not person.arms and person.head is None
        given = {person.trunk: "pelvis" if alone else "trunk"}
    else:
        given = {person.trunk: "trunk", person.pelvis: "pelvis"}
    if person.head is not None:
        given[person.head] = "head"
    return given


def _sided(person: Person, sides: Sides) -> dict[int, str]:
    given: dict[int, str] = {}
    for i, leg in enumerate(person.legs):
        side = "left" if i == sides.left_leg else "right"
        given |= {b: f"{side}_{kind}" for b, kind in zip(leg, LEG, strict=False)}
    for i, (_, arm) in enumerate(person.arms):
        side = "left" if i == sides.left_arm else "right"
        given |= {b: f"{side}_{kind}" for b, kind in zip(arm, ARM, strict=False)}
    return given


def _doubt_about(limbs: dict[int, str], straight: dict[int, str]) -> str:
    """Return what speaks against the names of a person, and which limbs keep numbers, and why."""
    doubts = []
    if not any(limb.endswith("thigh") for limb in limbs.values()):
        doubts.append(
            "no legs are seen: what is named as the upper half of a person may be an animal's fore "
            "half"
        )
    doubts += [
        f"{limbs[body]} is the whole {side} arm: no bend shows at its elbow"
        for body, side in straight.items()
    ]
    rest = [
        limb for body, limb in limbs.items() if limb.startswith("limb_") and body not in straight
    ]
    if rest:
        doubts.append(
            f"{', '.join(rest)} could not be named though the rest is a person: a part of an arm "
            "or leg, or something held or worn"
        )
    return "; ".join(doubts)


def numbered(given: dict[int, str], tree: Sequence[int]) -> dict[int, str]:
    """Return body of the tree → its name, or the next of ``limb_01``, ``limb_02``…, in order."""
    free = (f"limb_{k:02d}" for k in range(1, len(tree) + 1))
    return {body: given[body] if body in given else next(free) for body in tree}
