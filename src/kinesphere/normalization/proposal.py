"""A body frame for every sampled frame, by whichever way the skeleton allows."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array, vector_from_direction
from kinesphere.errors import DegenerateMotion
from kinesphere.normalization.anatomy import PAIRS
from kinesphere.normalization.body_frame import face_the_same_way, lateral_frames, plane_frames
from kinesphere.normalization.default_position import JOINTS_OF_A_PLANE
from kinesphere.normalization.samples import UP, Samples
from kinesphere.normalization.settings import NormalizationSettings


@dataclass(frozen=True, eq=False)
class Proposal:
    """Body frames before anybody has asked which side is the front."""

    root_from_body: Array
    """(n, 3, 3) in the root limb's old frame, all with the same front; NaN where too little is
    seen."""
    method: str
    named: bool
    """True where names of left and right settle the front."""
    needs: str
    """What a frame must show, in words."""
    only_best: bool = False
    """True where the frames mean something in the default position alone."""
    warnings: tuple[str, ...] = ()


def propose_bodies(
    samples: Samples, settings: NormalizationSettings, facing: str | None
) -> Proposal:
    """Place the body's axes in every sample.

    Raises
    ------
    DegenerateMotion
        If neither pairs nor at least four joints are there, nor a world direction to face.
    """
    anatomy = samples.anatomy
    roots = np.swapaxes(samples.rotations[:, 0], -1, -2)
    across = to_the_right(samples)
    named = bool(np.isfinite(across).any())
    if settings.body == "lateral" and named:
        upward = samples.trunk_lines
        # legs and the world's up tell how somebody stands, not how the body is made
        lean = settings.vertical == "trunk" and len(anatomy.pairs) == len(PAIRS)
        if settings.vertical == "up" or not np.isfinite(upward).any():
            upward, lean = np.broadcast_to(UP, across.shape), False
        return Proposal(
            root_from_body=roots @ lateral_frames(across, upward, lean=lean),
            method="lateral",
            named=True,
            needs=f"left and right {' and '.join(anatomy.pairs)}",
        )
    warnings: tuple[str, ...] = ()
    if settings.body == "lateral":
        warnings = (
            "no pair of left and right shoulders or hips is named; the body frame is the plane "
            "through the joints",
        )
    n_joints = samples.joints.shape[1]
    if n_joints >= JOINTS_OF_A_PLANE:
        seen = np.isfinite(samples.joints).all(axis=2).sum(axis=1) >= JOINTS_OF_A_PLANE
        joints = np.where(seen[:, None, None], samples.joints, np.nan)
        bodies = plane_frames(joints, samples.vertical, samples.trunk_lines)
        sides = across if named else away_from_the_neck(samples)
        sides = (roots @ sides[..., None])[..., 0]
        return Proposal(
            root_from_body=face_the_same_way(roots @ bodies, sides),
            method="plane",
            named=bool(np.isfinite(sides).any()),
            needs="four joints",
            warnings=warnings,
        )
    told = {0: "no joint tells", 1: "1 joint does not tell"}.get(
        n_joints, f"{n_joints} joints do not tell"
    )
    if facing is None or facing[0] not in "+-" or facing[-1] == "y":
        raise DegenerateMotion(
            f"{told} the body's axes: it takes a pair of shoulders or hips "
            "named left and right, or four joints, or a level facing such as '+x'"
        )
    body = lateral_frames(np.cross(vector_from_direction(facing), UP)[None], UP[None])
    return Proposal(
        root_from_body=roots @ body,
        method="facing",
        named=False,
        needs="the root limb",
        only_best=True,
        warnings=(f"{told} the body's axes; they are those of the world, facing {facing}",),
    )


def to_the_right(samples: Samples) -> Array:
    """Return the sum of the lines from left to right shoulder and hip, (n, 3) m.

    NaN where a frame does not show every pair; should no frame show both, the pair seen most.
    """
    lines = [
        samples.joints[:, right] - samples.joints[:, left]
        for left, right in samples.anatomy.pairs.values()
    ]
    if not lines:
        return np.full((len(samples.frames), 3), np.nan)
    together: Array = np.sum(lines, axis=0)
    if np.isfinite(together).any():
        return together
    return max(lines, key=lambda line: np.isfinite(line).sum())


def away_from_the_neck(samples: Samples) -> Array:
    """Return a direction to the right from the shoulder of half a body, (n, 3) m, or NaN."""
    neck = samples.joint("neck")
    if "right_shoulder" in samples.anatomy.joints:
        return samples.joint("right_shoulder") - neck
    return neck - samples.joint("left_shoulder")
