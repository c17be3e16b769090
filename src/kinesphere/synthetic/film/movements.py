"""Movements whose joint angles are known: the two of Rosenhahn et al. 2006, a turn, a full body."""

from collections.abc import Callable

import numpy as np

from kinesphere.data import Array
from kinesphere.data.surface import Surface
from kinesphere.geometry.rotations import rotation_about
from kinesphere.synthetic.film.arms import aimed_arm, arm_of, flat_hand, reaching_arm
from kinesphere.synthetic.film.body_motion import BodyMotion

X, Y, Z = np.eye(3)
_SIDES = (("left", -1.0), ("right", 1.0))


def arms_swinging(surface: Surface, n_frames: int, rate: float) -> BodyMotion:
    """Arms swing ahead, back and sideways while the elbows bend, each in its own time."""
    t = np.arange(n_frames) / rate
    turns = _standing(surface, t)
    for side, sign in _SIDES:
        phase = 0.0 if side == "left" else 1.9
        swing = np.radians(15 + 45 * np.sin(2 * np.pi * 0.45 * t + phase))
        aside = np.radians(28 + 18 * np.sin(2 * np.pi * 0.23 * t + 0.7 + phase))
        flexion = np.radians(55 - 38 * np.cos(2 * np.pi * 0.37 * t + 0.4 * phase))
        twist = np.radians(12 * np.sin(2 * np.pi * 0.31 * t + phase)) * sign
        _swing(surface, turns, side, sign, (swing, aside, flexion, twist))
    return BodyMotion(surface, turns, _on_the_floor(surface, turns), rate)


def push_ups(surface: Surface, n_frames: int, rate: float) -> BodyMotion:
    """Push-ups on hands and toes: the trunk is a plank, the elbows bend outward and back."""
    t = np.arange(n_frames) / rate
    down = 0.5 - 0.5 * np.cos(2 * np.pi * 0.4 * t)  # 0 up, 1 down
    at = {name: i for i, name in enumerate(surface.limbs)}
    start = surface.joint_centres
    shoulders = start[at["left_upper_arm"]], start[at["right_upper_arm"]]
    ankles = start[at["left_foot"]], start[at["right_foot"]]
    along = (sum(shoulders) - sum(ankles))[1] / 2
    reach = sum(arm_of(surface, "left").lengths)
    toes = 0.5 * sum(
        surface.ends[at[f"{s}_foot"]][0] - start[at[f"{s}_foot"]][0] for s, _ in _SIDES
    )
    wrist = 0.045
    high = np.arcsin((wrist + 0.92 * reach - toes) / along)
    low = np.arcsin(max(-0.02, (wrist + 0.56 * reach - toes) / along))
    pitch = high + (low - high) * down
    whole = rotation_about(Z, pitch - np.pi / 2)
    turns = np.repeat(whole[:, None], len(surface.limbs), axis=1)
    turns[:, at["head"]] = whole @ rotation_about(Z, np.full(n_frames, np.radians(25)))
    upright = rotation_about(Z, np.full(n_frames, -np.pi / 2 + 0.06))
    for side, _ in _SIDES:
        turns[:, at[f"{side}_foot"]] = upright
    middle = np.broadcast_to(0.5 * sum(ankles) - start[0], (n_frames, 3))
    root = np.array([-0.75, toes + 0.02, 0.0]) - (whole @ middle[..., None])[..., 0]
    motion = BodyMotion(surface, turns, root, rate)
    hands_at = motion.joint_centres[0, [at["left_upper_arm"], at["right_upper_arm"]]]
    for (side, sign), shoulder in zip(_SIDES, hands_at, strict=True):
        arm = arm_of(surface, side)
        place = np.array([shoulder[0] + 0.02, wrist, shoulder[2] + 0.06 * sign])
        there = motion.joint_centres[:, at[f"{side}_upper_arm"]]
        pole = np.broadcast_to(np.array([-0.7, 0.1, 0.7 * sign]), there.shape)
        upper, fore = reaching_arm(arm, there, np.broadcast_to(place, there.shape), pole)
        turns[:, at[f"{side}_upper_arm"]], turns[:, at[f"{side}_forearm"]] = upper, fore
        turns[:, at[f"{side}_hand"]] = flat_hand(arm, X, -Y)
    return BodyMotion(surface, turns, root, rate)


def turning(surface: Surface, n_frames: int, rate: float) -> BodyMotion:
    """Turn once around on the spot with the arms held out and moving (figure 3 of the paper)."""
    t = np.arange(n_frames) / rate
    turns = _standing(surface, t)
    for side, sign in _SIDES:
        phase = 0.0 if side == "left" else 2.4
        swing = np.radians(20 + 20 * np.sin(2 * np.pi * 0.3 * t + phase))
        aside = np.radians(55 + 15 * np.sin(2 * np.pi * 0.21 * t + phase))
        flexion = np.radians(45 - 25 * np.cos(2 * np.pi * 0.33 * t + phase))
        _swing(surface, turns, side, sign, (swing, aside, flexion, np.zeros(n_frames)))
    around = rotation_about(Y, 2 * np.pi * np.arange(n_frames) / max(1, n_frames - 1))
    turns = around[:, None] @ turns
    return BodyMotion(surface, turns, _on_the_floor(surface, turns), rate)


def whole_body(surface: Surface, n_frames: int, rate: float) -> BodyMotion:
    """Knee bends, a bending and turning trunk, arms and head: every joint of the full model."""
    t = np.arange(n_frames) / rate
    at = {name: i for i, name in enumerate(surface.limbs)}
    turns = _standing(surface, t)
    start = 0.5 - 0.5 * np.cos(np.pi * np.minimum(t / 0.7, 1))  # from standing still
    for side, sign in _SIDES:
        phase = 0.0 if side == "left" else 1.6
        knee = start * np.radians(45 + 40 * np.sin(2 * np.pi * 0.4 * t - 1.4 + 0.25 * phase))
        hip, apart = 0.55 * knee, np.radians(6) * sign
        leg = rotation_about(X, np.full(len(t), -apart))
        turns[:, at[f"{side}_thigh"]] = turns[:, 0] @ leg @ rotation_about(Z, hip)
        turns[:, at[f"{side}_shank"]] = turns[:, 0] @ leg @ rotation_about(Z, hip - knee)
        swing = np.radians(40 + 45 * start * np.sin(2 * np.pi * 0.4 * t + phase))
        aside = np.radians(30 + 25 * start * np.sin(2 * np.pi * 0.27 * t + phase))
        flexion = np.radians(50 - 35 * np.cos(2 * np.pi * 0.35 * t + phase))
        _swing(surface, turns, side, sign, (swing, aside, flexion, np.zeros(len(t))))
    return BodyMotion(surface, turns, _on_the_floor(surface, turns), rate)


MOVEMENTS: dict[str, Callable[[Surface, int, float], BodyMotion]] = {
    "arms": arms_swinging,
    "push-ups": push_ups,
    "turn": turning,
    "body": whole_body,
}
"""By name."""


def _standing(surface: Surface, t: Array) -> Array:
    """Return turns of a body that stands and sways a little, (n, n_limbs, 3, 3)."""
    at = {name: i for i, name in enumerate(surface.limbs)}
    turns = np.tile(np.eye(3), (len(t), len(surface.limbs), 1, 1))
    lean = rotation_about(Z, np.radians(-4 - 4 * np.sin(2 * np.pi * 0.19 * t)))
    upper = [name for name in surface.limbs if "arm" in name or "hand" in name or "clav" in name]
    for name in ("trunk", "head", *upper):
        turns[:, at[name]] = lean
    turns[:, at["head"]] = lean @ rotation_about(Y, np.radians(8 * np.sin(2 * np.pi * 0.13 * t)))
    return turns


def _swing(
    surface: Surface, turns: Array, side: str, sign: float, how: tuple[Array, Array, Array, Array]
) -> None:
    """Put an arm by its swing ahead, its spread aside, its elbow's flexion and its twist, rad."""
    swing, aside, flexion, twist = how
    at = {name: i for i, name in enumerate(surface.limbs)}
    down = np.stack(
        [np.sin(swing) * np.cos(aside), -np.cos(swing) * np.cos(aside), sign * np.sin(aside)],
        axis=-1,
    )
    arm = arm_of(surface, side)
    upper, fore = aimed_arm(arm, turns[:, at["trunk"]], down, flexion, twist)
    turns[:, at[f"{side}_upper_arm"]], turns[:, at[f"{side}_forearm"]] = upper, fore
    turns[:, at[f"{side}_hand"]] = fore


def _on_the_floor(surface: Surface, turns: Array) -> Array:
    """Return where the pelvis is so that the lower ankle stays at its height, (n, 3) m."""
    at = {name: i for i, name in enumerate(surface.limbs)}
    loose = BodyMotion(surface, turns, np.zeros((len(turns), 3)), 1.0)
    ankles = loose.joint_centres[:, [at["left_foot"], at["right_foot"]]]
    root = np.zeros((len(turns), 3))
    root[:, 1] = surface.joint_centres[at["left_foot"], 1] - ankles[..., 1].min(axis=1)
    root[:, [0, 2]] = -ankles.mean(axis=1)[:, [0, 2]]
    return root
