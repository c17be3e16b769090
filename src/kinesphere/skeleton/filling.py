"""Hidden markers, put where their limb's pose says they are."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from kinesphere import __version__
from kinesphere.data import Codes, Limb, Motion, PoseFlag, Recording, Step

OWN = (PoseFlag.MEASURED, PoseFlag.JOINT_AIDED)
"""Poses that what is seen of the limb determines."""


def hidden_samples(recording: Recording, limbs: Sequence[Limb], flags: Codes) -> tuple[int, int]:
    """Return how many samples of limbs' markers are hidden while the limb has a pose, and of all.

    Parameters
    ----------
    recording
        The one that limbs were posed on.
    limbs
    flags : (n_frames, n_limbs)
        PoseFlag of each limb's pose.
    """
    hidden = 0
    for limb, column in zip(limbs, flags.T, strict=True):
        place = np.isfinite(limb.marker_positions).all(axis=1)
        seen = recording.seen[:, recording.columns(limb.markers)]
        hidden += int((~seen & place & (column != PoseFlag.UNSEEN)[:, None]).sum())
    return hidden, recording.n_frames * sum(len(limb.markers) for limb in limbs)


def fill_markers(recording: Recording, motion: Motion) -> Recording:
    """Return the recording with the gaps of limbs' markers filled from the limbs' poses.

    Only markers that limbs own are filled, and only where the limb has a pose; the twist of poses
    that are guesses does not spoil what is seen. Residuals of filled samples are NaN.

    Parameters
    ----------
    recording
        The one that the motion was measured on.
    motion
    """
    markers = np.array(recording.markers)
    at = {label: column for column, label in enumerate(recording.labels)}
    counts: dict[str, int] = {}
    guessed = 0
    for i, limb in enumerate(motion.skeleton.limbs):
        own = np.isin(motion.flags[:, i], OWN)
        for label, place in zip(limb.markers, limb.marker_positions, strict=True):
            hidden = ~recording.seen[:, at[label]] & motion.seen[:, i]
            if not hidden.any() or not np.isfinite(place).all():
                continue
            markers[hidden, at[label]] = (
                motion.rotations[hidden, i] @ place + motion.origins[hidden, i]
            )
            counts[label] = int(hidden.sum())
            guessed += int((hidden & ~own).sum())
    filled = sum(counts.values())
    step = Step(
        "filling",
        findings={
            "filled_samples": filled,
            "without_the_limbs_own_pose": guessed,
            "still_missing": int(np.isnan(markers[..., 0]).sum()),
            "by_marker": {label: {"filled_frames": n} for label, n in counts.items()},
        },
        warnings=(
            (
                f"{guessed} of {filled} filled marker samples rest on a pose that was bridged or "
                "spanned between joints, not on what is seen of the limb",
            )
            if guessed
            else ()
        ),
        version=__version__,
    )
    return replace(recording, markers=markers, history=(*recording.history, step))
