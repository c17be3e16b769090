"""Names of limbs: a person's where the tree is a person, ``limb_01``… elsewhere."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import Json
from kinesphere.skeleton.discovery.figure import Figure
from kinesphere.skeleton.discovery.forest import DOUBTFUL, Forest
from kinesphere.skeleton.discovery.person import Person, confidence_of, find_person
from kinesphere.skeleton.discovery.sides import Sides, find_sides

SURE = 0.75
"""Least confidence of a reading for names to be given."""
EVEN = 0.6
"""Confidence below which names are told to be unsure: of thirds and halves of recordings one of two
between .5 and this has a wrong one."""
GIVEN = 0.45
"""Least confidence for names to be given: below, 4 of 9 parts of recordings had wrong ones, above
1 of 19; all whole recordings at hand are above."""
DOUBTFUL_COUNT = 0.3
"""Confidence below which another number of bodies would do about as well: it is above .7 on
synthetic bodies and rigid plates, .27 to .73 on sparse markers of a person."""
NOBODY = (
    "no person is seen in the tree of bodies; limbs are numbered. If it was a person, bodies or "
    "joints are wrong, or limbs have no markers"
)
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
    refused: str = ""
    """Why these names are not given after all: the reading is good, the size is not a person's."""

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
    nobody = no_names(tree, NOBODY)
    if found is None:
        return nobody
    person, confidence = found
    if not person.convincing:
        return replace(nobody, cost=person.cost)
    account: dict[str, Json] = {
        "person": True,
        "tree_confidence": round(confidence, 3),
        "cost_per_length": round(person.cost / person.lengths, 2),
        "stature_m": round(person.stature, 2),
    }
    if confidence < SURE:
        return replace(no_names(tree, _ambiguous(confidence)), account=account, cost=person.cost)
    refused = ""
    if not person.of_human_size:
        refused = (
            "by its proportions the tree could be a person, but the size is not a person's "
            f"(legs of someone of {person.stature:.2f} m): limbs are numbered; if it was a "
            "person, the unit of length is wrong"
        )
    elif (sized := confidence_of(person.cost + person.size, person.nobody)) < confidence:
        confidence = sized
        refused = "" if sized >= SURE else _ambiguous(sized)
    sides = find_sides(figure, person)
    given = _torso(person)
    if sides is None:
        doubt = "nothing tells left from right; arms and legs are numbered"
        return Names(numbered(given, tree), confidence, account, doubt, person.cost, refused)
    account |= {"sides_confidence": round(sides.confidence, 3)}
    account |= {f"sides_from_{name}": round(score, 2) for name, score in sides.scores.items()}
    given |= _sided(person, sides)
    sure = confidence * sides.confidence
    return Names(numbered(given, tree), sure, account, cost=person.cost, refused=refused)


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


def shaken(names: Names, forest: Forest, count_confidence: float) -> Names:
    """Return the names with what doubt in the bodies they stand on leaves of their confidence.

    A name is no surer than the tree it was read off: where the most doubtful edge of a named limb
    has a rival of the same cost, or another number of bodies would do as well, half is left. Where
    too little is, limbs are numbered, and the likely names are told.

    Parameters
    ----------
    names
        As proportions and sides give them.
    forest
        Of all bodies.
    count_confidence
        0…1 that there are so many bodies.
    """
    if not names.given:
        return names
    named = {body for body, limb in names.limbs.items() if not limb.startswith("limb_")}
    edges = [edge.confidence for edge in forest.edges if named & {edge.a, edge.b}]
    tree = (1 + min(1.0, min(edges, default=1.0) / DOUBTFUL)) / 2
    count = (1 + min(1.0, count_confidence / DOUBTFUL_COUNT)) / 2
    sure = names.confidence * tree * count
    account = names.account | {"bodies_confidence": round(tree * count, 3)}
    doubt = names.doubt
    if sure < GIVEN:
        of_names = next(bodies for bodies in forest.trees if bodies[0] in names.limbs)
        return _withheld(replace(names, confidence=sure, account=account), of_names)
    if sure < EVEN:
        told = f"names of limbs are unsure and may be wrong (confidence {sure:.2f}): check them"
        doubt = f"{doubt}; {told}" if doubt else told
    return replace(names, confidence=sure, account=account, doubt=doubt)


def _withheld(names: Names, tree: Sequence[int]) -> Names:
    """Return numbers for the named limbs too, and which names were likely."""
    numbers = numbered({}, tree)
    likely: dict[str, Json] = {
        numbers[body]: names.limbs[body]
        for body in tree
        if not names.limbs[body].startswith("limb_")
    }
    account = names.account | {
        "person": False,
        "likely_names": likely,
        "likely_confidence": round(names.confidence, 3),
    }
    told = (
        f"names of limbs were too unsure to be given (confidence {names.confidence:.2f}): limbs "
        f"are numbered; likely were {', '.join(f'{k} {limb}' for k, limb in likely.items())}"
    )
    return Names(numbers, np.nan, account, told, names.cost)


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


def numbered(given: dict[int, str], tree: Sequence[int]) -> dict[int, str]:
    """Return body of the tree → its name, or the next of ``limb_01``, ``limb_02``…, in order."""
    free = (f"limb_{k:02d}" for k in range(1, len(tree) + 1))
    return {body: given[body] if body in given else next(free) for body in tree}
