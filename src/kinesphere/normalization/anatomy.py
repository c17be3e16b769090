"""What limbs and their names tell: where each begins, ends and points, which joint is which."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse.csgraph import shortest_path

from kinesphere.data import Array, Limb, Skeleton

BODY_LIMBS = ("pelvis", "trunk")
"""Limbs that get the body frame itself."""

CANONICAL = {
    "head": (0.0, 1.0, 0.0),
    "upper_arm": (0.0, -1.0, 0.0),
    "forearm": (0.0, -1.0, 0.0),
    "hand": (0.0, -1.0, 0.0),
    "thigh": (0.0, -1.0, 0.0),
    "shank": (0.0, -1.0, 0.0),
    "foot": (1.0, 0.0, 0.0),
}
"""Direction from proximal to distal in the default position, in the body frame (conventions)."""

_PROXIMAL_JOINT = {
    "head": "neck",
    "upper_arm": "shoulder",
    "forearm": "elbow",
    "hand": "wrist",
    "thigh": "hip",
    "shank": "knee",
    "foot": "ankle",
}

_TOO_SHORT = 1e-6  # m; a direction between points closer than this is rounding error

_ROW = 1.5  # times longer than wide from which points lie in a row


def without_side(name: str) -> str:
    """Return the limb's name without ``left_`` or ``right_``."""
    return name.removeprefix("left_").removeprefix("right_")


@dataclass(frozen=True, eq=False)
class Anatomy:
    """A skeleton seen as a body. Points and directions are in each limb's own frame."""

    skeleton: Skeleton

    @cached_property
    def limbs(self) -> dict[str, int]:
        """Name → index of each limb."""
        return {name: i for i, name in enumerate(self.skeleton.limb_names)}

    @cached_property
    def joints(self) -> dict[str, int]:
        """``left_shoulder``, ``neck``… → index of the joint at the proximal end of that limb.

        Told by the limbs, for a layout may call its joints what it likes.
        """
        found: dict[str, int] = {}
        for j, joint in enumerate(self.skeleton.joints):
            bare = without_side(joint.child)
            if bare in _PROXIMAL_JOINT:
                side = joint.child[: len(joint.child) - len(bare)]
                found[side + _PROXIMAL_JOINT[bare]] = j
            elif {joint.parent, joint.child} == set(BODY_LIMBS):
                found["lumbar"] = j
        return found

    @cached_property
    def pairs(self) -> dict[str, tuple[int, int]]:
        """``shoulder``, ``hip`` → (left, right) joint, where both are there."""
        return {
            name: (self.joints[f"left_{name}"], self.joints[f"right_{name}"])
            for name in ("shoulder", "hip")
            if f"left_{name}" in self.joints and f"right_{name}" in self.joints
        }

    @cached_property
    def body_limbs(self) -> tuple[int, ...]:
        """Indices of the limbs that get the body frame: pelvis and trunk, else the root."""
        named = tuple(self.limbs[name] for name in BODY_LIMBS if name in self.limbs)
        return named or (0,)

    @cached_property
    def distal_joints(self) -> tuple[tuple[int, ...], ...]:
        """Per limb, the joints it carries."""
        carried: list[list[int]] = [[] for _ in self.skeleton.limbs]
        for j, joint in enumerate(self.skeleton.joints):
            carried[self.limbs[joint.parent]].append(j)
        return tuple(tuple(joints) for joints in carried)

    @cached_property
    def proximal_ends(self) -> Array:
        """(n_limbs, 3) m: the joint towards the parent; NaN for the root."""
        points = np.full((len(self.skeleton.limbs), 3), np.nan)
        for j, joint in enumerate(self.skeleton.joints):
            points[j + 1] = joint.centre_in_child
        return points

    @cached_property
    def directions(self) -> Array:
        """(n_limbs, 3) unit vectors along each limb, proximal to distal; NaN where unknown.

        From joint to joint; along the principal direction of the joints where a limb carries
        several. At the end of a chain from the joint to the middle of the markers, which is surer
        than any one of them; a foot points where its joint and markers lie in a row, from heel to
        toes; without markers the skeleton's long axis counts. The limbs that get the body frame
        have none.
        """
        rows = [self._direction(i) for i in range(len(self.skeleton.limbs))]
        return np.array(rows).reshape(-1, 3)

    @cached_property
    def distal_ends(self) -> Array:
        """(n_limbs, 3) m: the joint away from the parent, their mean, or the far end of a chain."""
        return np.array([self._distal_end(i) for i in range(len(self.skeleton.limbs))])

    @cached_property
    def span(self) -> float:
        """m, the longest way through the bones, about the body height; NaN without any bone.

        A measure of size that no pose changes.
        """
        n_joints, n_limbs = len(self.skeleton.joints), len(self.skeleton.limbs)
        lengths = np.zeros((n_joints + n_limbs, n_joints + n_limbs))
        for i in range(n_limbs):
            nodes = [*self.distal_joints[i], n_joints + i]
            places = [self.skeleton.joints[j].centre_in_parent for j in self.distal_joints[i]]
            places.append(self.distal_ends[i])
            if i > 0:
                nodes.append(i - 1)
                places.append(self.proximal_ends[i])
            for a, place in zip(nodes, places, strict=True):
                for b, other in zip(nodes, places, strict=True):
                    distance = float(np.linalg.norm(place - other))
                    if np.isfinite(distance):
                        lengths[a, b] = distance
        ways = shortest_path(lengths, directed=False)
        reached = ways[np.isfinite(ways)]
        longest = float(reached.max(initial=0.0))
        return longest if longest > _TOO_SHORT else np.nan

    def mid_point(self, limb: int) -> Array:
        """Return the middle of a limb in its own frame, (3,) m.

        Between its two ends; for the root between the lower and the upper joints of the body.
        """
        middle: Array = (self._begin(limb) + self.distal_ends[limb]) / 2
        return middle if np.isfinite(middle).all() else _centroid(self.skeleton.limbs[limb])

    def _carried(self, limb: int) -> Array:
        centres = [self.skeleton.joints[j].centre_in_parent for j in self.distal_joints[limb]]
        return np.array(centres).reshape(-1, 3)

    def _begin(self, limb: int) -> Array:
        if limb > 0:
            return np.asarray(self.proximal_ends[limb])
        lower = [j for name, j in self.joints.items() if name.endswith("_hip")]
        lower = [j for j in lower if j in self.distal_joints[limb]]
        points = np.array([self.skeleton.joints[j].centre_in_parent for j in lower])
        return points.mean(axis=0) if len(points) else np.full(3, np.nan)

    def _direction(self, limb: int) -> Array:
        unknown = np.full(3, np.nan)
        if limb in self.body_limbs:
            return unknown
        it, begin, carried = (
            self.skeleton.limbs[limb],
            self.proximal_ends[limb],
            self._carried(limb),
        )
        if len(carried) == 1:
            return _unit(carried[0] - begin)
        if len(carried) > 1:
            points = np.vstack([begin[None], carried])
            points = points[np.isfinite(points).all(axis=1)]
            return _principal(points, carried.mean(axis=0) - begin)
        markers = it.marker_positions[np.isfinite(it.marker_positions).all(axis=1)]
        if not len(markers):
            return _unit(it.long_axis)
        points = np.vstack([begin[None], markers])
        points = points[np.isfinite(points).all(axis=1)]
        outward = markers.mean(axis=0) - begin
        row = without_side(it.name) == "foot" and _elongation(points) > _ROW
        at_joint = not np.linalg.norm(outward) > 1e-3 * np.ptp(points, axis=0).max()
        return _principal(points, outward) if row or at_joint else _unit(outward)

    def _distal_end(self, limb: int) -> Array:
        it, carried = self.skeleton.limbs[limb], self._carried(limb)
        if len(carried) and limb in self.body_limbs:
            # the hips begin the body, everything above ends it
            low = [j for n, j in self.joints.items() if n.endswith("_hip")]
            upper = [
                self.skeleton.joints[j].centre_in_parent
                for j in self.distal_joints[limb]
                if j not in low
            ]
            neck = self.joints.get("neck")
            if neck in self.distal_joints[limb]:
                upper = [self.skeleton.joints[neck].centre_in_parent]
            return np.mean(upper, axis=0) if upper else _centroid(it)
        if len(carried):
            return np.asarray(carried.mean(axis=0))
        along = self._direction(limb)
        if np.isfinite(it.length):
            return np.asarray(self.proximal_ends[limb] + it.length * along)
        reach = (it.marker_positions - self.proximal_ends[limb]) @ along
        farthest = np.max(reach[np.isfinite(reach)], initial=0.0)
        return np.asarray(self.proximal_ends[limb] + farthest * along)


def _centroid(limb: Limb) -> Array:
    known = limb.marker_positions[np.isfinite(limb.marker_positions).all(axis=1)]
    return known.mean(axis=0) if len(known) else np.full(3, np.nan)


def _unit(vector: Array) -> Array:
    length = np.linalg.norm(vector)
    return vector / length if length > _TOO_SHORT else np.full(3, np.nan)


def _elongation(points: Array) -> float:
    """Return how many times longer than wide the points spread."""
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return float(spread[0] / max(spread[1], 1e-12)) if len(spread) > 1 else np.inf


def _principal(points: Array, outward: Array) -> Array:
    """Return the direction in which the points spread most, on the side of ``outward``."""
    if len(points) < 2:
        return np.full(3, np.nan)
    _, spread, axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    if spread[0] < _TOO_SHORT:
        return np.full(3, np.nan)
    side = np.sign(axes[0] @ np.nan_to_num(outward))
    return np.asarray(axes[0] * (side or 1.0))
