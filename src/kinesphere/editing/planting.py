"""Feet held where they stand: legs reach for them, and the pelvis goes down where they cannot."""

from typing import NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter1d

from kinesphere.data import Array, Json, Mask, Skeleton
from kinesphere.data.figure import SIDES
from kinesphere.data.tree import below
from kinesphere.editing.foot_contacts import BALL
from kinesphere.editing.foot_pins import foot_shifts
from kinesphere.editing.pelvis import pelvis_drop
from kinesphere.editing.retarget_rest import RestPose
from kinesphere.editing.retarget_settings import RetargetSettings
from kinesphere.geometry.rotations import rotation_between
from kinesphere.geometry.two_bone import longest_reach, reach_for
from kinesphere.geometry.vectors import lengths

_TOES_SETTLE = 0.04
"""s, the Gaussian over which toes become level and cease to be."""


class Planted(NamedTuple):
    """A rig whose feet stand still."""

    turns: Array
    """(n_frames, n_limbs, 3, 3) ``world_from_limb``."""
    drop: Array
    """(n_frames,) m, how far the pelvis went down."""
    findings: dict[str, Json]


def plant_feet(
    turns: Array,
    places: Array,
    points: Array,
    contacts: Mask,
    levels: Array,
    rest: RestPose,
    skeleton: Skeleton,
    rate: float,
    settings: RetargetSettings,
) -> Planted:
    """Hold what stands on the ground where it stands.

    Feet keep their orientation; thigh and shank turn, the knee a hinge about the thigh's lateral
    axis. Toes lie level while the ball of the foot stands.

    Parameters
    ----------
    turns : (n_frames, n_limbs, 3, 3)
        ``world_from_limb`` of the rig.
    places : (n_frames, n_limbs, 3) m
        Where its limbs hang.
    points : (n_frames, 2, 2, 3) m
        Heels and balls of its feet.
    contacts : (n_frames, 2, 2)
        Which of them stand.
    levels : (n_frames, 2, 2) m
        How high they then should be.
    """
    parts = rest.figure.parts
    thighs, shanks, feet = (
        [parts[f"{side}_{part}"] for side in SIDES] for part in ("thigh", "shank", "foot")
    )
    shifts, slides = [], []
    for f in range(len(SIDES)):
        moved, pins = foot_shifts(points[:, f], contacts[:, f], levels[:, f], rate, settings.blend)
        shifts.append(moved)
        slides += [_slide(points[a:b, f, point]) for point, a, b, _ in pins]
    goals = places[:, feet] + np.stack(shifts, axis=1)
    hinges = (turns[:, thighs] @ rest.rest_from_body)[..., 2]
    chains = [
        (places[:, thighs[f]], places[:, shanks[f]], places[:, feet[f]], hinges[:, f])
        for f in range(len(SIDES))
    ]
    bones = [lengths(knee - hip) + lengths(end - knee) for hip, knee, end, _ in chains]
    most = [
        np.minimum(np.maximum(settings.reach * bone, lengths(end - hip)), longest_reach(*chain))
        for bone, chain in zip(bones, chains, strict=True)
        for hip, _, end, _ in [chain]
    ]
    drop = pelvis_drop(places[:, thighs], goals, np.stack(most, axis=1), rate)
    down = np.array([0.0, 1.0, 0.0]) * drop[:, None]
    turned, missed = np.array(turns), 0.0
    for f, (hip, knee, end, hinge) in enumerate(chains):
        reach = reach_for(hip - down, knee - down, end - down, hinge, goals[:, f])
        _turn(turned, skeleton, reach.upper, thighs[f], shanks[f])
        _turn(turned, skeleton, reach.lower, shanks[f], feet[f])
        missed = max(missed, float(reach.missed.max(initial=0.0)))
        _level_toes(turned, skeleton, rest, SIDES[f], contacts[:, f, BALL], rate)
    return Planted(
        turned,
        drop,
        {
            "contacts": len(slides),
            "slide_before_mm": float(np.mean(slides)) * 1e3 if slides else 0.0,
            "pelvis_lowered_mm": float(drop.max(initial=0.0)) * 1e3,
            "missed_mm": missed * 1e3,
        },
    )


def _slide(points: Array) -> float:
    """Return how far points stray along the floor from their middle while they stand, m."""
    off = (points - points.mean(axis=0)) * [1.0, 0.0, 1.0]
    return float(lengths(off).max())


def _turn(turns: Array, skeleton: Skeleton, turn: Array, limb: int, following: int) -> None:
    """Turn a limb and what hangs from it, but for the limb that follows and all it carries."""
    kept = set(below(skeleton.parents, following))
    for i in below(skeleton.parents, limb):
        if i not in kept:
            turns[:, i] = turn @ turns[:, i]


def _level_toes(
    turns: Array, skeleton: Skeleton, rest: RestPose, side: str, ball: Mask, rate: float
) -> None:
    """Turn toes up that would point into the ground while the ball of the foot stands."""
    if (toes := rest.figure.parts.get(f"{side}_toes")) is None:
        return
    limb = skeleton.limbs[toes]
    if not limb.length > 0:
        return
    way = turns[:, toes] @ limb.long_axis
    level = way * [1.0, 0.0, 1.0]
    size = lengths(level)
    at_rest = rest.rest_from_body[:, 1] @ limb.long_axis  # its slope when the foot stands flat
    dips = (way[:, 1] < at_rest) & (size > 0.1)
    weight = gaussian_filter1d(ball.astype(np.float64), _TOES_SETTLE * rate, mode="nearest")
    slope = np.where(dips, way[:, 1] + weight * (at_rest - way[:, 1]), way[:, 1])
    ahead = level / np.where(size > 0, size, 1.0)[:, None]
    aim = np.sqrt(np.maximum(1 - slope**2, 0.0))[:, None] * ahead
    aim[:, 1] = slope
    turn = np.where(dips[:, None, None], rotation_between(way, aim), np.eye(3))
    for i in below(skeleton.parents, toes):
        turns[:, i] = turn @ turns[:, i]
