"""Markers at the exact origin: missing ones that some exporters write as zero."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from kinesphere.data import Mask, Recording
from kinesphere.quality.findings import Finding
from kinesphere.quality.gaps import runs

AT_ZERO = "at-zero"
NEAR = 0.1
"""m from the origin, where a marker is just before or after a zero that it may have been at."""


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


def with_zeros_as_gaps(recording: Recording) -> tuple[Recording, tuple[Finding, ...]]:
    """Return the recording with what cannot have been measured at the origin as not seen.

    A span of zeros stays where the marker is within `NEAR` of the origin just before or after it:
    there it may have passed. Elsewhere, and throughout a marker's life, it is a gap.

    Returns
    -------
    Recording
        The same where there is nothing of the kind.
    tuple of Finding
        What was at the origin and is missing now, by marker, as `check_at_zero` tells it.
    """
    gone = _at_zero(recording)
    if not gone.any():
        return recording, ()
    markers = np.where(gone[..., None], np.nan, recording.markers)
    away = np.linalg.norm(markers, axis=2)
    for c, start, stop in zip(*runs(gone), strict=True):
        before, after = away[max(0, start - 1) : start, c], away[stop : stop + 1, c]
        if (np.concatenate([before, after]) < NEAR).any():
            gone[start:stop, c] = False
    if not gone.any():
        return recording, ()
    told = check_at_zero(
        replace(recording, markers=np.where(gone[..., None], recording.markers, np.nan))
    )
    kept = np.where(gone[..., None], np.nan, recording.markers)
    return replace(recording, markers=kept), tuple(told)


def _at_zero(recording: Recording) -> Mask:
    """Return which markers are at the exact origin, (n_frames, n_markers)."""
    zero: Mask = np.asarray(recording.markers[..., 0] == 0)
    columns = np.flatnonzero(zero.any(axis=0))  # few, if any
    zero[:, columns] &= (recording.markers[:, columns, 1:] == 0).all(axis=2)
    return zero
