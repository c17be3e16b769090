"""Two rest poses compared: what one limb's frame must turn by to point as the other's does."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array, Skeleton
from kinesphere.data.figure import SIDES, Figure, rest_from_body, rest_places
from kinesphere.data.tree import below
from kinesphere.geometry.rotations import rotation_about, rotation_between

_AXES = np.eye(3)
_NEXT = {"upper_arm": "forearm", "forearm": "hand", "thigh": "shank", "shank": "foot"}
_FLAT = np.deg2rad(60.0)
"""A foot that points up or down by more than this has no heading."""


@dataclass(frozen=True, eq=False)
class RestPose:
    """A skeleton's figure as it stands when every limb frame is parallel."""

    figure: Figure
    places: Array
    """(n_limbs, 3) m where each limb hangs, in the skeleton's own rest axes."""
    rest_from_body: Array
    """(3, 3): body axes (x front, y up, z right) in those, a quarter turn at most."""
    directions: Mapping[str, Array]
    """Part → (3,) unit vector to the next joint or to the limb's end, body axes."""
    leg: float
    """m from hip to ankle, along the bones, mean of both."""
    ankle: float
    """m from ankle down to the lowest of the foot; 0 where the foot tells nothing."""


def rest_pose(skeleton: Skeleton, figure: Figure) -> RestPose:
    """Return how a skeleton stands in its rest pose."""
    places = rest_places(skeleton)
    turn = rest_from_body(figure, places)
    in_body = places @ turn
    parts = figure.parts
    directions: dict[str, Array] = {}
    for side in SIDES:
        for part in ("upper_arm", "forearm", "hand", "thigh", "shank", "foot"):
            name = f"{side}_{part}"
            if name not in parts:
                continue
            following = f"{side}_{_NEXT.get(part, 'toes' if part == 'foot' else '')}"
            way = np.zeros(3)
            if following in parts:
                way = in_body[parts[following]] - in_body[parts[name]]
            limb = skeleton.limbs[parts[name]]
            if not np.linalg.norm(way) > 1e-9 and limb.length > 0:
                way = turn.T @ limb.long_axis
            if (size := float(np.linalg.norm(way))) > 1e-9:
                directions[name] = way / size
    legs, drops = [], []
    for side in SIDES:
        at = [parts[f"{side}_{p}"] for p in ("thigh", "shank", "foot") if f"{side}_{p}" in parts]
        legs.append(np.linalg.norm(np.diff(places[at], axis=0), axis=1).sum())
        if f"{side}_foot" in parts:
            foot = parts[f"{side}_foot"]
            lowest = min(
                float(point[1])
                for i in below(skeleton.parents, foot)
                for point in (in_body[i], in_body[i] + turn.T @ _end(skeleton, i))
            )
            drops.append(float(in_body[foot, 1]) - lowest)
    return RestPose(
        figure,
        places,
        turn,
        directions,
        float(np.mean(legs)),
        float(np.mean(drops)) if drops else 0.0,
    )


def _end(skeleton: Skeleton, limb: int) -> Array:
    """Return the way from where a limb hangs to its end, (3,) m; nothing where that is unknown."""
    one = skeleton.limbs[limb]
    return one.length * one.long_axis if one.length > 0 else np.zeros(3)


def corrections(source: RestPose, target: RestPose) -> dict[str, Array]:
    """Return part → (3, 3) the turn, in body axes, from the target's rest pose to the source's.

    Arms and legs by the least turn that lets their bones point alike, each starting from its
    parent's; feet by their headings, as both stand flat. The rest (pelvis, spine, neck, head)
    corresponds as it stands.
    """
    turns: dict[str, Array] = {}
    for side in SIDES:
        for chain in (("upper_arm", "forearm", "hand"), ("thigh", "shank")):
            turn = np.eye(3)
            for part in chain:
                name = f"{side}_{part}"
                a, b = target.directions.get(name), source.directions.get(name)
                if a is not None and b is not None:
                    turn = rotation_between(turn @ a, b) @ turn
                turns[name] = turn
        name = f"{side}_foot"
        a, b = target.directions.get(name), source.directions.get(name)
        turns[name] = np.eye(3)
        if a is not None and b is not None and _is_flat(a) and _is_flat(b):
            heading = np.arctan2(a[2], a[0]) - np.arctan2(b[2], b[0])
            turns[name] = rotation_about(_AXES[1], np.array(heading))
        turns[f"{side}_toes"] = turns[name]
    return turns


def _is_flat(direction: Array) -> bool:
    return bool(abs(direction[1]) < np.sin(_FLAT))
