"""How a surface moves: the turn of every limb, and where that carries joints and skin."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from kinesphere.data import Array
from kinesphere.data.surface import Surface


@dataclass(frozen=True, eq=False)
class BodyMotion:
    """A surface and the turns of its limbs, in the world: y up, metres."""

    surface: Surface
    turns: Array
    """(n_frames, n_limbs, 3, 3) from the surface's rest to the world."""
    root: Array
    """(n_frames, 3) m, where the root's own middle is."""
    rate: float
    """Hz."""

    @property
    def n_frames(self) -> int:
        """Number of frames."""
        return len(self.turns)

    @cached_property
    def joint_centres(self) -> Array:
        """(n_frames, n_limbs, 3) m, where each limb begins."""
        rest, parents = self.surface.joint_centres, self.surface.parents
        centres = np.empty((self.n_frames, len(parents), 3))
        centres[:, 0] = self.root
        for limb, parent in enumerate(parents[1:], start=1):
            arm = self.turns[:, parent] @ (rest[limb] - rest[parent])
            centres[:, limb] = centres[:, parent] + arm
        return centres

    @cached_property
    def ends(self) -> Array:
        """(n_frames, n_limbs, 3) m, where each limb ends."""
        reach = (self.surface.ends - self.surface.joint_centres)[None, :, :, None]
        ends: Array = self.joint_centres + (self.turns @ reach)[..., 0]
        return ends

    def vertices(self, frame: int) -> Array:
        """Return the skin of one frame, (n_vertices, 3) m: linear blend skinning."""
        return self.carried(frame, self.surface.vertices)

    def carried(self, frame: int, points: Array) -> Array:
        """Return what rides on the skin at rest, (n_vertices, 3), carried to a frame."""
        limbs, shares = self.surface.weight_limbs, self.surface.weight_shares
        turns, centres = self.turns[frame], self.joint_centres[frame]
        shifts = centres - (turns @ self.surface.joint_centres[:, :, None])[:, :, 0]
        blended = np.einsum("vk,vkij->vij", shares, turns[limbs])
        moved: Array = (blended @ points[:, :, None])[:, :, 0]
        moved += np.einsum("vk,vki->vi", shares, shifts[limbs])
        return moved

    def angle_at(self, limb: str) -> Array:
        """Return the angle between a limb and its parent, (n_frames,) rad: 0 where straight.

        Between the lines from joint to joint, so that it depends on no convention of axes.
        """
        at = self.surface.limbs.index(limb)
        parent = int(self.surface.parents[at])
        before = self.joint_centres[:, at] - self.joint_centres[:, parent]
        after = self.ends[:, at] - self.joint_centres[:, at]
        across = np.linalg.norm(np.cross(before, after), axis=-1)
        angle: Array = np.arctan2(across, (before * after).sum(axis=-1))
        return angle
