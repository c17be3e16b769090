"""A pose of a chain: balls as matrices, hinges as angles; steps, differences, limits."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import Array
from kinesphere.markerless.chain import Chain
from kinesphere.markerless.kernels.posing import pose_kernel
from kinesphere.markerless.kernels.turns import limit_kernel, turn_kernel, turns_between_kernel


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
    turn_kernel(balls, chain.turned, np.ascontiguousarray(step[chain.turns]).reshape(-1, 3))
    return Pose(
        pose.position + step[chain.slides],
        balls,
        pose.angles + np.where(chain.hinges, step, 0.0),
    )


def difference(chain: Chain, start: Pose, end: Pose) -> Array:
    """Return the step from one pose to another, (n_dofs,): ``moved(start, step)`` is ``end``."""
    step = end.angles - start.angles
    step[chain.slides] = end.position - start.position
    turns = np.empty((len(chain.turned), 3))
    turns_between_kernel(start.balls, end.balls, chain.turned, turns)
    step[chain.turns] = turns.ravel()
    return step


def limited(chain: Chain, pose: Pose, limbs: Sequence[int] | None = None) -> Pose:
    """Return the nearest pose within the joints' limits; balls only of some limbs, if named."""
    balls = pose.balls.copy()
    bound = chain.limited
    if limbs is not None:
        bound = np.array([i for i in limbs if i in bound], dtype=np.intp)
    limit_kernel(balls, bound, *chain.cones)
    low, high = chain.limits
    return replace(pose, balls=balls, angles=np.minimum(np.maximum(pose.angles, low), high))
