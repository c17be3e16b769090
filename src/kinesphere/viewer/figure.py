"""Where everything of a skeleton is in one pose, as arrays that a scene can be filled with."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array, Skeleton
from kinesphere.data.sticks import sticks_of
from kinesphere.geometry.rotations import quaternions_from_rotations, rotation_between

NOWHERE = 1e-6
"""Size of what has no pose: nothing would be a matrix without inverse."""
_X = np.array([1.0, 0.0, 0.0])
_IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])


@dataclass(frozen=True)
class Placed:
    """Copies of one shape: where, how turned, how large."""

    positions: Array
    """(n, 3) m."""
    wxyzs: Array
    """(n, 4)."""
    scales: Array
    """(n, 3)."""


class Figure:
    """The parts of a skeleton that ride on its limbs."""

    def __init__(self, skeleton: Skeleton, thickness: float = 0.24) -> None:
        sticks = [stick for limb in sticks_of(skeleton) for stick in limb]
        self.stick_limbs = np.array([stick.limb for stick in sticks])
        self._near = np.array([stick.near for stick in sticks])
        spans = np.array([stick.far for stick in sticks]) - self._near
        lengths = np.linalg.norm(spans, axis=1)
        self._stick_turns = rotation_between(_X, spans / np.maximum(lengths, NOWHERE)[:, None])
        thick = np.clip(thickness * lengths, 0.03, 0.09)
        self._stick_scales = np.stack([lengths, thick, thick], axis=1)
        axes = [
            (j, axis)
            for j, joint in enumerate(skeleton.joints)
            if joint.axes is not None
            for axis in joint.axes
        ]
        self.axis_joints = np.array([j for j, _ in axes], dtype=np.intp)
        self.axis_numbers = np.array([k for j in skeleton.joints for k in range(j.n_axes)])
        ways = np.array([axis for _, axis in axes]).reshape(-1, 3)
        self._axis_turns = rotation_between(_X, ways)
        self._parents = skeleton.parents[1:]
        self._centres = np.array([j.centre_in_parent for j in skeleton.joints]).reshape(-1, 3)

    def sticks(self, rotations: Array, origins: Array) -> Placed:
        """Return a copy of the bone for each stick; of limbs (n_limbs, 3, 3) and (n_limbs, 3)."""
        turns, places = rotations[self.stick_limbs], origins[self.stick_limbs]
        return _placed(
            (turns @ self._near[..., None])[..., 0] + places,
            turns @ self._stick_turns,
            self._stick_scales,
        )

    def frames(self, rotations: Array, origins: Array, size: float = 1.0) -> Placed:
        """Return the frame of each limb."""
        return _placed(origins, rotations, np.full((len(origins), 3), size))

    def joint_centres(self, rotations: Array, origins: Array) -> Array:
        """Return where each joint is, (n_joints, 3) m, carried by the parent."""
        turned: Array = (rotations[self._parents] @ self._centres[..., None])[..., 0]
        return turned + origins[self._parents]

    def axes(self, rotations: Array, origins: Array, size: float = 0.16) -> Placed:
        """Return an arrow for each movement axis, as it stands in its parent."""
        turns = rotations[self._parents[self.axis_joints]] @ self._axis_turns
        places = self.joint_centres(rotations, origins)[self.axis_joints]
        return _placed(places, turns, np.full((len(places), 3), size))


def markers_placed(markers: Array, radius: float) -> Placed:
    """Return a ball for each marker, (n, 3) m; those unseen have no size."""
    turns = np.broadcast_to(np.eye(3), (len(markers), 3, 3))
    return _placed(markers, turns, np.full((len(markers), 3), radius))


def wxyz_from_rotations(rotations: Array) -> Array:
    """Return quaternions as viser has them, (n, 3, 3) → (n, 4)."""
    return np.roll(quaternions_from_rotations(rotations), 1, axis=-1)


def _placed(positions: Array, turns: Array, scales: Array) -> Placed:
    known = np.asarray(np.isfinite(positions).all(axis=1) & np.isfinite(turns).all(axis=(1, 2)))
    wxyzs = np.broadcast_to(_IDENTITY, (len(positions), 4)).copy()
    wxyzs[known] = wxyz_from_rotations(turns[known])
    return Placed(
        np.where(known[:, None], positions, 0.0),
        wxyzs,
        np.where(known[:, None], scales, NOWHERE),
    )
