"""The motion of bones as animation files have it, into our Motion: y up, whatever the file has."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Array, Motion, PoseFlag, Step
from kinesphere.data.figure import find_figure
from kinesphere.errors import BadModel
from kinesphere.geometry.vectors import lengths
from kinesphere.io.bones import Bone, skeleton_of_bones


def motion_of_bones(
    bones: list[Bone],
    rotations: Array,
    places: Array,
    metres: float,
    rate: float,
    file_from_body: Array,
    step: Step,
) -> Motion:
    """Return the bones' motion in the world, y up.

    Parameters
    ----------
    rotations : (n_frames, n_bones, 3, 3)
        From the rest pose, in the file's axes.
    places : (n_frames, n_bones, 3)
        In the file's unit and axes.
    step
        How they were read; it learns what was found about up, and of joints that come apart.
    """
    skeleton = skeleton_of_bones(bones, metres, file_from_body)
    unseen = ~(np.isfinite(rotations).all(axis=(2, 3)) & np.isfinite(places).all(axis=2))
    turned = rotations @ file_from_body
    origins = places * metres
    turned[unseen], origins[unseen] = np.nan, np.nan
    flags = np.where(unseen, PoseFlag.UNSEEN, PoseFlag.MEASURED).astype(np.uint8)
    motion = Motion(skeleton, turned, origins, np.full(flags.shape, np.nan), flags, rate)
    warnings = step.warnings
    if (up := _up(motion)) != "+y":
        sign, axis = up[0], "xyz".index(up[1])
        turn = np.zeros((3, 3))  # a cyclic step takes z to y, x to y
        turn[1, axis] = 1.0 if sign == "+" else -1.0
        turn[0] = _other(axis)
        turn[2] = np.cross(turn[0], turn[1])
        # the limb frames stay parallel to the body's in the rest pose: they turn with it
        skeleton = skeleton_of_bones(bones, metres, turn.T @ file_from_body)
        motion = replace(
            motion,
            skeleton=skeleton,
            rotations=turn @ rotations @ turn.T @ file_from_body,
            origins=origins @ turn.T,
        )
        warnings = (*warnings, f"the figure stands along {up}; it was turned so that y is up")
    apart = _apart(motion)
    if len(apart) and np.nanmax(apart, initial=0.0) > 1e-4:
        warnings = (
            *warnings,
            f"joints come apart by up to {np.nanmax(apart) * 1e3:.1f} mm: inner joints have "
            "positions of their own",
        )
    joints = tuple(
        replace(joint, residual=float(gap))
        for joint, gap in zip(motion.skeleton.joints, apart, strict=True)
    )
    step = replace(
        step, findings={**step.findings, "metres_per_unit": metres, "up": up}, warnings=warnings
    )
    return replace(
        motion,
        skeleton=replace(motion.skeleton, joints=joints, history=(step,)),
        history=(step,),
    )


def _other(axis: int) -> Array:
    """Return the axis of the file that becomes x: its own x, or z where x is up."""
    return np.asarray(np.eye(3)[0 if axis != 0 else 2])


def _up(motion: Motion) -> str:
    """Return the axis from feet to head or chest, by the middle of all frames; +y if unsure."""
    try:
        figure = find_figure(motion.skeleton)
    except BadModel:
        return "+y"
    low = [figure.parts.get(f"{s}_foot", figure.parts[f"{s}_shank"]) for s in ("left", "right")]
    high = figure.parts.get("head", figure.chest)
    way = motion.origins[:, high] - motion.origins[:, low].mean(axis=1)
    if not np.isfinite(way).all(axis=1).any():
        return "+y"
    middle = np.nanmedian(way, axis=0)
    axis = int(np.abs(middle).argmax())
    if abs(middle[1]) > 0.7 * abs(middle[axis]) and middle[1] > 0:
        return "+y"
    return ("+" if middle[axis] > 0 else "-") + "xyz"[axis]


def _apart(motion: Motion) -> Array:
    """Return how far each joint's child hangs from its place on the parent, (n_joints,) m rms."""
    parents = motion.skeleton.parents[1:]
    at = np.array([joint.centre_in_parent for joint in motion.skeleton.joints]).reshape(-1, 3)
    there = motion.origins[:, parents] + (motion.rotations[:, parents] @ at[..., None])[..., 0]
    gaps = lengths(there - motion.origins[:, 1:])
    seen = np.isfinite(gaps)
    squares = np.where(seen, gaps, 0.0) ** 2
    return np.asarray(np.sqrt(squares.sum(axis=0) / np.maximum(seen.sum(axis=0), 1)))
