"""From tracked poses to skeleton and motion: from here on nobody knows there were no markers."""

from dataclasses import replace

import numpy as np

from kinesphere import __version__
from kinesphere.data import (
    Array,
    Joint,
    Limb,
    Mask,
    Motion,
    PoseFlag,
    Recording,
    Scene,
    Skeleton,
    Step,
)
from kinesphere.errors import DegenerateMotion
from kinesphere.geometry.range_of_motion import range_of_motion
from kinesphere.markerless.tracked import CHECKS, CULPRIT, TrackedMotion

_EMPTY = np.empty((0, 3))
_ODD = 0.7
"""A camera whose overlap is below this share of the usual one is doubted."""


def motion_from_tracked(tracked: TrackedMotion, *, keep_lost: bool = False) -> Motion:
    """Return the motion of the tracked limbs; what was lost has no pose.

    A joint's centre is where its limb begins. Where the body model has bones that are no limbs of
    the house (a clavicle), the centre moves in its parent; its mean is taken, and the joint's
    residual says by how much.

    Parameters
    ----------
    keep_lost
        Keep the poses of limbs that are held lost, flagged as rebuilt.

    Raises
    ------
    DegenerateMotion
        If no frame has a pose.
    """
    if not tracked.solved.any():
        raise DegenerateMotion("no frame has a pose: the person was not found in any")
    lost = tracked.lost & tracked.solved[:, None]
    gone = ~tracked.solved[:, None] | (lost & (not keep_lost))
    rotations = np.where(gone[..., None, None], np.nan, tracked.rotations)
    origins = np.where(gone[..., None], np.nan, tracked.origins)
    flags = np.full(gone.shape, PoseFlag.MEASURED, dtype=np.uint8)
    flags[lost] = PoseFlag.FILLED
    flags[gone] = PoseFlag.UNSEEN
    # a lost limb still tells how long bones are: lengths are the model's
    skeleton = _skeleton(tracked)
    return Motion(
        skeleton=skeleton,
        rotations=rotations,
        origins=origins,
        residuals=np.full(gone.shape, np.nan),
        flags=flags,
        rate=tracked.rate,
        history=tracked.history,
    )


def recording_of(scene: Scene, motion: Motion) -> Recording:
    """Return the recording that stands for a scene: no markers, its rate and its axes."""
    return Recording(
        markers=np.empty((motion.n_frames, 0, 3)),
        labels=(),
        rate=motion.rate,
        first_frame=scene.first_frame + 1,
        up="+y",
        world_from_file=scene.world_from_file,
        history=motion.history,
    )


def tracking_step(tracked: TrackedMotion, cameras: tuple[str, ...]) -> Step:
    """Return what people should know of a tracked motion: overlap, support, and what was lost."""
    support = _medians(tracked.support)
    lost = tracked.lost.sum(axis=0)
    reached = tracked.n_frames if tracked.n_reached is None else tracked.n_reached
    named = any(CULPRIT in step.findings for step in tracked.history if step.name == CHECKS)
    return Step(
        "tracking result",
        findings={
            "n_frames": tracked.n_frames,
            "n_solved": int(tracked.solved.sum()),
            "overlap_mean": _mean(tracked.overlap),
            "overlap_of_camera": dict(
                zip(cameras, (_mean(o) for o in tracked.overlap.T), strict=True)
            ),
            "support_of_limb": dict(zip(tracked.limb_names, support, strict=True)),
            "frames_lost_of_limb": dict(
                zip(tracked.limb_names, (int(n) for n in lost), strict=True)
            ),
            "frames_per_s": reached / total
            if (total := sum(v for k, v in tracked.seconds.items() if k != "decoding")) > 0
            else None,
            "seconds_of_module": dict(tracked.seconds),
        },
        # one wrong camera drags the body out of all; silhouettes alone know better which it is
        warnings=() if named else _odd_cameras(tracked.overlap, cameras),
        version=__version__,
    )


def _skeleton(tracked: TrackedMotion) -> Skeleton:
    names, parents = tracked.limb_names, tracked.limb_parents
    lengths = np.linalg.norm(tracked.ends, axis=-1)
    limbs = tuple(
        Limb(
            name=name,
            parent=None if parents[i] < 0 else names[parents[i]],
            markers=(),
            marker_positions=_EMPTY,
            length=float(lengths[i]) if lengths[i] > 0 else np.nan,
            long_axis=tracked.ends[i] / lengths[i] if lengths[i] > 0 else np.array([0.0, 1, 0]),
        )
        for i, name in enumerate(names)
    )
    joints = tuple(_joint(tracked, i, tracked.solved) for i in range(1, len(names)))
    return Skeleton(limbs, joints)


def _joint(tracked: TrackedMotion, i: int, solved: Mask) -> Joint:
    p = tracked.limb_parents[i]
    parent, child = tracked.rotations[solved, p], tracked.rotations[solved, i]
    apart = tracked.origins[solved, i] - tracked.origins[solved, p]
    in_parent: Array = (apart[:, None] @ parent)[:, 0]
    centre = in_parent.mean(axis=0)
    off = float(np.sqrt(((in_parent - centre) ** 2).sum(axis=1).mean()))
    return Joint(
        name=tracked.joint_names[i - 1],
        parent=tracked.limb_names[p],
        child=tracked.limb_names[i],
        centre_in_parent=centre,
        centre_in_child=np.zeros(3),
        residual=off,
        range_of_motion=range_of_motion(np.swapaxes(parent, 1, 2) @ child),
        covariance=np.full((3, 3), np.nan),
        observability="given",
        note="the joint of the body model, fitted to the person",
    )


def _odd_cameras(overlap: Array, cameras: tuple[str, ...]) -> tuple[str, ...]:
    """Return what is said of cameras that see the body elsewhere than the others do."""
    means = [_mean(column) for column in overlap.T]
    known = [mean for mean in means if mean is not None]
    if len(known) < 3:
        return ()
    usual = float(np.median(known))
    return tuple(
        f"the model overlaps the person by {mean:.2f} in {name}, by {usual:.2f} in the others: its "
        "calibration, its offset or the way its images were cropped may be wrong"
        for name, mean in zip(cameras, means, strict=True)
        if mean is not None and mean < _ODD * usual
    )


def _mean(values: Array) -> float | None:
    known = values[np.isfinite(values)]
    return float(known.mean()) if len(known) else None


def _medians(values: Array) -> list[float | None]:
    return [
        float(np.median(column[np.isfinite(column)])) if np.isfinite(column).any() else None
        for column in values.T
    ]


def with_first_frame(motion: Motion, scene: Scene) -> Motion:
    """Return the motion with frames numbered as in the scene's first camera."""
    return replace(motion, first_frame=scene.first_frame + 1)
