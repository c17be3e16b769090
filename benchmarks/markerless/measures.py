"""How far tracking is from the truth: elbows, joints, limbs that went astray."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array
from kinesphere.markerless import TrackedMotion
from kinesphere.synthetic.film import Film

ASTRAY = 0.15
"""m; a limb whose far joint is farther off than this in a frame is lost there, whatever the tracker
says."""


@dataclass(frozen=True)
class Errors:
    """One film, tracked."""

    elbow_mean: float
    """deg, mean absolute error of both elbows over the frames with a pose."""
    elbow_rms: float
    """deg."""
    joints_mean: float
    """mm, mean distance of joint centres."""
    joints_p95: float
    """mm."""
    frames_astray: int
    """Frames in which at least one limb is lost in truth."""
    frames_unsolved: int
    overlap: float
    """Mean over frames and cameras."""
    frames_per_s: float
    """Without decoding or rendering, start and fitting of the shape."""


def errors_of(tracked: TrackedMotion, film: Film) -> Errors:
    """Return the errors of a tracked film."""
    truth = film.motion
    at = {name: i for i, name in enumerate(truth.surface.limbs)}
    columns = [at[name] for name in tracked.limb_names[1:]]
    off = np.linalg.norm(tracked.origins[:, 1:] - truth.joint_centres[:, columns], axis=-1)
    solved = tracked.solved
    elbows = np.stack([angle_at(tracked, f"{s}_forearm") for s in ("left", "right")], axis=-1)
    error = np.degrees(elbows - film.elbow_angles)[solved]
    seconds = tracked.seconds.get("tracking", np.nan)
    return Errors(
        elbow_mean=float(np.abs(error).mean()),
        elbow_rms=float(np.sqrt((error**2).mean())),
        joints_mean=float(off[solved].mean() * 1e3),
        joints_p95=float(np.quantile(off[solved], 0.95) * 1e3),
        frames_astray=int((off[solved] > ASTRAY).any(axis=1).sum()),
        frames_unsolved=int((~solved).sum()),
        overlap=float(np.nanmean(tracked.overlap)),
        frames_per_s=tracked.n_frames / seconds,
    )


def angle_at(tracked: TrackedMotion, limb: str) -> Array:
    """Return the angle between a limb and its parent, (n_frames,) rad, from joint to joint."""
    i = tracked.limb_names.index(limb)
    parent = tracked.limb_parents[i]
    before = tracked.origins[:, i] - tracked.origins[:, parent]
    after = (tracked.rotations[:, i] @ tracked.ends[i][:, None])[..., 0]
    across = np.linalg.norm(np.cross(before, after), axis=-1)
    return np.asarray(np.arctan2(across, (before * after).sum(axis=-1)))
