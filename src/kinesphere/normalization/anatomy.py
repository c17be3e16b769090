"""A skeleton seen as a body: which joint is which, how large it is, where its limbs point."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse.csgraph import shortest_path

from kinesphere.data import Array, Skeleton
from kinesphere.normalization.limb_lines import far_end, main_direction, middle_of_markers

BODY_LIMBS = ("pelvis", "trunk")
"""Limbs that get the body frame itself."""

PAIRS = ("shoulder", "hip")
"""Joints on either side of the trunk, whose pairs tell the body's right."""

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
            for name in PAIRS
            if f"left_{name}" in self.joints and f"right_{name}" in self.joints
        }

    @cached_property
    def body_limbs(self) -> tuple[int, ...]:
        """Indices of the limbs that get the body frame: pelvis and trunk, else an unnamed root."""
        named = tuple(self.limbs[name] for name in BODY_LIMBS if name in self.limbs)
        if named or without_side(self.skeleton.limb_names[0]) in CANONICAL:
            return named
        return (0,)

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

        The limbs that get the body frame have none.
        """
        rows = [
            np.full(3, np.nan)
            if i in self.body_limbs
            else main_direction(
                limb,
                self.proximal_ends[i],
                self._carried(i),
                foot=without_side(limb.name) == "foot",
            )
            for i, limb in enumerate(self.skeleton.limbs)
        ]
        return np.array(rows)

    @cached_property
    def distal_ends(self) -> Array:
        """(n_limbs, 3) m: the joint away from the parent, their mean, or the far end of a chain.

        The trunk ends at the neck, or amid the joints above the hips.
        """
        points = np.empty((len(self.skeleton.limbs), 3))
        for i, limb in enumerate(self.skeleton.limbs):
            above = [j for j in self.distal_joints[i] if j not in self._hips]
            if self.joints.get("neck") in above:
                above = [self.joints["neck"]]
            if above:
                points[i] = self._centres(above).mean(axis=0)
            elif i in self.body_limbs:
                points[i] = middle_of_markers(limb)
            else:
                points[i] = far_end(limb, self.proximal_ends[i], self.directions[i])
        return points

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
        return longest if longest > 0 else np.nan

    def mid_point(self, limb: int) -> Array:
        """Return the middle of a limb in its own frame, (3,) m.

        Between its two ends; a root begins amid the hips.
        """
        begin = self.proximal_ends[limb]
        lower = [j for j in self.distal_joints[limb] if j in self._hips]
        if limb == 0 and lower:
            begin = self._centres(lower).mean(axis=0)
        middle: Array = (begin + self.distal_ends[limb]) / 2
        known = np.isfinite(middle).all()
        return middle if known else middle_of_markers(self.skeleton.limbs[limb])

    @cached_property
    def _hips(self) -> tuple[int, ...]:
        return tuple(j for name, j in self.joints.items() if name.endswith("_hip"))

    def _carried(self, limb: int) -> Array:
        return self._centres(self.distal_joints[limb])

    def _centres(self, joints: Sequence[int]) -> Array:
        """Return joint centres in the frame of the limb that carries them, (n, 3) m."""
        centres = [self.skeleton.joints[j].centre_in_parent for j in joints]
        return np.array(centres).reshape(-1, 3)
