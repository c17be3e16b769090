"""Names of limbs: a person's where the tree is a person, ``limb_01``… elsewhere."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import Json
from kinesphere.skeleton.discovery.figure import Figure
from kinesphere.skeleton.discovery.person import Person, find_person
from kinesphere.skeleton.discovery.sides import Sides, find_sides

SURE = 0.75
"""Least confidence of a reading for names to be given."""
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

    @property
    def given(self) -> bool:
        """Whether any limb has a name."""
        return bool(np.isfinite(self.confidence))


def find_names(figure: Figure, tree: Sequence[int]) -> Names:
    """Name the bodies of a tree.

    A person needs two legs of two bodies at least; left and right need feet, bent knees or bent
    elbows. Without sides pelvis, trunk and head keep their names and the rest is numbered.
    """
    found = find_person(figure, tree)
    nobody = no_names(tree, "no person is seen in the tree of bodies; limbs are numbered")
    if found is None:
        return nobody
    person, confidence = found
    if not person.convincing:
        return replace(nobody, cost=person.cost)
    account: dict[str, Json] = {
        "person": True,
        "tree_confidence": round(confidence, 3),
        "cost_per_length": round(person.cost / person.lengths, 2),
    }
    if confidence < SURE:
        doubt = (
            f"the tree can be read as a person in more than one way (confidence {confidence:.2f}); "
            "limbs are numbered"
        )
        return replace(no_names(tree, doubt), account=account, cost=person.cost)
    sides = find_sides(figure, person)
    given = _torso(person)
    if sides is None:
        doubt = "nothing tells left from right; arms and legs are numbered"
        return Names(numbered(given, tree), confidence, account, doubt, person.cost)
    account |= {"sides_confidence": round(sides.confidence, 3)}
    account |= {f"sides_from_{name}": round(score, 2) for name, score in sides.scores.items()}
    given |= _sided(person, sides)
    sure = confidence * sides.confidence
    return Names(numbered(given, tree), sure, account, cost=person.cost)


def no_names(tree: Sequence[int], doubt: str = "") -> Names:
    """Return numbers for the bodies of a tree."""
    return Names(numbered({}, tree), np.nan, {"person": False}, doubt)


def _torso(person: Person) -> dict[int, str]:
    if person.pelvis is None:
        given = {person.trunk: "trunk"}
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


def numbered(given: dict[int, str], tree: Sequence[int]) -> dict[int, str]:
    """Return body of the tree → its name, or the next of ``limb_01``, ``limb_02``…, in order."""
    free = (f"limb_{k:02d}" for k in range(1, len(tree) + 1))
    return {body: given[body] if body in given else next(free) for body in tree}
