"""A joint's motion as samples on its joint sphere (paper section 4), and their smoothing."""

from dataclasses import dataclass, replace
from functools import lru_cache

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, sosfilt_zi, sosfiltfilt
from scipy.spatial.transform import Rotation

from kinesphere.data import Array, Mask
from kinesphere.geometry.rotations import (
    nearest_rotation,
    quaternions_from_rotations,
    rotation_angle,
)
from kinesphere.kernels.low_pass import both_ways_kernel

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
    starts, stops = run_ends(mask)
    return tuple(zip(starts.tolist(), stops.tolist(), strict=True))


def run_ends(mask: Mask) -> tuple[Frames, Frames]:
    """Return where runs of True start and stop, (n_frames,) → (n_runs,) twice."""
    edges = np.flatnonzero(np.diff(mask, prepend=False, append=False))
    return edges[::2], edges[1::2]


def mask_from_runs(starts: Frames, stops: Frames, n_frames: int) -> Mask:
    """Return the mask, (n_frames,), that is True in runs; those that stop at their start count not.

    The inverse of `run_ends`.
    """
    ends = np.zeros(n_frames + 1, dtype=np.intp)
    some = stops > starts
    np.add.at(ends, starts[some], 1)
    np.add.at(ends, stops[some], -1)
    return np.asarray(np.cumsum(ends[:-1]) > 0)


SPIKE = np.deg2rad(700.0)  # rad/s there and back within a frame: no limb does that
SPIKE_RATIO = 5.0  # times the step from the frame before to the frame after


def without_spikes(rotations: Array, rate: float) -> Array:
    """Return rotations, (n, 3, 3), with single frames that jump away and back taken out.

    Each is replaced by the middle of the frames before and after.

    A swapped or misplaced marker makes such frames; a low-pass would smear them over a movement's
    length. Only what axes are found from is mended so, never the delivered angles.
    """
    if len(rotations) < 3:
        return rotations
    # the cosines alone tell nearly all frames from spikes
    traces = np.einsum("nij,nij->n", rotations[:-1], rotations[1:])
    fast = traces < 1 + 2 * np.cos(min(SPIKE / rate, np.pi)) + 1e-9  # False where NaN
    at = np.flatnonzero(fast[:-1] & fast[1:]) + 1
    if len(at) == 0:
        return rotations
    before, here, after = rotations[at - 1], rotations[at], rotations[at + 1]
    steps = [(before, here), (here, after), (before, after)]
    away, back, across = (rotation_angle(np.swapaxes(a, -1, -2) @ b) for a, b in steps)
    with np.errstate(invalid="ignore"):
        at = at[np.minimum(away, back) > np.maximum(SPIKE / rate, SPIKE_RATIO * across)]
    mended = rotations.copy()
    mended[at] = nearest_rotation(rotations[at - 1] + rotations[at + 1])
    return mended


def smooth_rotations(rotations: Array, rate: float, cutoff: float) -> Array:
    """Low-pass rotations with a second-order Butterworth filter run both ways (zero phase).

    Once forward first and once backward first, and the mean of both: at the ends they differ.

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
    sos, steady = _low_pass(rate, cutoff)
    rotations = without_spikes(rotations, rate)
    smooth = rotations.copy()
    for start, stop in runs(np.isfinite(rotations.reshape(-1, 9) @ np.ones(9))):
        if stop - start < 4:
            continue
        q = quaternions_from_rotations(rotations[start:stop])
        _align_signs(q)
        padding = min(stop - start - 1, int(np.ceil(rate / cutoff)))
        there, back = (_both_ways(sos, steady, x, padding) for x in (q, q[::-1].copy()))
        smooth[start:stop] = Rotation.from_quat(there + back[::-1]).as_matrix()
    return smooth


def _align_signs(quaternions: Array) -> None:
    """Give every quaternion, (n, 4), the sign that is nearer to the one before it, in place."""
    products = np.einsum("ni,ni->n", quaternions[1:], quaternions[:-1])
    quaternions[1:] *= np.cumprod(np.where(products < 0, -1.0, 1.0))[:, None]


def _both_ways(sos: Array, steady: Array, values: Array, padding: int) -> Array:
    """Return values, (n, 4), filtered forward and then backward."""
    if getattr(numba.config, "DISABLE_JIT", False):  # uncompiled, the kernel takes very long
        return np.asarray(sosfiltfilt(sos, values, axis=0, padlen=padding))
    return both_ways_kernel(sos[0], steady, values, padding)


@lru_cache
def _low_pass(rate: float, cutoff: float) -> tuple[Array, Array]:
    """Return the coefficients of a Butterworth filter, (1, 6), and its steady state, (2,)."""
    sos = butter(2, cutoff, fs=rate, output="sos")
    return sos, sosfilt_zi(sos)[0]
