"""The motion as a minimal set of angles about the axes the person moves around."""

from dataclasses import dataclass
from enum import IntFlag

import numpy as np

from kinesphere.data.arrays import Array, Codes, Mask, frozen, frozen_codes, frozen_mask
from kinesphere.data.history import History
from kinesphere.data.skeleton import Skeleton


class JointFlag(IntFlag):
    """What a person should know about a joint's parameters in a frame; 0 is all well."""

    UNSEEN = 1
    """Parent or child has no pose; the parameters are NaN."""
    UNREACHABLE = 2
    """The limb lies where the axes cannot take it; the angles are the nearest (paper 4.4)."""
    SINGULAR = 4
    """The limb lies close to the plane of the two axes: the angles are ill-conditioned."""
    TWIST_UNKNOWN = 8
    """Nothing tells the twist; it is NaN and counts as zero when the pose is rebuilt."""
    FILLED = 16
    """From a pose that was interpolated or rebuilt, not measured."""
    DISLOCATED = 32
    """Parent and child disagree about the joint centre far more than they usually do."""


@dataclass(frozen=True, eq=False)
class Parameters:
    """Root pose, and per joint the angles about its axes and the twist about its limb.

    The skeleton's joints carry the axes and rest orientations, so the two rebuild every pose.
    """

    skeleton: Skeleton
    root_positions: Array
    """(n_frames, 3) m, origin of the root limb's frame in the world."""
    root_rotations: Array
    """(n_frames, 3, 3) ``world_from_root``."""
    angles: Array
    """(n_frames, n_joints, 3) rad about axis 1, 2, 3; NaN for an axis a joint does not have."""
    twists: Array
    """(n_frames, n_joints) rad about the limb's long axis."""
    residuals: Array
    """(n_frames, n_joints) m between the limb's mid point measured and rebuilt from its parent."""
    flags: Codes
    """(n_frames, n_joints) JointFlag."""
    moving: Mask
    """(n_frames, n_joints) True where the filter saw the limb move (paper 4.1)."""
    rate: float
    """Hz."""
    first_frame: int = 1
    history: History = ()

    def __post_init__(self) -> None:
        put = object.__setattr__
        n_joints = len(self.skeleton.joints)
        put(self, "angles", frozen(self.angles, None, n_joints, 3, name="angles"))
        n = len(self.angles)
        put(self, "root_positions", frozen(self.root_positions, n, 3, name="root positions"))
        put(self, "root_rotations", frozen(self.root_rotations, n, 3, 3, name="root rotations"))
        put(self, "twists", frozen(self.twists, n, n_joints, name="twists"))
        put(self, "residuals", frozen(self.residuals, n, n_joints, name="residuals"))
        put(self, "flags", frozen_codes(self.flags, n, n_joints, name="flags"))
        put(self, "moving", frozen_mask(self.moving, n, n_joints, name="moving"))

    @property
    def n_frames(self) -> int:
        """Number of frames."""
        return len(self.angles)

    @property
    def times(self) -> Array:
        """(n_frames,) s since the first stored frame."""
        return np.arange(self.n_frames) / self.rate
