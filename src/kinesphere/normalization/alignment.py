"""The turn of each limb's old frame onto its normalized one, from the mean default pose."""

from dataclasses import dataclass, field

import numpy as np

from kinesphere.data import Array, Codes, Mask, PoseFlag
from kinesphere.normalization.anatomy import CANONICAL, Anatomy, without_side
from kinesphere.normalization.averaging import robust_mean_rotations
from kinesphere.normalization.feet import Foot, feet_of
from kinesphere.normalization.limb_frames import canonical_direction, minimal_frame, paper_frame
from kinesphere.normalization.samples import Samples
from kinesphere.normalization.soles import stands
from kinesphere.normalization.vectors import angle_between

_NEAR = np.deg2rad(5.0)  # postures this much farther from the ideal than the best still count
_MOST = 50  # frames averaged for a limb that the default position does not show


@dataclass(eq=False)
class Alignment:
    """How every limb's old frame turns onto its new one."""

    turns: Array
    """(n_limbs, 3, 3) ``old_from_new``."""
    along: Array
    """(n_limbs, 3) long axes in the new frames."""
    shifts: Array
    """(n_limbs, 3) m, the middles of the limbs in the old frames: the new origins."""
    lengths: Array
    """(n_limbs,) m from end to end; NaN where unknown."""
    off_ideal: dict[str, float] = field(default_factory=dict)
    """Limb → rad between where it points in the mean default pose and in the ideal one."""
    elsewhere: list[str] = field(default_factory=list)
    """Limbs that the default position does not show, or not their twist; aligned with their parent
    in the frames that do."""
    twistless: list[str] = field(default_factory=list)
    """Limbs whose twist no frame tells."""
    feet: dict[str, Foot] = field(default_factory=dict)
    """What tells where each foot points."""
    never: list[str] = field(default_factory=list)
    """Limbs that could not be aligned; they keep their frame."""


def align_limbs(samples: Samples, bodies: Array, chosen: Mask, rule: str) -> Alignment:
    """Find every limb's turn.

    The limb's orientation in the body frame is averaged over the chosen samples, robustly; the
    rule for its frame is then applied once, to that mean pose.

    Parameters
    ----------
    samples
    bodies : (n, 3, 3)
        ``world_from_body``; only those of chosen samples are read.
    chosen : (n,)
        Which samples show the default position.
    rule
        ``minimal`` or ``paper``.
    """
    anatomy = samples.anatomy
    n_limbs = len(anatomy.skeleton.limbs)
    found = Alignment(
        turns=np.tile(np.eye(3), (n_limbs, 1, 1)),
        along=np.array([limb.long_axis for limb in anatomy.skeleton.limbs]),
        shifts=np.zeros((n_limbs, 3)),
        lengths=np.linalg.norm(anatomy.distal_ends - anatomy.proximal_ends, axis=1),
    )
    bodies, limbs = bodies[chosen], samples.rotations[chosen]
    sure = twist_told(samples.motion.flags)
    told = sure[samples.frames[chosen]][..., None, None]
    means = _mean_poses(bodies[:, None], np.where(told, limbs, np.nan))
    feet: dict[int, Array] = {}
    for limb, name in enumerate(anatomy.skeleton.limb_names):
        base_from_limb = _known(means[limb])
        if base_from_limb is None and limb > 0:
            base_from_limb = _pose_at_parent(samples, limb, found.turns, sure[:, limb])
            if base_from_limb is not None:
                found.elsewhere.append(name)
        if base_from_limb is None:
            base_from_limb = _known(_mean_poses(bodies[:, None], limbs[:, limb, None])[0])
            if base_from_limb is not None:
                found.twistless.append(name)
        if base_from_limb is None:
            found.never.append(name)
            continue
        points = base_from_limb @ anatomy.directions[limb]
        base_from_new, found.along[limb], off = _frame(anatomy, limb, points, rule)
        found.turns[limb] = base_from_limb.T @ base_from_new
        found.shifts[limb] = np.nan_to_num(anatomy.mid_point(limb))
        found.off_ideal[name] = off
        if _is_foot(samples, limb, base_from_limb):
            feet[limb] = base_from_limb
    for limb, foot in feet_of(samples, feet).items():
        name = anatomy.skeleton.limb_names[limb]
        base_from_new, found.along[limb], off = _frame(anatomy, limb, foot.points, rule)
        found.turns[limb] = feet[limb].T @ base_from_new
        found.off_ideal[name], found.feet[name] = off, foot
        if foot.lender or foot.backward:
            half = foot.length / 2 * feet[limb].T @ foot.points
            found.lengths[limb], found.shifts[limb] = (
                foot.length,
                anatomy.proximal_ends[limb] + half,
            )
    return found


def twist_told(flags: Codes) -> Mask:
    """Return where a limb's twist is more than a guess, (n_frames, n_limbs) of PoseFlag → bool.

    A filled pose of a limb whose twist is a guess in other frames is one, too.
    """
    guessed = flags == PoseFlag.TWIST_UNKNOWN
    filled = flags == PoseFlag.FILLED
    unseen = flags == PoseFlag.UNSEEN
    return np.asarray(~(guessed | unseen | (filled & guessed.any(axis=0))))


def _frame(anatomy: Anatomy, limb: int, points: Array, rule: str) -> tuple[Array, Array, float]:
    """Return a limb's new frame and long axis, and how far it points from the ideal, rad.

    ``points``: (3,) along its line, in the body frame.
    """
    if not np.isfinite(points).all():  # pelvis and trunk, or a root, or a limb with no extent
        return np.eye(3), np.array([0.0, 1.0, 0.0]), 0.0
    name, at_end = anatomy.skeleton.limb_names[limb], not anatomy.distal_joints[limb]
    ideal = canonical_direction(name, points, at_end=at_end)
    off = float(angle_between(ideal, points))
    if rule == "paper":
        return *paper_frame(points), off
    return minimal_frame(points, ideal), ideal, off


def _is_foot(samples: Samples, limb: int, base_from_limb: Array) -> bool:
    """Return whether a limb ends a chain as a foot: by its name, or as the body stands on it.

    Of a nameless limb that ideally points forward; an arm or a tail may do that, too.
    """
    anatomy = samples.anatomy
    line, at_end = anatomy.directions[limb], not anatomy.distal_joints[limb]
    if not at_end or not np.isfinite(line).all():
        return False
    name = anatomy.skeleton.limb_names[limb]
    ahead = canonical_direction(name, base_from_limb @ line, at_end=at_end)[0] == 1.0
    return bool(ahead and (without_side(name) in CANONICAL or stands(samples, limb)))


def _mean_poses(bases: Array, rotations: Array) -> Array:
    """Return the mean ``base_from_limb``, (n, n_limbs, 3, 3) → (n_limbs, 3, 3), NaN left out."""
    return robust_mean_rotations(np.swapaxes(bases, -1, -2) @ rotations)


def _known(rotation: Array) -> Array | None:
    return rotation if np.isfinite(rotation).all() else None


def _pose_at_parent(samples: Samples, limb: int, turns: Array, sure: Mask) -> Array | None:
    """Return a limb's mean pose in its parent's new frame, where the default pose shows too little.

    Over the frames of the whole recording in which the limb points most nearly as it should; None
    where limb and parent are never seen together with the limb's twist.
    """
    anatomy, motion = samples.anatomy, samples.motion
    parent = int(anatomy.skeleton.parents[limb])
    rotations = motion.rotations[:, [parent, limb]]
    usable = sure & np.isfinite(rotations).all(axis=(1, 2, 3))
    if not usable.any():
        return None
    parents, limbs = rotations[usable, 0] @ turns[parent], rotations[usable, 1]
    points = (np.swapaxes(parents, -1, -2) @ limbs) @ np.nan_to_num(anatomy.directions[limb])
    ideal = canonical_direction(
        anatomy.skeleton.limb_names[limb],
        points.mean(axis=0),
        at_end=not anatomy.distal_joints[limb],
    )
    off = angle_between(points, ideal)
    near = np.argsort(off, kind="stable")[:_MOST]
    near = near[off[near] <= off[near[0]] + _NEAR]
    return _known(_mean_poses(parents[near, None], limbs[near, None])[0])
