"""Front or back: what the feet, knees, elbows and the walk say, and who has the last word."""

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np

from kinesphere.data import Array, Json, Mask, vector_from_direction
from kinesphere.errors import AmbiguousFacing, BadSetting
from kinesphere.normalization.samples import Samples
from kinesphere.normalization.witnesses import WEIGHTS, Witness, witnesses_of

Facing: TypeAlias = Literal[
    "+x", "-x", "+y", "-y", "+z", "-z", "feet", "knees", "elbows", "walking", "names"
]
"""Where the body faces in its default position, in the world; or the one witness to believe."""

_LEAST = 0.1  # weighted score from which there is an answer
_CONTRADICTION = -0.3
_SURE = 0.5  # score from which nothing need be said: wrong fronts had up to 0.42


@dataclass(frozen=True)
class Verdict:
    """Which way round the body is, and why."""

    turn_round: bool
    """True where the proposed front is the back."""
    decided_by: str
    witnesses: dict[str, Witness]
    warnings: tuple[str, ...]

    def as_json(self) -> dict[str, Json]:
        """Return the evidence for the history; scores are those of the final front."""
        sign = -1.0 if self.turn_round else 1.0
        return {
            "decided_by": self.decided_by,
            "scores": {name: sign * witness.score for name, witness in self.witnesses.items()},
        }


def find_facing(
    samples: Samples,
    bodies: Array,
    chosen: Mask,
    best: int,
    *,
    named: bool,
    facing: Facing | None,
) -> Verdict:
    """Decide whether the proposed front of the body is its front.

    Parameters
    ----------
    samples
    bodies : (n, 3, 3)
        Proposed ``world_from_body`` of every sample, carried by the body's own limb.
    chosen : (n,)
        Samples that show the default position.
    best
        The one that shows it best.
    named
        True where left and right are already told apart by names, which then have the last word.
    facing
        What the user says.

    Raises
    ------
    AmbiguousFacing
        If nothing tells.
    BadSetting
        If ``facing`` is not one of the known words.
    """
    if facing is not None and facing not in get_args(Facing):
        raise BadSetting(f"facing is {facing!r}; known are {', '.join(get_args(Facing))}")
    witnesses = witnesses_of(samples, bodies, chosen)
    score = _score(witnesses)
    without_walk = _score({name: w for name, w in witnesses.items() if name != "walking"})
    said = ", ".join(f"{name} {witness.score:+.2f}" for name, witness in witnesses.items())
    turn, decided_by = _decide(witnesses, score, said, bodies[best], named=named, facing=facing)
    warnings = _objections(turn, decided_by, score, said, named=named)
    if facing is None and not named:
        final = -1.0 if turn else 1.0
        told = ", ".join(f"{name} {final * w.score:+.2f}" for name, w in witnesses.items())
        warnings += _little_told(score, without_walk, told)
    return Verdict(turn, decided_by, witnesses, warnings)


def _decide(
    witnesses: dict[str, Witness],
    score: float,
    said: str,
    body: Array,
    *,
    named: bool,
    facing: Facing | None,
) -> tuple[bool, str]:
    """Return whether to turn round, and who said so."""
    if facing is not None and facing[0] in "+-":
        return _against(body, facing), f"user ({facing})"
    if facing in WEIGHTS:
        if facing not in witnesses or abs(witnesses[facing].score) < _LEAST:
            raise AmbiguousFacing(f"no front from the {facing}; what tells: {said or 'nothing'}")
        return witnesses[facing].score < 0, str(facing)
    if named:
        return False, "names"
    if facing == "names":
        raise AmbiguousFacing("no name tells left from right, so names cannot tell the front")
    if abs(score) < _LEAST:
        raise AmbiguousFacing(
            "nothing tells front from back: no limb is named left or right, and feet, flexed knees "
            f"and elbows and the walk say {said or 'nothing'}; pass facing (--facing), e.g. '+x' "
            "for the world direction the person faces while standing"
        )
    agreeing = [n for n, witness in witnesses.items() if witness.score * score > 0]
    return score < 0, ", ".join(agreeing)


def _objections(
    turn: bool, decided_by: str, score: float, said: str, *, named: bool
) -> tuple[str, ...]:
    agreement = -score if turn else score
    if decided_by == "names" and agreement < _CONTRADICTION:
        return (
            f"the names of left and right say that the body faces backwards ({said}): labels of "
            "the sides may be swapped, or the data mirrored; names were followed",
        )
    if named and turn:
        return (
            f"front as told by {decided_by} contradicts the names of left and right; "
            "the limbs called left now lie on the right",
        )
    if agreement < _CONTRADICTION:
        return (f"front as told by {decided_by} contradicts the body ({said})",)
    return ()


def _score(witnesses: dict[str, Witness]) -> float:
    """Return what witnesses say together, weighed, −1 to 1; 0 without any."""
    total = sum(witness.weight for witness in witnesses.values())
    voices = sum(witness.weight * witness.score for witness in witnesses.values())
    return voices / total if total > 0 else 0.0


def _little_told(score: float, without_walk: float, said: str) -> tuple[str, ...]:
    """Return a doubt where the front hangs on little, or on nobody having walked backwards."""
    if abs(score) >= _SURE and without_walk * np.sign(score) >= _LEAST:
        return ()
    little = "little tells" if abs(score) < _SURE else "the walk alone tells"
    return (
        f"{little} front from back ({said}; negative ones are against it), so left and right may "
        "be exchanged; pass facing (--facing), e.g. '+x' for the world direction the person faces "
        "while standing",
    )


def _against(body: Array, facing: str) -> bool:
    """Return whether the front points away from a world axis such as ``+x``."""
    along = float(body[:, 0] @ vector_from_direction(facing))
    if not abs(along) >= _LEAST:  # also catches NaN
        raise AmbiguousFacing(
            f"facing {facing} lies across the body's front and back; in the default position "
            f"the front is ±({body[0, 0]:.2f}, {body[1, 0]:.2f}, {body[2, 0]:.2f}) in the world"
        )
    return along < 0
