"""How surely markers belong to their bodies, and which are at joints, steady in two."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.even_frames import even_frames
from kinesphere.geometry.rigid import into_frame
from kinesphere.skeleton.body import measure_shape, robust_rms
from kinesphere.skeleton.discovery.forest import Forest
from kinesphere.skeleton.discovery.joint_costs import Members
from kinesphere.skeleton.discovery.rigidity import Rigidity
from kinesphere.skeleton.discovery.steadiness import OWN_POSE, owners, steadiness

FRAMES = 300
"""Frames that a marker's wandering in a body is judged on."""


@dataclass(frozen=True, eq=False)
class Belonging:
    """How much markers wander in their own body and in those it meets."""

    own: Array
    """(n,) m, rms wander of a marker's distances to the others of its body; NaN for a loner."""
    next: Array
    """(n,) m, the least it wanders in a neighbouring body: of its distances, and of its place seen
    from that body's frame where it has one; infinite without neighbours."""
    neighbour: Members
    """(n,) which body that is; −1 for none."""

    def shared(self, noise: float, ratio: float) -> Members:
        """Return the markers at joints: steady next door to ``ratio`` times what they are here."""
        home = np.hypot(np.nan_to_num(self.own), noise)
        return np.flatnonzero((self.neighbour >= 0) & (np.hypot(self.next, noise) < ratio * home))

    def confidence(self, noise: float) -> Array:
        """Return (n,) 0…1: 1 where another body is out of the question, ½ where it fits as well."""
        home, there = np.hypot(np.nan_to_num(self.own), noise), np.hypot(self.next, noise)
        with np.errstate(invalid="ignore"):
            share = there**2 / (there**2 + home**2)
        return np.where(np.isfinite(there), share, 1.0)


def measure_belonging(
    rigidity: Rigidity,
    bodies: Sequence[Members],
    forest: Forest,
    outlier: float,
    min_spread: float,
) -> Belonging:
    """Return how much every marker wanders at home and next door.

    Parameters
    ----------
    outlier, min_spread
        m, as `kinesphere.geometry.rigid.fit_shape` takes them.
    """
    n = len(rigidity.mean)
    owner, steady = owners(bodies, n), steadiness(rigidity.wander, bodies)
    own = np.where(owner >= 0, steady[np.arange(n), owner], np.nan)
    least, neighbour = np.full(n, np.inf), np.full(n, -1)
    points = rigidity.points[even_frames(len(rigidity.points), FRAMES)]
    for b, members in enumerate(bodies):
        near = forest.neighbours(b)
        if not near:
            continue
        visitors = np.concatenate([bodies[other] for other in near])
        wanders = steady[visitors, b]
        if len(members) >= OWN_POSE and (
            measured := measure_shape(points[:, members], outlier, min_spread)
        ):
            pose = measured[2]
            local = into_frame(pose.rotations, pose.shifts, points[:, visitors])
            wanders = np.fmax(wanders, _straying(local))
        nearer = wanders < least[visitors]
        least[visitors[nearer]], neighbour[visitors[nearer]] = wanders[nearer], b
    return Belonging(own, least, neighbour)


def _straying(local: Array) -> Array:
    """Return how far points stray from their usual places, (n_frames, n, 3) m → (n,) m.

    As the distance between two points that stray alike would wander.
    """
    strays = np.zeros(local.shape[1])
    for i, place in enumerate(np.moveaxis(local, 1, 0)):
        known = place[np.isfinite(place).all(axis=1)]
        if len(known):
            off = np.linalg.norm(known - np.median(known, axis=0), axis=1)
            strays[i] = np.sqrt(2) * robust_rms(off[:, None])[0]
    return strays
