"""One world, and one set of limb frames: constant differences that are definition, not motion."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.rotations import mean_rotation, nearest_rotation, rotation_angle
from kinesphere.geometry.vectors import is_seen, lengths

_ROUNDS = 10
_TINY = 1e-9  # m
_FLAT = 1e-3
"""Spread of the points beside their longest line, as a share of it, that tells a turn about it."""


@dataclass(frozen=True, eq=False)
class WorldAlignment:
    """The rigid motion that takes the second side's world to the first's."""

    rotation: Array
    """(3, 3)."""
    shift: Array
    """(3,) m."""
    residual: float
    """m, rms distance of the joint centres that remains; NaN where nothing could be fitted."""

    @property
    def turn(self) -> float:
        """Angle of the rotation in rad."""
        return float(rotation_angle(self.rotation))

    @property
    def tilt(self) -> float:
        """Angle in rad between the two verticals."""
        return float(np.arccos(np.clip(self.rotation[1, 1], -1.0, 1.0)))


@dataclass(frozen=True, eq=False)
class LimbAlignment:
    """The constant turn between the two frames of one limb."""

    limb: str
    other: str
    """Its name on the second side."""
    rotation: Array
    """(3, 3) ``second_from_first``: the first side's frame seen in the second's."""
    spread: float
    """rad, rms angle that remains between the two orientations."""

    @property
    def turn(self) -> float:
        """Angle of the rotation in rad."""
        return float(rotation_angle(self.rotation))


def fit_world(first: Array, second: Array) -> WorldAlignment | None:
    """Return the rigid fit of one side's joint centres onto the other's (Kabsch 1976).

    Reweighted by the Cauchy function of the distance, on the scale of the median: a joint that the
    two put elsewhere, or an arm that one of them lost, does not turn the whole body.

    Parameters
    ----------
    first, second : (n_frames, n_joints, 3) m
        Matching joints at matching times; NaN is left out.

    Returns
    -------
    WorldAlignment or None
        None where the points lie in a line or there are fewer than three.
    """
    known = is_seen(first) & is_seen(second)
    p, q = first[known], second[known]
    if len(p) < 3:
        return None
    spreads = [np.linalg.svd(x - x.mean(axis=0), compute_uv=False) for x in (p, q)]
    if any(s[1] <= _FLAT * s[0] for s in spreads):
        return None
    weights = np.ones(len(p))
    for _ in range(_ROUNDS):
        share = weights / weights.sum()
        middle_p, middle_q = share @ p, share @ q
        rotation = nearest_rotation((share[:, None] * (p - middle_p)).T @ (q - middle_q))
        shift = middle_p - rotation @ middle_q
        off = lengths(p - (q @ rotation.T + shift))
        weights = 1 / (1 + (off / max(float(np.median(off)), _TINY)) ** 2)
    return WorldAlignment(rotation, shift, float(np.sqrt(np.mean(off**2))))


def same_world(first: Array, second: Array) -> WorldAlignment:
    """Return what leaves the second side in its place, and how far apart the centres are there.

    Parameters
    ----------
    first, second : (n_frames, n_joints, 3) m
        Matching joints at matching times; NaN is left out.
    """
    off = lengths(first - second)
    known = off[np.isfinite(off)]
    residual = float(np.sqrt(np.mean(known**2))) if len(known) else np.nan
    return WorldAlignment(np.eye(3), np.zeros(3), residual)


def fit_limb(
    limb: str, other: str, first: Array, second: Array, *, same: bool = False
) -> LimbAlignment | None:
    """Return the constant turn between two frames of one limb, the chordal mean on SO(3).

    Hartley, Trumpf, Dai & Li (2013), doi:10.1007/s11263-012-0601-0.

    Parameters
    ----------
    limb, other
        Its names on both sides.
    first, second : (n_frames, 3, 3)
        ``world_from_limb`` in one world; NaN where unseen.
    same
        True where both frames are the same by definition, so that any turn is a difference.

    Returns
    -------
    LimbAlignment or None
        None where no frame shows both.
    """
    between = np.swapaxes(second, -1, -2) @ first
    known = np.isfinite(between).all(axis=(1, 2))
    if not known.any():
        return None
    mean = np.eye(3) if same else mean_rotation(between[known])
    left = rotation_angle(mean.T @ between[known])
    return LimbAlignment(limb, other, mean, float(np.sqrt(np.mean(left**2))))
