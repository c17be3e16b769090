"""How the frames of one limb in two recordings of one person lie to each other."""

from typing import NamedTuple

import numpy as np

from kinesphere.data import Array, Limb
from kinesphere.geometry.rigid import fit_rigid

FRAMES = np.deg2rad(4.0)
"""rad, by which an axis differs between the default positions of two recordings of one person: the
frames of a limb differ by 4.6° (median of 231 pairs over seven functional trials)."""


class Turn(NamedTuple):
    """From one recording's frame of a limb into another's."""

    rotation: Array
    """(3, 3)"""
    unsure: float
    """rad, standard deviation."""


def turn_between(limb: Limb, other: Limb) -> Turn:
    """Return the rotation from the other's frame into the limb's, by the markers on both.

    Skin, or markers that were put on anew, show in how badly they fit: where that leaves more open
    than the two default positions do, or where the limbs share no three markers, frames with one
    name are taken for the same.
    """
    plain = Turn(np.eye(3), FRAMES)
    shared = [m for m in limb.markers if m in other.markers]
    if len(shared) < 3:
        return plain
    here, there = (
        np.array([one.marker_positions[one.markers.index(m)] for m in shared])
        for one in (limb, other)
    )
    known = np.isfinite(here).all(axis=1) & np.isfinite(there).all(axis=1)
    here, there = here[known], there[known]
    n = len(here)
    if n < 3:
        return plain
    fit = fit_rigid(there, here[None])
    if not fit.fitted[0]:
        return plain
    rotation = np.asarray(fit.rotations[0])
    left = here - there @ rotation.T - fit.shifts[0]
    freedom = 3 * n - 6
    noise = np.sqrt((left**2).sum() / freedom)  # m, of one coordinate of one marker
    spread = np.linalg.svd(here - here.mean(axis=0), compute_uv=False)[1]  # across the longest line
    unsure = float(noise / spread)
    return Turn(rotation, unsure) if unsure < FRAMES else plain
