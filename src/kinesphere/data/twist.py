"""Twist spread along a limb: joints that take a part of it each, for blending that is linear.

Where a forearm that is turned by 90° meets an upper arm that is not, a linear blend of the two is
thinner than either. Joints along the forearm that turn by 0, 1/4, 1/2 and 3/4 of it leave steps of
22.5°.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from kinesphere.data.arrays import Array
from kinesphere.data.surface import Surface
from kinesphere.geometry.rotations import rotation_about, rotation_between

STEPS = 4
"""How many parts the twist of a limb is cut into; the last joint is the limb itself."""
_TWISTED = ("upper_arm", "forearm", "thigh")
_MIDDLES = {"upper_arm": (0.35, -0.87, 0.35), "forearm": (0.87, -0.5, 0.0), "thigh": (0.7, -0.7, 0)}
"""Where each of them points in the middle of its range, in its parent; z is outwards. Twist is
told apart from swing about it, and cannot be told where the limb points the opposite way."""
_LOST = np.radians([135.0, 165.0])  # off the middle: from here the twist fades, there it is gone
_WOUND = np.radians(120.0)
"""Beyond, half a turn to the left and to the right come to meet: what is spread runs back to 0."""


@dataclass(frozen=True, eq=False)
class TwistJoints:
    """The joints that spread twist over a bound surface."""

    surface: Surface

    @cached_property
    def limbs(self) -> NDArray[np.intp]:
        """(n_joints,) the limb each rides on."""
        return np.repeat(self._twisted, STEPS)

    @cached_property
    def shares(self) -> Array:
        """(n_joints,) how much of the limb's twist each takes."""
        return np.tile(np.arange(STEPS) / STEPS, len(self._twisted))

    @property
    def names(self) -> tuple[str, ...]:
        """What each is called: ``left_forearm_twist_1`` and so on."""
        return tuple(
            f"{self.surface.limbs[limb]}_twist_{k % STEPS + 1}" for k, limb in enumerate(self.limbs)
        )

    @cached_property
    def axes(self) -> Array:
        """(n_joints, 3) unit vector along each limb, away from its joint, as bound."""
        along = (self.surface.ends - self.surface.joint_centres)[self.limbs]
        return np.asarray(along / np.linalg.norm(along, axis=1, keepdims=True))

    @cached_property
    def _twisted(self) -> NDArray[np.intp]:
        surface = self.surface
        kept = [
            limb
            for limb, name in enumerate(surface.limbs)
            if name.partition("_")[2] in _TWISTED
            and np.linalg.norm(surface.ends[limb] - surface.joint_centres[limb]) > 0
        ]
        return np.array(kept, dtype=np.intp)

    @cached_property
    def weights(self) -> tuple[NDArray[np.intp], Array]:
        """(n_vertices, 4) which limbs and joints carry each vertex, heaviest first, and how much.

        Joints are counted on from the limbs.
        """
        surface = self.surface
        n = len(surface.limbs)
        wide = np.hstack([surface.weights, np.zeros((surface.n_vertices, len(self.limbs)))])
        for k, limb in enumerate(self._twisted):
            way = surface.ends[limb] - surface.joint_centres[limb]
            at = (surface.vertices - surface.joint_centres[limb]) @ way / (way @ way)
            place = np.clip(at, 0.0, 1.0) * STEPS
            own = surface.weights[:, limb].copy()
            for step in range(STEPS + 1):
                column = limb if step == STEPS else n + k * STEPS + step
                wide[:, column] = own * np.maximum(1 - np.abs(place - step), 0.0)
        order = np.argsort(-wide, axis=1, kind="stable")[:, :4]
        shares = np.take_along_axis(wide, order, axis=1)
        shares = shares / shares.sum(axis=1, keepdims=True)
        return np.where(shares > 0, order, 0), shares

    def turns(self, rotations: Array) -> Array:
        """Return how each joint is turned in its limb, (n_frames, n_joints, 3, 3).

        Parameters
        ----------
        rotations : (n_frames, n_limbs, 3, 3)
            ``world_from_limb``, without gaps; all equal in the default position.
        """
        found = np.empty((len(rotations), len(self.limbs), 3, 3))
        for k, limb in enumerate(self._twisted):
            columns = slice(k * STEPS, (k + 1) * STEPS)
            axis = self.axes[k * STEPS]
            parent = int(self.surface.parents[limb])
            relative = np.swapaxes(rotations[:, parent], -1, -2) @ rotations[:, limb]
            angles = _spreadable_twist(relative, axis, self._middle(limb))
            back = -angles[:, None] * (1 - self.shares[columns])
            found[:, columns] = rotation_about(axis, back)
        return found

    def maps(self, rotations: Array, shifts: Array) -> tuple[Array, Array]:
        """Return what takes limbs and joints from the default position to where they are.

        Parameters
        ----------
        rotations, shifts : (n_frames, n_limbs, 3, 3), (n_frames, n_limbs, 3) m
            Of the limbs.

        Returns
        -------
        (n_frames, n_limbs + n_joints, 3, 3), (n_frames, n_limbs + n_joints, 3) m
        """
        turns = self.turns(rotations)
        centres = self.surface.joint_centres[self.limbs]
        way = centres - (turns @ centres[:, :, None])[..., 0]
        carrier = rotations[:, self.limbs]
        places = shifts[:, self.limbs] + (carrier @ way[..., None])[..., 0]
        return (
            np.concatenate([rotations, carrier @ turns], axis=1),
            np.concatenate([shifts, places], axis=1),
        )

    def _middle(self, limb: int) -> Array:
        side, _, kind = self.surface.limbs[limb].partition("_")
        middle = np.array(_MIDDLES[kind]) * (1.0, 1.0, -1.0 if side == "left" else 1.0)
        return np.asarray(middle / np.linalg.norm(middle))


def _spreadable_twist(relative: Array, axis: Array, middle: Array) -> Array:
    """Return the twist (n_frames,) rad about the axis, faded where it cannot be told or spread."""
    points = relative @ axis
    swing = rotation_between(middle, points) @ rotation_between(axis, middle)
    rest = np.swapaxes(swing, -1, -2) @ relative  # turns about the axis alone
    doubled = rest - np.swapaxes(rest, -1, -2)
    sine = np.stack([doubled[:, 2, 1], doubled[:, 0, 2], doubled[:, 1, 0]], axis=1) @ axis
    angle = np.arctan2(sine, np.trace(rest, axis1=1, axis2=2) - 1)
    size = np.abs(angle)
    beyond = np.maximum(np.pi - size, 0.0) * _WOUND / (np.pi - _WOUND)
    angle = np.sign(angle) * np.minimum(size, beyond)
    off = np.arccos(np.clip(points @ middle, -1.0, 1.0))
    told = np.clip((_LOST[1] - off) / (_LOST[1] - _LOST[0]), 0.0, 1.0)
    return np.asarray(angle * told)
