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
    why_named: str = ""
    """Why frames of one name are taken for the same, a clause; empty where the markers tell."""


def turn_between(limb: Limb, other: Limb) -> Turn:
    """Return the rotation from the other's frame into the limb's, by the markers on both.

    Skin, or markers that were put on anew, show in how badly they fit: where that leaves more open
    than the two default positions do, or where the limbs share no three markers that are off a
    line, frames with one name are taken for the same.

    The turn is as unsure as the rotation about the markers' longest line. Of limbs whose markers
    were put on 10 mm anew 1 in 10 is turned by three or four of them (6 and 4° off, median), 19 in
    20 by six (3° off); at 20 mm 1 in 50 and 1 in 11.
    """
    shared = [m for m in limb.markers if m in other.markers]
    here, there = (
        np.array([one.marker_positions[one.markers.index(m)] for m in shared]).reshape(-1, 3)
        for one in (limb, other)
    )
    known = np.isfinite(here).all(axis=1) & np.isfinite(there).all(axis=1)
    here, there = here[known], there[known]
    n = len(here)
    if n > 1 and np.array_equal(here, there):
        return Turn(np.eye(3), 0.0)  # one solution stays as it is, to the last digit
    if n < 3:
        return _named("fewer than three markers in both" if n else "no markers in both")
    fit = fit_rigid(there, here[None])
    if not fit.fitted[0]:
        return _named("markers on a line")
    rotation = np.asarray(fit.rotations[0])
    left = here - there @ rotation.T - fit.shifts[0]
    noise = np.sqrt((left**2).sum() / (3 * n - 6))  # m, of one coordinate of one marker
    spread = np.linalg.svd(here - here.mean(axis=0), compute_uv=False)[1]  # across the longest line
    unsure = float(noise / spread)
    return Turn(rotation, unsure) if unsure < FRAMES else _named("markers lie otherwise")


def _named(why: str) -> Turn:
    return Turn(np.eye(3), FRAMES, why)
