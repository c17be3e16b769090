"""How badly every two bodies look like neighbours, and whether they can be any at all."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.geometry.even_frames import even_frames
from kinesphere.geometry.rigid import RigidFit
from kinesphere.skeleton.averages import median_seen
from kinesphere.skeleton.topology import JointView, joint_view, limb_poses

FRAMES = 300
"""Frames that joints are looked for on."""
PLAIN, SHARED = 0.25, 0.5
"""Share of the lesser of two bodies' movements in the world, each direction, by which their images
of a joint may be apart: plainly moving together (recordings at hand have up to 0.19), and more so
than each by itself."""
STEADY = 0.01
"""m, most that noise and skin alone take the images apart; beyond it only the first will do."""
ADJOINING = 1.0
"""Times both bodies' lengths together between their nearest markers up to which steady ones may
meet though neither shows: a foot that stands still and its shank."""

Members = NDArray[np.intp]


class JointCosts:
    """Joint costs between sets of markers, each computed once."""

    def __init__(self, points: Array, unit: float = 1.0) -> None:
        """Take (n_sample, n, 3) m at a person's size, and how many times larger the subject is."""
        self.unit = unit
        self.points = points[even_frames(len(points), FRAMES)]
        self._poses: dict[tuple[int, ...], RigidFit | None] = {}
        self._costs: dict[tuple[tuple[int, ...], tuple[int, ...]], float] = {}

    def between(self, a: Members, b: Members) -> float:
        """Return the cost in m of a joint between two bodies; infinite where nothing shows one."""
        key = (tuple(map(int, a)), tuple(map(int, b)))
        if key not in self._costs:
            view = joint_view(self.points[:, a], self.points[:, b], self.pose(a), self.pose(b))
            self._costs[key] = view.cost if self._may_meet(a, b, view) else np.inf
        return self._costs[key]

    def plain(self, a: Members, b: Members) -> bool:
        """Return whether two bodies plainly move together, rather than each standing about."""
        view = joint_view(self.points[:, a], self.points[:, b], self.pose(a), self.pose(b))
        return view.unsteady < PLAIN * self._moved(a, b)

    def _moved(self, a: Members, b: Members) -> float:
        """Return how far the one moves that moves less, m."""
        return min(_moved(self.points[:, a]), _moved(self.points[:, b]))

    def _may_meet(self, a: Members, b: Members, view: JointView) -> bool:
        """Return whether two bodies move together, or are near enough to meet all the same.

        A point that stays where it is in both shows a joint only if it goes about with them: two
        people who stand still, a foot and a thing on the floor have many.
        """
        moved = self._moved(a, b)
        if view.unsteady < PLAIN * moved:
            return True
        if view.unsteady > STEADY:
            return False
        if view.unsteady < SHARED * moved:
            return True
        long = np.nanmax(self._apart(a, a)) + np.nanmax(self._apart(b, b))
        return bool(np.nanmin(self._apart(a, b), initial=np.inf) <= ADJOINING * long)

    def _apart(self, a: Members, b: Members) -> Array:
        """Return the usual distances between two bodies' markers, (n_a, n_b) m."""
        return median_seen(
            np.linalg.norm(self.points[:, a, None] - self.points[:, None, b], axis=-1)
        )

    def pose(self, members: Members) -> RigidFit | None:
        """Return the poses of a body in the frames of ``points``; None if it has none."""
        key = tuple(map(int, members))
        if key not in self._poses:
            self._poses[key] = limb_poses({"": self.points[:, members]}).get("")
        return self._poses[key]


def _moved(points: Array) -> float:
    """Return how far a body's markers move in the world, rms in each direction, m."""
    off = points - median_seen(points)
    return float(np.sqrt(np.mean(off[np.isfinite(off)] ** 2))) if np.isfinite(off).any() else 0.0
