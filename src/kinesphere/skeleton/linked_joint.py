"""A joint as limbs that were fitted together have it."""

from typing import NamedTuple

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.centre_covariance import Told
from kinesphere.geometry.centres import CentreFit, with_expectation
from kinesphere.geometry.rigid import into_frame
from kinesphere.geometry.rotations import mean_rotation
from kinesphere.geometry.vectors import is_seen
from kinesphere.skeleton.averages import median_seen
from kinesphere.skeleton.body import Body


class LinkedJoint(NamedTuple):
    """A joint that a group of limbs told together."""

    world: Array
    """(n_sample, 3) m; NaN where a limb of the group is unseen."""
    frames: Array
    """(n_sample, 3, 3) the parent's poses as the group has them; NaN alike."""
    told: Told
    """Of the centre in the parent as the group has it."""
    off: Array
    """(3,) m, there, from where it was expected to where it is."""
    noise: float
    """m."""
    n_poses: int

    def seen_from(self, parent: Body, spread: float) -> CentreFit | None:
        """Return the joint in its parent, however that was measured; None where it never shows."""
        local = into_frame(parent.rotations, parent.shifts, self.world[:, None])[:, 0]
        turns = np.swapaxes(parent.rotations, 1, 2) @ self.frames
        known = is_seen(local) & np.isfinite(turns).all(axis=(1, 2))
        if not known.any():
            return None
        turn = mean_rotation(turns[known])
        told = Told(*(turn @ one @ turn.T for one in self.told))
        centre = median_seen(local[known])
        return with_expectation(centre, told, spread, self.noise, self.n_poses, turn @ self.off)
