"""A joint's motion as samples on its joint sphere (paper section 4), and their smoothing."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, sosfiltfilt
from scipy.spatial.transform import Rotation

from kinesphere.data import Array, Mask
from kinesphere.geometry.rotations import rotation_angle

Frames = NDArray[np.intp]
Phase = tuple[int, int]
"""First frame and the frame after the last of a run."""


@dataclass(frozen=True, eq=False)
class JointSamples:
    """What the axis methods work on: one joint, seen from its parent."""

    rotations: Array
    """(n_frames, 3, 3) ``parent_from_child``."""
    positions: Array
    """(n_frames, 3) unit vectors, the child's long axis in the parent frame."""
    phases: tuple[Phase, ...]
    """Runs of frames in which the limb moves, every frame of them seen."""
    rate: float
    """Hz."""
    long_axis: Array
    """(3,) unit vector in the child."""
    frames: Frames | None = None
    """(n_frames,) which frames of the recording these are; None for its first ones in a row."""
    measured: Array | None = None
    """(n_frames, 3, 3) the rotations before they were smoothed; None where nobody did."""

    @property
    def phase_times(self) -> tuple[tuple[float, float], ...]:
        """Start and end in s of each phase, on the recording's clock."""
        at = np.arange(len(self.rotations)) if self.frames is None else self.frames
        return tuple(
            (float(at[a] / self.rate), float((at[b - 1] + 1) / self.rate)) for a, b in self.phases
        )

    def with_phases(self, phases: tuple[Phase, ...]) -> "JointSamples":
        """Return the same samples with other movement phases."""
        return replace(self, phases=phases)


def runs(mask: Mask) -> tuple[Phase, ...]:
    """Return the runs of True, (n_frames,) → ((start, stop), …)."""
    edges = np.diff(np.concatenate([[False], mask, [False]]).astype(np.int8))
    starts, stops = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    return tuple((int(a), int(b)) for a, b in zip(starts, stops, strict=True))


SPIKE = np.deg2rad(700.0)  # rad/s there and back within a frame: no limb does that
SPIKE_RATIO = 5.0  # times the step from the frame before to the frame after


def without_spikes(rotations: Array, rate: float) -> Array:
    """Return rotations, (n, 3, 3), with single frames that jump away and back taken as before.

    A swapped or misplaced marker makes such frames; a low-pass would smear them over a movement's
    length. Only what axes are found from is mended so, never the delivered angles.
    """
    if len(rotations) < 3:
        return rotations
    before = rotation_angle(np.swapaxes(rotations[:-1], -1, -2) @ rotations[1:])
    across = rotation_angle(np.swapaxes(rotations[:-2], -1, -2) @ rotations[2:])
    away, back = before[:-1], before[1:]
    with np.errstate(invalid="ignore"):
        spike = np.minimum(away, back) > np.maximum(SPIKE / rate, SPIKE_RATIO * across)
    mended = rotations.copy()
    at = np.flatnonzero(spike) + 1
    mended[at] = rotations[at - 1]
    return mended


def smooth_rotations(rotations: Array, rate: float, cutoff: float) -> Array:
    """Low-pass rotations with a second-order Butterworth filter run both ways (zero phase).

    Frames that jump away and back are mended first, see `without_spikes`.
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
    rotations = without_spikes(rotations, rate)
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
