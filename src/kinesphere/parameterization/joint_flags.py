"""What is flagged of a joint in each frame."""

import numpy as np

from kinesphere.data import Codes, JointFlag, Mask, Motion, PoseFlag
from kinesphere.geometry.poses import place
from kinesphere.geometry.vectors import lengths
from kinesphere.parameterization.angles import JointAngles
from kinesphere.parameterization.joint_fit import JointFit
from kinesphere.parameterization.settings import ParameterizationSettings

TORN = 0.02  # m, joints closer together than this are never called dislocated
OUTLYING = 6.0  # robust standard deviations
LEAP = np.pi / 2  # rad between frames; the other branch is about half a turn of twist away


def twists_known(flags: Codes) -> Mask:
    """Return where something tells a limb's twist, PoseFlag (n_frames, n_limbs) → bool.

    A filled pose has its twist from the poses before and behind it: where either of these is a
    guess, it is one, too.
    """
    guessed = flags == PoseFlag.TWIST_UNKNOWN
    filled = flags == PoseFlag.FILLED
    frames = np.arange(len(flags))[:, None]
    before = np.maximum.accumulate(np.where(filled, -1, frames), axis=0)
    behind = np.where(filled, len(flags), frames)
    behind = np.minimum.accumulate(behind[::-1], axis=0)[::-1]
    for ends in (before, behind):
        held = np.take_along_axis(guessed, np.clip(ends, 0, max(len(flags) - 1, 0)), axis=0)
        guessed = guessed | (filled & held)
    return np.asarray(~guessed)


def flags_of(
    motion: Motion,
    j: int,
    solved: JointAngles,
    fit: JointFit,
    twist_known: Mask,
    settings: ParameterizationSettings,
) -> Codes:
    """Return the JointFlags of joint ``j``, (n_frames,) uint8; ``twist_known`` of its child."""
    unseen = np.isnan(solved.angles[:, len(fit.axes) - 1])
    flags = np.where(unseen, JointFlag.UNSEEN, 0)
    with np.errstate(invalid="ignore"):
        far = solved.excess > np.deg2rad(settings.angles.unreachable)
        edge = solved.sines < np.sin(np.deg2rad(settings.angles.singular))
    flags |= np.where(far, JointFlag.UNREACHABLE, 0)
    if len(fit.axes) > 1:
        flags |= np.where(edge | leaps(solved), JointFlag.SINGULAR, 0)
    parent, child = motion.flags[:, motion.skeleton.parents[j + 1]], motion.flags[:, j + 1]
    filled = (parent == PoseFlag.FILLED) | (child == PoseFlag.FILLED)
    flags |= np.where(~unseen & ~twist_known, JointFlag.TWIST_UNKNOWN, 0)
    flags |= np.where(~unseen & filled, JointFlag.FILLED, 0)
    flags |= np.where(_torn(motion, j), JointFlag.DISLOCATED, 0)
    return flags.astype(np.uint8)


def leaps(solved: JointAngles) -> Mask:
    """Return the frames on both sides of a leap of an angle, (n_frames,).

    Only near a singular pose can angles leap while the limb does not: the solution passes to its
    other branch, between two frames if the motion is fast.
    """
    leap: Mask = np.zeros(max(0, len(solved.twists) - 1), dtype=bool)
    with np.errstate(invalid="ignore"):
        for angles in (*solved.angles.T, solved.twists):
            turned = np.diff(angles)
            turned -= 2 * np.pi * np.rint(turned / (2 * np.pi))
            leap |= np.abs(turned) > LEAP
    beside: Mask = np.zeros(len(solved.twists), dtype=bool)
    beside[:-1] |= leap
    beside[1:] |= leap
    return beside


def _torn(motion: Motion, j: int) -> Mask:
    """Return where parent and child disagree about the joint far more than usual, (n_frames,)."""
    joint, parent = motion.skeleton.joints[j], motion.skeleton.parents[j + 1]
    by_parent, by_child = (
        place(motion.rotations[:, limb], motion.origins[:, limb], centre)
        for limb, centre in ((parent, joint.centre_in_parent), (j + 1, joint.centre_in_child))
    )
    apart = lengths(by_parent - by_child)
    known: Mask = np.isfinite(apart)
    if not known.any():
        return known
    usual = float(np.median(apart[known]))
    spread = 1.4826 * float(np.median(np.abs(apart[known] - usual)))
    with np.errstate(invalid="ignore"):
        return np.asarray(apart > usual + max(OUTLYING * spread, TORN))
