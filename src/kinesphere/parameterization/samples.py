"""A joint's motion as samples on its joint sphere (paper section 4), and their smoothing."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.signal import butter, sosfiltfilt
from scipy.spatial.transform import Rotation

from kinesphere.data import Array, Mask

Phase = tuple[int, int]
"""First frame and the frame after the last of a run."""


@dataclass(frozen=True, eq=False)
class JointSamples:
    """What the axis methods work on: one joint, seen from its parent."""

    rotations: Array
    """(n_frames, 3, 3) ``parent_from_child``; NaN where unseen."""
    positions: Array
    """(n_frames, 3) unit vectors, the child's long axis in the parent frame."""
    phases: tuple[Phase, ...]
    """Runs of frames in which the limb moves, every frame of them seen."""
    rate: float
    """Hz."""
    long_axis: Array
    """(3,) unit vector in the child."""

    def with_phases(self, phases: tuple[Phase, ...]) -> "JointSamples":
        """Return the same samples with other movement phases."""
        return replace(self, phases=phases)


def runs(mask: Mask) -> tuple[Phase, ...]:
    """Return the runs of True, (n_frames,) → ((start, stop), …)."""
    edges = np.diff(np.concatenate([[False], mask, [False]]).astype(np.int8))
    starts, stops = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    return tuple((int(a), int(b)) for a, b in zip(starts, stops, strict=True))


def smooth_rotations(rotations: Array, rate: float, cutoff: float) -> Array:
    """Low-pass rotations with a second-order Butterworth filter run both ways (zero phase).

    Quaternions of one sign are filtered component by component and normalized, which agrees with
    filtering matrices and projecting them to third order in the angle within the filter's memory.

    Parameters
    ----------
    rotations : (n_frames, 3, 3)
        NaN where unseen; every run of seen frames is filtered by itself, runs of fewer than four
        frames are returned as they are.
    rate, cutoff
        Hz. A cutoff of 0, or one the rate cannot carry, filters nothing.

    Returns
    -------
    (n_frames, 3, 3)
    """
    if not 0 < cutoff < 0.45 * rate:
        return rotations
    sos = butter(2, cutoff, fs=rate, output="sos")
    smooth = rotations.copy()
    for start, stop in runs(np.asarray(np.isfinite(rotations).all(axis=(1, 2)))):
        if stop - start < 4:
            continue
        q = Rotation.from_matrix(rotations[start:stop]).as_quat()
        flips = np.where((q[1:] * q[:-1]).sum(axis=1) < 0, -1.0, 1.0)
        q[1:] *= np.cumprod(flips)[:, None]
        padding = min(stop - start - 1, int(np.ceil(rate / cutoff)))
        q = sosfiltfilt(sos, q, axis=0, padlen=padding)
        smooth[start:stop] = Rotation.from_quat(q).as_matrix()
    return smooth
