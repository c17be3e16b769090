"""Front or back: what the feet, knees, elbows and the walk say, and who has the last word."""

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np

from kinesphere.data import Array, Json
from kinesphere.errors import AmbiguousFacing, BadSetting
from kinesphere.normalization.anatomy import without_side
from kinesphere.normalization.samples import Samples

Facing: TypeAlias = Literal[
    "+x", "-x", "+y", "-y", "+z", "-z", "feet", "knees", "elbows", "walking", "names"
]
"""Where the body faces in its default position, in the world; or the one witness to believe."""

_WEIGHTS = {"feet": 1.0, "knees": 0.5, "walking": 0.5, "elbows": 0.25}
_FLEXED = np.deg2rad(20.0)  # below this a joint centre a little off its place outvotes the knee
_WALKS = 0.25  # spans a second; slower than that people shuffle in any direction
_LOW = 0.25  # share of the body's height; joints below it may be ankles
_LEAST = 0.1  # weighted score from which there is an answer
_CONTRADICTION = -0.3


@dataclass(frozen=True)
class Witness:
    """What one part of the body says about a proposed front."""

    score: float
    """1 where it fully agrees, −1 where it says the front is the back."""
    weight: float


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
    chosen: Array,
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
    chosen : (n,) of bool
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
    witnesses = {
        name: witness
        for name, witness in (
            ("feet", _feet(samples, bodies, chosen)),
            ("knees", _hinges(samples, bodies, "thigh", "shank", sign=-1.0)),
            ("elbows", _hinges(samples, bodies, "upper_arm", "forearm", sign=1.0)),
            ("walking", _walking(samples, bodies)),
        )
        if witness is not None
    }
    total = sum(witness.weight for witness in witnesses.values())
    voices = sum(witness.weight * witness.score for witness in witnesses.values())
    score = voices / total if total > 0 else 0.0
    said = ", ".join(f"{name} {witness.score:+.2f}" for name, witness in witnesses.items())
    if facing in ("names", *_WEIGHTS) or facing is None:
        if facing in _WEIGHTS:
            if facing not in witnesses or abs(witnesses[facing].score) < _LEAST:
                raise AmbiguousFacing(
                    f"no front from the {facing} here; what tells: {said or 'nothing'}"
                )
            turn, decided_by = witnesses[facing].score < 0, str(facing)
        elif named:
            turn, decided_by = False, "names"
        elif facing == "names":
            raise AmbiguousFacing(
                "no pair of left and right limbs is named, so names cannot tell the front"
            )
        elif abs(score) >= _LEAST:
            turn, decided_by = score < 0, max(witnesses, key=lambda n: witnesses[n].weight)
        else:
            raise AmbiguousFacing(
                "nothing tells front from back: no pair of limbs is named left and right, and "
                f"feet, flexed knees and elbows and the walk say {said or 'nothing'}; "
                "pass facing, e.g. '+x' for the world direction the person faces while standing"
            )
    else:
        turn, decided_by = _against(bodies[best], facing), f"user ({facing})"
    warnings = _objections(turn, decided_by, score, said, named=named)
    return Verdict(turn, decided_by, witnesses, warnings)


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


def _against(body: Array, facing: str) -> bool:
    """Return whether the front points away from a world axis such as ``+x``."""
    axis = np.eye(3)["xyz".index(facing[1])] * (1.0 if facing[0] == "+" else -1.0)
    along = float(body[:, 0] @ axis)
    if not abs(along) >= _LEAST:  # also catches NaN
        raise AmbiguousFacing(
            f"facing {facing} lies across the body's front and back; in the default position "
            f"the front is ±({body[0, 0]:.2f}, {body[1, 0]:.2f}, {body[2, 0]:.2f}) in the world"
        )
    return along < 0


def _feet(samples: Samples, bodies: Array, chosen: Array) -> Witness | None:
    """Feet point forward in the default position."""
    scores = []
    for limb in feet_of(samples, chosen):
        along = samples.directions[chosen, limb]
        forward = np.einsum("fi,fi->f", along, bodies[chosen, :, 0])
        sideways = np.einsum("fi,fi->f", along, bodies[chosen, :, 2])
        level = np.hypot(forward, sideways)
        usable = level > 0.1
        scores.append(forward[usable] / level[usable])
    return _mean(np.concatenate(scores), _WEIGHTS["feet"]) if scores else None


def feet_of(samples: Samples, chosen: Array) -> list[int]:
    """Return the limbs that are feet: by name, else low ends of chains that point level."""
    anatomy = samples.anatomy
    named = [i for name, i in anatomy.limbs.items() if without_side(name) == "foot"]
    if named or any(without_side(name) != name for name in anatomy.limbs):
        return named
    height = np.nanmedian(samples.joints[chosen][:, :, 1], axis=0)
    low = np.nanmin(height) + _LOW * (np.nanmax(height) - np.nanmin(height))
    found = []
    for joint in range(len(height)):
        limb = joint + 1
        pitch = np.abs(samples.directions[chosen, limb, 1])
        pitch = pitch[np.isfinite(pitch)]
        level = len(pitch) > 0 and np.median(pitch) < np.sin(np.deg2rad(60.0))
        if not anatomy.distal_joints[limb] and height[joint] < low and level:
            found.append(limb)
    return found


def _hinges(samples: Samples, bodies: Array, upper: str, lower: str, sign: float) -> Witness | None:
    """Knees bend the shank backward, elbows the forearm forward; only where they are bent."""
    limbs = samples.anatomy.limbs
    scores, weights = [], []
    for side in ("left_", "right_"):
        if side + upper not in limbs or side + lower not in limbs:
            continue
        above = samples.directions[:, limbs[side + upper]]
        below = samples.directions[:, limbs[side + lower]]
        axis = sign * np.cross(above, below)
        sine = np.linalg.norm(axis, axis=1)
        angle = np.arctan2(sine, (above * below).sum(axis=1))
        bent = angle > _FLEXED  # False where NaN
        scores.append(np.einsum("fi,fi->f", axis, bodies[:, :, 2])[bent] / sine[bent])
        weights.append(angle[bent] ** 2)
    if not scores:
        return None
    return _mean(
        np.concatenate(scores),
        _WEIGHTS["knees" if upper == "thigh" else "elbows"],
        np.concatenate(weights),
    )


def _walking(samples: Samples, bodies: Array) -> Witness | None:
    """People walk forward."""
    known = np.asarray(np.isfinite(samples.velocities).any(axis=(1, 2)))
    if not known.any():
        return None
    velocity = np.full((len(known), 3), np.nan)
    velocity[known] = np.nanmedian(samples.velocities[known], axis=1)
    velocity[:, 1] = 0.0
    speed = np.linalg.norm(velocity, axis=1)
    walks = speed > _WALKS * samples.anatomy.span
    forward = np.einsum("fi,fi->f", velocity, bodies[:, :, 0])
    return _mean(forward[walks] / speed[walks], _WEIGHTS["walking"], speed[walks])


def _mean(scores: Array, weight: float, weights: Array | None = None) -> Witness | None:
    known = np.isfinite(scores)
    if not known.any():
        return None
    w = None if weights is None else weights[known]
    return Witness(float(np.average(scores[known], weights=w)), weight)
