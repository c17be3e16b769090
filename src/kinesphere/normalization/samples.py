"""The frames that normalization looks at: a few a second, with joints, limb directions, speeds."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Motion
from kinesphere.geometry.even_frames import even_frames
from kinesphere.geometry.medians import column_medians
from kinesphere.geometry.vectors import lengths
from kinesphere.normalization.anatomy import Anatomy

UP = np.array([0.0, 1.0, 0.0])
"""The world's up (docs/conventions.md)."""

_UPRIGHT = np.cos(np.deg2rad(45.0))  # of the trunk's tilt from which it no longer stands


@dataclass(frozen=True, eq=False)
class Samples:
    """Frames of a motion, spread evenly over it."""

    motion: Motion
    anatomy: Anatomy
    frames: NDArray[np.intp]
    """(n,) index of each."""
    speed_window: float
    """s."""

    @property
    def rate(self) -> float:
        """Hz, of the samples."""
        return float(self.motion.rate * len(self.frames) / max(1, self.motion.n_frames))

    @cached_property
    def rotations(self) -> Array:
        """(n, n_limbs, 3, 3) ``world_from_limb``."""
        return np.asarray(self.motion.rotations[self.frames])

    @cached_property
    def joints(self) -> Array:
        """(n, n_joints, 3) m, joint centres in the world."""
        return self._joints_at(self.frames)

    @cached_property
    def directions(self) -> Array:
        """(n, n_limbs, 3) unit vectors along the limbs in the world."""
        lines = self.anatomy.directions
        return np.asarray((self.rotations @ lines[:, :, None])[..., 0])

    @cached_property
    def window(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """(n,) first and (n,) last frame of the speed window around each, shorter at the ends."""
        last = self.motion.n_frames - 1
        half = max(1, round(self.speed_window * self.motion.rate / 2))
        return np.maximum(self.frames - half, 0), np.minimum(self.frames + half, last)

    @cached_property
    def velocities(self) -> Array:
        """(n, n_joints, 3) m/s over the speed window, shorter at the ends; NaN where unknown."""
        before, after = self.window
        seconds = (after - before) / self.motion.rate
        with np.errstate(invalid="ignore", divide="ignore"):
            moved: Array = self._joints_at(after) - self._joints_at(before)
            return np.asarray(moved / seconds[:, None, None])

    @cached_property
    def speeds(self) -> Array:
        """(n,) m/s, median speed of the joints; 0 where a single frame tells none."""
        speeds = lengths(self.velocities)
        return np.nan_to_num(column_medians(speeds.T, np.isfinite(speeds.T)), nan=0.0)

    def pair_centre(self, name: str) -> Array:
        """Return the middle between a left and right joint, (n, 3) m; NaN if not both there."""
        return np.asarray((self.joint(f"left_{name}") + self.joint(f"right_{name}")) / 2)

    def joint(self, name: str) -> Array:
        """Return one joint by its anatomical name, (n, 3) m; NaN if not there."""
        if name not in self.anatomy.joints:
            return np.full((len(self.frames), 3), np.nan)
        return np.asarray(self.joints[:, self.anatomy.joints[name]])

    @cached_property
    def trunk_lines(self) -> Array:
        """(n, 3) m from the bottom of the trunk to its top; NaN where nothing tells.

        From the middle of the hips, else the lumbar joint, to the middle of the shoulders, else
        the neck. Legs alone stand for it from the middle of the ankles, or knees, to the hips.
        """
        hips = self.pair_centre("hip")
        bottom = _first_known(hips, self.joint("lumbar"))
        top = _first_known(self.pair_centre("shoulder"), self.joint("neck"))
        legs = hips - _first_known(self.pair_centre("ankle"), self.pair_centre("knee"))
        return _first_known(top - bottom, legs)

    @cached_property
    def vertical(self) -> Array:
        """(n, 3) unit vectors: what the limbs of somebody standing would hang along.

        The world's up, or the trunk's line where it is known to lie or to stand on its head.
        """
        length = np.linalg.norm(self.trunk_lines, axis=1, keepdims=True)
        with np.errstate(invalid="ignore", divide="ignore"):
            along = self.trunk_lines / length
        lies = along @ UP < _UPRIGHT  # False where the trunk is unknown
        return np.where(lies[:, None], along, UP)

    def _joints_at(self, frames: NDArray[np.intp]) -> Array:
        return self.motion.joint_centres(frames)


def take_samples(motion: Motion, rate: float, speed_window: float, fewest: int = 1) -> Samples:
    """Take frames spread evenly, at most ``rate`` (Hz) or ``fewest`` of them."""
    wanted = round(motion.n_frames * min(1.0, rate / motion.rate))
    frames = even_frames(motion.n_frames, max(wanted, fewest))
    return Samples(motion, Anatomy(motion.skeleton), frames, speed_window)


def _first_known(*choices: Array) -> Array:
    """Return the first choice that is known in any frame at all."""
    for choice in choices:
        if np.isfinite(choice).any():
            return choice
    return choices[-1]
