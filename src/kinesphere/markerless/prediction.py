"""Where a pose is expected: where the last steps lead, and near rest."""

import numpy as np

from kinesphere.data import Array
from kinesphere.markerless.chain import SLIDE, Chain
from kinesphere.markerless.pose import Pose, bind_pose, difference, moved
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.solver import Prior


def predicted(chain: Chain, before: Pose | None, last: Pose, share: float) -> Pose:
    """Return the pose that comes next if a share of the last step goes on."""
    if before is None:
        return last
    return moved(chain, last, share * difference(chain, before, last))


def expectation(chain: Chain, pose: Pose, settings: TrackSettings, widen: float = 1.0) -> Prior:
    """Return a prediction as a prior; ``widen`` multiplies how far a pose may be from it."""
    turn, shift = np.radians(settings.turn_spread), settings.shift_spread / 1000
    return Prior(pose, widen * np.where(chain.dof_kinds == SLIDE, shift, turn))


def rest(chain: Chain, settings: TrackSettings, root: Pose) -> Prior:
    """Return the prior of joints near their rest: weak, for what no camera shows."""
    spread: Array = settings.rest_spread * np.array(
        [chain.links[limb].stiffness for limb in chain.dof_limbs]
    )
    spread[chain.dof_limbs == 0] = np.inf
    bind = bind_pose(chain)
    balls = bind.balls.copy()
    balls[0] = root.balls[0]
    return Prior(Pose(root.position, balls, bind.angles), spread)
