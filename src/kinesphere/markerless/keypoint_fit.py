"""A body's pose by where some of its points are: inverse kinematics."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from kinesphere.data import Array
from kinesphere.data.keypoints import KEYPOINTS
from kinesphere.geometry.rotations import rotation_about, rotation_between
from kinesphere.markerless.anatomy import RIGHT
from kinesphere.markerless.body import Body
from kinesphere.markerless.chain import SLIDE
from kinesphere.markerless.hypotheses import hinge, standing
from kinesphere.markerless.keypoint_marks import Marks
from kinesphere.markerless.pose import Pose, limited, posed
from kinesphere.markerless.prediction import rest
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.solver import Normals, solve_step

_FAR = 3.0
"""Spreads from which on a keypoint's say falls off."""
_STEPS = 40
_PITCHES = np.radians([0.0, 35.0, -35.0])
"""By which the pelvis is tilted to begin with."""
_TWISTS = np.radians(np.linspace(-100, 100, 11))


def seeded(body: Body, marks: Marks, points: Mapping[str, Array], pitch: float = 0.0) -> Pose:
    """Return a rough pose: the trunk by hips and shoulders, arms and legs by their directions.

    Parameters
    ----------
    points
        (3,) m of the keypoints that are known: of hips and shoulders one pair and one more.
    pitch
        rad by which the pelvis is tilted against the trunk, which hips and shoulders do not tell.
    """
    chain = body.chain
    own = dict(zip(KEYPOINTS, marks.places, strict=True))
    known = [n for n in points if n.endswith(("hip", "shoulder"))]
    turn = _trunk_axes(points) @ _trunk_axes({n: own[n] for n in known}).T
    tilt = rotation_about(RIGHT, np.asarray(pitch))
    pose = standing(chain)
    balls = pose.balls.copy()
    balls[0] = turn @ tilt
    balls[chain.limb_names.index("trunk")] = tilt.T
    there, here = (np.mean([of[n] for n in known], axis=0) for of in (points, own))
    pose = replace(pose, balls=balls, position=there + turn @ (chain.centres[0] - here))
    for side in ("left", "right"):
        pose = _limb(
            body,
            marks,
            pose,
            points,
            side,
            ("upper_arm", "forearm"),
            ("shoulder", "elbow", "wrist"),
        )
        pose = _limb(body, marks, pose, points, side, ("thigh", "shank"), ("hip", "knee", "ankle"))
    return pose


def _trunk_axes(points: Mapping[str, Array]) -> Array:
    """Return ahead, up and right of a trunk as columns."""
    middles, right = {}, np.zeros(3)
    for what in ("hip", "shoulder"):
        pair = [points[n] for n in (f"left_{what}", f"right_{what}") if n in points]
        middles[what] = np.mean(pair, axis=0)
        if len(pair) == 2:
            right = right + pair[1] - pair[0]
    up = middles["shoulder"] - middles["hip"]
    up = up / max(float(np.linalg.norm(up)), 1e-9)
    right = right - (right @ up) * up
    right = right / max(float(np.linalg.norm(right)), 1e-9)
    return np.stack([np.cross(up, right), up, right], axis=1)


def _limb(
    body: Body,
    marks: Marks,
    pose: Pose,
    points: Mapping[str, Array],
    side: str,
    limbs: tuple[str, str],
    joints: tuple[str, str, str],
) -> Pose:
    """Return the pose with an arm or leg along its keypoints, by the twist that fits best."""
    top, middle, end = (f"{side}_{joint}" for joint in joints)
    if middle not in points:
        return pose
    chain = body.chain
    upper = chain.limb_names.index(f"{side}_{limbs[0]}")
    dof, bent = hinge(chain, f"{side}_{limbs[1]}")
    now = posed(chain, pose)
    begin = points.get(top, now.centres[upper])
    along = points[middle] - begin
    along = along / max(float(np.linalg.norm(along)), 1e-9)
    flexion = bent
    if end in points:
        below = points[end] - points[middle]
        flexion = float(np.arctan2(np.linalg.norm(np.cross(along, below)), along @ below))
    link = chain.links[upper]
    least = rotation_between(link.long_axis, now.rotations[chain.parents[upper]].T @ along)
    at = [KEYPOINTS.index(n) for n in (middle, end) if n in points]
    wanted = np.array([points[KEYPOINTS[k]] for k in at])
    best, cost = pose, np.inf
    for twist in _TWISTS:
        balls, angles = pose.balls.copy(), pose.angles.copy()
        balls[upper] = least @ rotation_about(link.long_axis, np.asarray(twist))
        angles[dof] = flexion - bent
        tried = limited(chain, replace(pose, balls=balls, angles=angles))
        off = float(((marks.at(body, tried)[at] - wanted) ** 2).sum()) + 1e-5 * float(twist**2)
        if off < cost:
            best, cost = tried, off
    return best


def fitted(body: Body, marks: Marks, points: Array, settings: TrackSettings) -> tuple[Pose, Array]:
    """Return the pose that brings a body's keypoints to ``points``, and how far off each is.

    Gauss–Newton within the joints' limits, held weakly to rest, keypoints far off weighing little;
    from a rough pose with the pelvis tilted either way or not, and the best taken.

    Parameters
    ----------
    points : (n_keypoints, 3)
        m; NaN where not known; of hips and shoulders one pair and one more are needed.

    Returns
    -------
    Pose
    off : (n_keypoints,)
        m; NaN where not known.
    """
    at = {n: p for n, p in zip(KEYPOINTS, points, strict=True) if np.isfinite(p).all()}
    starts = [seeded(body, marks, at, float(pitch)) for pitch in _PITCHES]
    found = [_descended(body, marks, points, start, settings) for start in starts]
    pose, off, _ = min(found, key=lambda one: one[2])
    return pose, off


def _descended(
    body: Body, marks: Marks, points: Array, pose: Pose, settings: TrackSettings
) -> tuple[Pose, Array, float]:
    """Return the pose after Gauss–Newton, how far off each keypoint is, and the cost."""
    chain = body.chain
    known = np.flatnonzero(np.isfinite(points).all(axis=1))
    on = marks.limbs[known]
    moves = chain.moves[:, on].T  # (n_known, n_dofs)
    slides = chain.dof_kinds == SLIDE
    for _ in range(_STEPS):
        now = posed(chain, pose)
        here = marks.at(body, pose)[known]
        arms = here[:, None] - now.centres[chain.dof_limbs]
        slopes = np.where(slides[:, None], now.axes, np.cross(now.axes, arms))
        slopes = np.where(moves[..., None], slopes, 0.0)  # (n_known, n_dofs, 3)
        residuals = points[known] - here
        share = np.linalg.norm(residuals, axis=1) / marks.spread[known]
        weights = 1 / marks.spread[known] ** 2 / (1 + (share / _FAR) ** 2)
        equations = Normals.empty(chain.n_dofs)
        equations.add(
            np.swapaxes(slopes, 1, 2).reshape(-1, chain.n_dofs),
            residuals.ravel(),
            np.repeat(weights, 3),
        )
        pose, step = solve_step(chain, pose, equations, (rest(chain, settings, pose),), 1e-3)
        if step < 1e-5:
            break
    off = np.linalg.norm(marks.at(body, pose) - points, axis=1)
    return pose, off, float(np.log1p((off[known] / marks.spread[known] / _FAR) ** 2).sum())
