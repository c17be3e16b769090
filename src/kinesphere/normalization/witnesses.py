"""What feet, knees, elbows and the walk say about which side of a body is its front."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array, Mask
from kinesphere.geometry.medians import column_medians
from kinesphere.normalization.anatomy import without_side
from kinesphere.normalization.samples import Samples
from kinesphere.normalization.vectors import angle_between, unit

WEIGHTS = {"feet": 1.0, "knees": 0.5, "walking": 0.5, "elbows": 0.25}
_KNEE, _ELBOW = ("thigh", "shank"), ("upper_arm", "forearm")
_FLEXED = np.deg2rad(20.0)  # below this a joint centre a little off its place outvotes the knee
_WALKS = 0.25  # spans a second; slower than that people shuffle in any direction
_LOW = 0.25  # share of the body's height; joints below it may be ankles


@dataclass(frozen=True)
class Witness:
    """What one part of the body says about a proposed front."""

    score: float
    """1 where it fully agrees, −1 where it says the front is the back."""
    weight: float


def witnesses_of(samples: Samples, bodies: Array, chosen: Mask) -> dict[str, Witness]:
    """Return what each part of the body that can tell says; arguments as in `find_facing`."""
    return {
        name: witness
        for name, witness in (
            ("feet", _feet(samples, bodies, chosen)),
            ("knees", _hinges(samples, bodies, _knees(samples, chosen), "knees", bends=-1.0)),
            ("elbows", _hinges(samples, bodies, _named(samples, _ELBOW), "elbows", bends=1.0)),
            ("walking", _walking(samples, bodies)),
        )
        if witness is not None
    }


def _feet(samples: Samples, bodies: Array, chosen: Mask) -> Witness | None:
    """Feet point forward in the default position."""
    scores = []
    for limb in feet_of(samples, chosen):
        along = samples.directions[chosen, limb]
        forward = np.einsum("fi,fi->f", along, bodies[chosen, :, 0])
        sideways = np.einsum("fi,fi->f", along, bodies[chosen, :, 2])
        level = np.hypot(forward, sideways)
        usable = level > 0.1
        scores.append(forward[usable] / level[usable])
    return _mean(np.concatenate(scores), WEIGHTS["feet"]) if scores else None


def feet_of(samples: Samples, chosen: Mask) -> list[int]:
    """Return the limbs that are feet: by name, else low ends of chains that point level."""
    anatomy = samples.anatomy
    named = [i for name, i in anatomy.limbs.items() if without_side(name) == "foot"]
    sided = any(without_side(name) != name for name in anatomy.limbs)
    if named or sided or not anatomy.skeleton.joints:
        return named
    heights = samples.joints[chosen][:, :, 1]
    seen = np.asarray(np.isfinite(heights).any(axis=0))
    height = np.full(len(seen), np.nan)
    height[seen] = np.nanmedian(heights[:, seen], axis=0)
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


def _named(samples: Samples, limbs: tuple[str, str]) -> list[tuple[int, int]]:
    """Return the limbs above and below a hinge, for each side that has both."""
    at = samples.anatomy.limbs
    sides = [(at.get(side + limbs[0]), at.get(side + limbs[1])) for side in ("left_", "right_")]
    return [(above, below) for above, below in sides if above is not None and below is not None]


def _knees(samples: Samples, chosen: Mask) -> list[tuple[int, int]]:
    """Return thighs and shanks: by name, else the two limbs before a foot."""
    if named := _named(samples, _KNEE):
        return named
    parents = samples.anatomy.skeleton.parents
    shanks = [int(parents[foot]) for foot in feet_of(samples, chosen)]
    return [(int(parents[shank]), shank) for shank in shanks if shank > 0 and parents[shank] > 0]


def _hinges(
    samples: Samples, bodies: Array, limbs: list[tuple[int, int]], name: str, bends: float
) -> Witness | None:
    """Knees bend the shank backward, elbows the forearm forward; only where they are bent."""
    scores, weights = [], []
    for upper, lower in limbs:
        above, below = samples.directions[:, upper], samples.directions[:, lower]
        axis = bends * np.cross(above, below)
        angle = angle_between(above, below)
        bent = angle > _FLEXED  # False where NaN
        scores.append(np.einsum("fi,fi->f", unit(axis), bodies[:, :, 2])[bent])
        weights.append(angle[bent] ** 2)
    if not scores:
        return None
    return _mean(np.concatenate(scores), WEIGHTS[name], np.concatenate(weights))


def _walking(samples: Samples, bodies: Array) -> Witness | None:
    """People walk forward."""
    known = np.asarray(np.isfinite(samples.velocities).any(axis=(1, 2)))
    if not known.any():
        return None
    by_joint = np.swapaxes(samples.velocities, 0, 1).reshape(samples.velocities.shape[1], -1)
    velocity = column_medians(by_joint, np.isfinite(by_joint)).reshape(-1, 3)
    velocity[:, 1] = 0.0
    speed = np.linalg.norm(velocity, axis=1)
    walks = speed > _WALKS * samples.anatomy.span
    forward = np.einsum("fi,fi->f", velocity, bodies[:, :, 0])
    return _mean(forward[walks] / speed[walks], WEIGHTS["walking"], speed[walks])


def _mean(scores: Array, weight: float, weights: Array | None = None) -> Witness | None:
    known = np.isfinite(scores)
    if not known.any():
        return None
    w = None if weights is None else weights[known]
    return Witness(float(np.average(scores[known], weights=w)), weight)
