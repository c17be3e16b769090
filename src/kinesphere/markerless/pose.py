"""A pose of a chain: balls as matrices, hinges as angles; steps, differences, limits."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.rotations import rotation_about, rotation_between, rotation_log
from kinesphere.geometry.twists import twist_exp
from kinesphere.markerless.chain import BALL, HINGE, SLIDE, Chain
from kinesphere.markerless.kernels.posing import pose_kernel


@dataclass(frozen=True, eq=False)
class Pose:
    """Where the root is and how every joint is turned."""

    position: Array
    """(3,) m, the root's centre in the world."""
    balls: Array
    """(n_limbs, 3, 3) ``parent_from_limb`` of the root and of balls; identity elsewhere."""
    angles: Array
    """(n_dofs,) rad of hinges from the bind pose; zero elsewhere."""


@dataclass(frozen=True, eq=False)
class Posed:
    """A pose worked out: limbs and joint axes in the world."""

    rotations: Array
    """(n_limbs, 3, 3) ``world_from_limb``."""
    centres: Array
    """(n_limbs, 3) m, joint centres."""
    axes: Array
    """(n_dofs, 3) unit vectors in the world: about which, for a slide along which."""


def bind_pose(chain: Chain) -> Pose:
    """Return the pose in which the surface was made."""
    n = len(chain.links)
    return Pose(chain.centres[0].copy(), np.tile(np.eye(3), (n, 1, 1)), np.zeros(chain.n_dofs))


def posed(chain: Chain, pose: Pose) -> Posed:
    """Work out where a pose puts limbs and axes."""
    n = len(chain.links)
    out = Posed(np.empty((n, 3, 3)), np.empty((n, 3)), np.empty((chain.n_dofs, 3)))
    pose_kernel(
        chain.parents,
        chain.centres,
        chain.dof_limbs,
        chain.dof_kinds,
        chain.dof_axes,
        pose.position,
        pose.balls,
        pose.angles,
        out.rotations,
        out.centres,
        out.axes,
    )
    return out


def moved(chain: Chain, pose: Pose, step: Array) -> Pose:
    """Return the pose one step on.

    Parameters
    ----------
    step : (n_dofs,)
        m along the world's axes for the root; rad about the parent's axes for balls (a rotation
        vector, put before the turn there is), about their own for hinges.
    """
    balls = pose.balls.copy()
    kinds, limbs = chain.dof_kinds, chain.dof_limbs
    turns = step[kinds == BALL].reshape(-1, 3)
    turned = limbs[kinds == BALL][::3]
    balls[turned] = twist_exp(np.pad(turns, ((0, 0), (3, 0))))[:, :3, :3] @ balls[turned]
    return Pose(
        pose.position + step[kinds == SLIDE],
        balls,
        pose.angles + np.where(kinds == HINGE, step, 0.0),
    )


def difference(chain: Chain, start: Pose, end: Pose) -> Array:
    """Return the step from one pose to another, (n_dofs,): ``moved(start, step)`` is ``end``."""
    kinds, limbs = chain.dof_kinds, chain.dof_limbs
    step = end.angles - start.angles
    step[kinds == SLIDE] = end.position - start.position
    turned = limbs[kinds == BALL][::3]
    relative = end.balls[turned] @ np.swapaxes(start.balls[turned], 1, 2)
    step[kinds == BALL] = rotation_log(relative).ravel()
    return step


def limited(chain: Chain, pose: Pose, limbs: Sequence[int] | None = None) -> Pose:
    """Return the nearest pose within the joints' limits; balls only of some limbs, if named."""
    balls = pose.balls.copy()
    for i in range(len(chain.links)) if limbs is None else limbs:
        link = chain.links[i]
        if link.kind == "ball" and (link.swing < np.pi or link.twist < np.pi):
            balls[i] = _limited_ball(balls[i], link.long_axis, link.towards, link.swing, link.twist)
    return replace(pose, balls=balls, angles=np.clip(pose.angles, *chain.limits))


def _limited_ball(
    turn: Array, long_axis: Array, towards: Array, swing: float, twist: float
) -> Array:
    pointing = turn @ long_axis
    angle = np.arccos(np.clip(pointing @ towards, -1.0, 1.0))
    if angle > swing:
        axis = np.cross(towards, pointing)
        size = np.linalg.norm(axis)
        if size > 0:
            turn = rotation_about(axis / size, np.asarray(swing - angle)) @ turn
            pointing = turn @ long_axis
    least = rotation_between(long_axis, pointing)
    about = float(rotation_log(least.T @ turn) @ long_axis)
    if abs(about) <= twist:
        return turn
    kept = rotation_about(long_axis, np.asarray(np.clip(about, -twist, twist)))
    return np.asarray(least @ kept)
