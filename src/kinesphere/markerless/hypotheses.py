"""Poses worth trying: arms and legs in the places they are usually found in."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.rotations import rotation_about, rotation_between
from kinesphere.markerless.anatomy import AHEAD, RIGHT, UP
from kinesphere.markerless.chain import Chain
from kinesphere.markerless.pose import Pose, bind_pose, limited

_ARMS = (
    (0.1, -1.0, 0.25),
    (0.6, -0.8, 0.2),
    (-0.5, -0.85, 0.2),
    (1.0, -0.1, 0.1),
    (0.0, -0.5, 0.85),
    (0.0, 0.0, 1.0),
    (0.7, 0.0, 0.7),
    (0.6, -0.4, -0.4),
    (0.6, 0.8, 0.2),
    (0.0, 0.75, 0.65),
    (0.1, 1.0, 0.1),
)
"""Where an upper arm points: ahead, up, outward."""
_ELBOWS = ((15.0, (0.0,)), (85.0, (-60.0, 0.0, 60.0)))
"""Flexions in degrees, and the twists of the upper arm tried with each."""
_TWISTS = (-80.0, -40.0, 0.0, 40.0, 80.0)
_REACH = ((12.0, (0.0,)), (55.0, _TWISTS), (105.0, _TWISTS))
"""The same where the whole reach of an arm is tried."""
_LEGS = ((0.0, 0.0), (25.0, 10.0), (-20.0, 15.0), (50.0, 60.0), (85.0, 90.0))
"""Flexions of hip and knee in degrees."""


def arm_poses(chain: Chain, pose: Pose, side: str) -> Iterator[Pose]:
    """Yield the pose with one arm elsewhere, by where it usually is."""
    names = chain.limb_names
    limb = names.index(f"{side}_upper_arm")
    link = chain.links[limb]
    out = RIGHT if side == "right" else -RIGHT
    elbow, elbow_at = hinge(chain, f"{side}_forearm")
    for ahead, up, outward in _ARMS:
        towards = ahead * AHEAD + up * UP + outward * out
        least = rotation_between(link.long_axis, towards / np.linalg.norm(towards))
        for flexion, twists in _ELBOWS:
            for twist in twists:
                about = rotation_about(link.long_axis, np.asarray(np.radians(twist)))
                balls, angles = pose.balls.copy(), pose.angles.copy()
                balls[limb] = least @ about
                angles[elbow] = np.radians(flexion) - elbow_at
                yield limited(chain, replace(pose, balls=balls, angles=angles))


def arm_places(chain: Chain, pose: Pose, side: str, directions: int = 180) -> Iterator[Pose]:
    """Yield the pose with one arm in all the places it can reach, about evenly spread.

    Parameters
    ----------
    directions
        Over the whole sphere; those an upper arm can point in are tried straight, one in three bent
        as well: a straight arm reaches far, and must be met more exactly.
    """
    names = chain.limb_names
    limb = names.index(f"{side}_upper_arm")
    link = chain.links[limb]
    elbow, elbow_at = hinge(chain, f"{side}_forearm")
    bare = pose.angles.copy()
    bare[np.isin(chain.dof_limbs, [names.index(f"{side}_{b}") for b in ("forearm", "hand")])] = 0.0
    for i, towards in enumerate(_sphere(directions)):
        if towards @ link.towards < np.cos(link.swing):
            continue
        least = rotation_between(link.long_axis, towards)
        for flexion, twists in _REACH if i % 3 == 0 else _REACH[:1]:
            for twist in twists:
                balls, angles = pose.balls.copy(), bare.copy()
                balls[limb] = least @ rotation_about(link.long_axis, np.asarray(np.radians(twist)))
                angles[elbow] = np.radians(flexion) - elbow_at
                yield replace(pose, balls=balls, angles=angles)


def _sphere(n: int) -> Array:
    """Return unit vectors spread evenly (a Fibonacci spiral), (n, 3)."""
    i = np.arange(n) + 0.5
    turn = np.pi * (1 + np.sqrt(5)) * i
    z = 1 - 2 * i / n
    across = np.sqrt(1 - z**2)
    return np.stack([across * np.cos(turn), across * np.sin(turn), z], axis=1)


def leg_poses(chain: Chain, pose: Pose, side: str) -> Iterator[Pose]:
    """Yield the pose with one leg elsewhere."""
    limb = chain.limb_names.index(f"{side}_thigh")
    knee, knee_at = hinge(chain, f"{side}_shank")
    for hip, bend in _LEGS:
        balls, angles = pose.balls.copy(), pose.angles.copy()
        balls[limb] = rotation_about(RIGHT, np.asarray(np.radians(hip)))
        angles[knee] = np.radians(bend) - knee_at
        yield limited(chain, replace(pose, balls=balls, angles=angles))


def standing(chain: Chain, arms: str = "standing") -> Pose:
    """Return a person upright, facing x; arms as ``standing``, ``a-pose`` or ``t-pose``."""
    pose = bind_pose(chain)
    which = {"standing": 0, "a-pose": 4, "t-pose": 5}[arms]
    per_direction = sum(len(twists) for _, twists in _ELBOWS)
    for side in ("left", "right"):
        pose = list(arm_poses(chain, pose, side))[which * per_direction]
        if f"{side}_shank" in chain.limb_names:
            pose = next(leg_poses(chain, pose, side))
    return pose


def facing(pose: Pose, position: Array, heading: Array, up: Array = UP) -> Pose:
    """Return the pose moved to a place and turned to look in a direction (both in the world)."""
    ahead = heading - (heading @ up) * up
    ahead = ahead / np.linalg.norm(ahead)
    turn = np.stack([ahead, up, np.cross(ahead, up)], axis=1)
    balls = pose.balls.copy()
    balls[0] = turn @ balls[0]
    return replace(pose, position=np.asarray(position, dtype=np.float64), balls=balls)


def turned_about(chain: Chain, pose: Pose) -> Pose:
    """Return the pose of someone who looks the other way, each limb about where its other one was.

    Silhouettes hardly tell the two apart. Knees and elbows keep the way they bend.
    """
    names = chain.limb_names
    other = {"left": "right", "right": "left"}
    flip = np.diag([-1.0, 1.0, -1.0])  # half a turn about the body's own length
    balls, angles = pose.balls.copy(), pose.angles.copy()
    balls[0] = pose.balls[0] @ flip
    for limb, name in enumerate(names):
        side, _, rest = name.partition("_")
        twin = names.index(f"{other[side]}_{rest}") if side in other else limb
        if limb:
            balls[limb] = flip @ pose.balls[twin] @ flip
        angles[chain.dof_limbs == limb] = pose.angles[chain.dof_limbs == twin]
    return limited(chain, replace(pose, balls=balls, angles=angles))


def hinge(chain: Chain, limb: str) -> tuple[int, float]:
    """Return the first degree of freedom of a hinge, and its flexion in the bind pose in rad."""
    i = chain.limb_names.index(limb)
    link, parent = chain.links[i], chain.links[chain.parents[i]]
    before = link.centre - parent.centre
    cosine = before @ link.long_axis / np.linalg.norm(before)
    return int(np.flatnonzero(chain.dof_limbs == i)[0]), float(np.arccos(np.clip(cosine, -1, 1)))
