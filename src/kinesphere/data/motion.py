"""How the skeleton moved: one pose per limb and frame. Here markers and cameras meet."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from kinesphere.data.arrays import Array, Codes, Mask, frozen, frozen_codes
from kinesphere.data.history import History
from kinesphere.data.skeleton import Skeleton
from kinesphere.geometry.poses import relative_rotations
from kinesphere.kernels.centres import joint_centres_kernel


class PoseFlag(IntEnum):
    """How a limb's pose in a frame came about."""

    UNSEEN = 0
    """No pose; NaN."""
    MEASURED = 1
    """From its own markers."""
    JOINT_AIDED = 2
    """A joint centre stood in for a marker."""
    TWIST_BORROWED = 3
    """Long axis from its own points, twist from the flexed next limb."""
    TWIST_UNKNOWN = 4
    """Long axis from its own points; nothing tells the twist, so it is the least from rest."""
    FILLED = 5
    """Interpolated or rebuilt from the skeleton."""


@dataclass(frozen=True, eq=False)
class Motion:
    """Poses of every limb over time, in the world: y up, right-handed, metres."""

    skeleton: Skeleton
    rotations: Array
    """(n_frames, n_limbs, 3, 3) ``world_from_limb``; NaN where unseen."""
    origins: Array
    """(n_frames, n_limbs, 3) m, origin of each limb frame in the world; NaN where unseen."""
    residuals: Array
    """(n_frames, n_limbs) m, rms distance of the limb's markers to where its pose puts them."""
    flags: Codes
    """(n_frames, n_limbs) PoseFlag."""
    rate: float
    """Hz."""
    first_frame: int = 1
    history: History = ()

    def __post_init__(self) -> None:
        put = object.__setattr__
        n_limbs = len(self.skeleton.limbs)
        put(self, "rotations", frozen(self.rotations, None, n_limbs, 3, 3, name="rotations"))
        n_frames = len(self.rotations)
        put(self, "origins", frozen(self.origins, n_frames, n_limbs, 3, name="origins"))
        put(self, "residuals", frozen(self.residuals, n_frames, n_limbs, name="residuals"))
        put(self, "flags", frozen_codes(self.flags, n_frames, n_limbs, name="flags"))

    @property
    def n_frames(self) -> int:
        """Number of frames."""
        return len(self.rotations)

    @property
    def times(self) -> Array:
        """(n_frames,) s since the first stored frame."""
        return np.arange(self.n_frames) / self.rate

    @property
    def seen(self) -> Mask:
        """(n_frames, n_limbs) True where a limb has a pose."""
        return np.asarray(self.flags != PoseFlag.UNSEEN)

    def relative_rotations(self) -> Array:
        """Return ``parent_from_child`` of every joint, (n_frames, n_joints, 3, 3)."""
        parents = self.rotations[:, self.skeleton.parents[1:]]
        return relative_rotations(parents, self.rotations[:, 1:])

    def joint_centres(self, frames: NDArray[np.intp] | None = None) -> Array:
        """Return every joint centre in the world, (n_frames, n_joints, 3) m.

        Carried by the parent; by the child where the parent is unseen.

        Parameters
        ----------
        frames : (n,)
            Which; all by default.
        """
        joints = self.skeleton.joints
        in_parent = np.array([joint.centre_in_parent for joint in joints]).reshape(-1, 3)
        in_child = np.array([joint.centre_in_child for joint in joints]).reshape(-1, 3)
        frames = np.arange(self.n_frames) if frames is None else frames
        centres = np.empty((len(frames), len(joints), 3))
        parents = self.skeleton.parents[1:]
        joint_centres_kernel(
            self.rotations, self.origins, frames, parents, in_parent, in_child, centres
        )
        return centres

    def marker_positions(self) -> dict[str, Array]:
        """Return where the poses put every marker, label → (n_frames, 3) m."""
        placed: dict[str, Array] = {}
        for i, limb in enumerate(self.skeleton.limbs):
            points = _carried(
                self.rotations[:, i, None], self.origins[:, i, None], limb.marker_positions
            )
            placed |= {label: points[:, m] for m, label in enumerate(limb.markers)}
        return placed


def _carried(rotations: Array, origins: Array, points: Array) -> Array:
    moved: Array = (rotations @ points[..., None])[..., 0] + origins
    return moved
