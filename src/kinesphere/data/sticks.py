"""The sticks a skeleton is drawn by: from where a limb hangs to each joint it carries."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data.arrays import Array
from kinesphere.data.skeleton import Skeleton

_UNKNOWN = 0.1  # m, drawn of a limb whose length nothing tells


@dataclass(frozen=True)
class Stick:
    """One line of a limb."""

    limb: int
    near: Array
    """(3,) m in the limb frame."""
    far: Array
    """(3,) m in the limb frame."""


def sticks_of(skeleton: Skeleton) -> tuple[tuple[Stick, ...], ...]:
    """Return the sticks of every limb; a limb that carries none ends where its length says."""
    drawn = []
    for i, limb in enumerate(skeleton.limbs):
        near = np.zeros(3) if i == 0 else skeleton.joints[i - 1].centre_in_child
        ends = [j.centre_in_parent for j in skeleton.joints if j.parent == limb.name]
        if not ends:
            length = limb.length if np.isfinite(limb.length) else _reach(limb.marker_positions)
            ends = [near + limb.long_axis * length]
        drawn.append(tuple(Stick(i, near, end) for end in ends))
    return tuple(drawn)


def side_of(name: str) -> str:
    """Return ``left``, ``right`` or ``middle`` by the name of a limb or joint."""
    return next((side for side in ("left", "right") if name.startswith(f"{side}_")), "middle")


def _reach(positions: Array) -> float:
    return float(np.linalg.norm(np.ptp(positions, axis=0))) if len(positions) > 1 else _UNKNOWN
