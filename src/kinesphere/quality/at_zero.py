"""Markers at the exact origin: missing ones that some exporters write as zero."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from kinesphere.data import Mask, Recording
from kinesphere.quality.findings import Finding

AT_ZERO = "at-zero"


def check_at_zero(recording: Recording) -> Iterator[Finding]:
    """Find positions at the exact origin, of labelled and unlabelled trajectories.

    No marker is measured there to the last bit. The positions stay what they are: zero is data.
    """
    zero = _at_zero(recording)
    for c in np.flatnonzero(zero.any(axis=0)):
        n, first = int(zero[:, c].sum()), int(zero[:, c].argmax())
        yield Finding(
            AT_ZERO,
            "warning",
            f"{recording.labels[c]} is exactly at the origin in {n} frames, from frame "
            f"{recording.first_frame + first} on: likely missing, written as zero",
            "export missing markers as missing (residual -1 in C3D, blank in TRC)",
            markers=(recording.labels[c],),
            frame=recording.first_frame + first,
            numbers=(("frames", n), ("zero_share", round(n / recording.n_frames, 4))),
        )


def without_zeros(recording: Recording) -> Recording:
    """Return the recording with what is at the exact origin as not seen.

    A leap to zero and back is told as a zero, not once more as a jump, an exchange or a copy.
    """
    zero = _at_zero(recording)
    if not zero.any():
        return recording
    return replace(recording, markers=np.where(zero[..., None], np.nan, recording.markers))


def _at_zero(recording: Recording) -> Mask:
    """Return which markers are at the exact origin, (n_frames, n_markers)."""
    zero: Mask = np.asarray(recording.markers[..., 0] == 0)
    columns = np.flatnonzero(zero.any(axis=0))  # few, if any
    zero[:, columns] &= (recording.markers[:, columns, 1:] == 0).all(axis=2)
    return zero
