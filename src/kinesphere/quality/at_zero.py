"""Markers at the exact origin: missing ones that some exporters write as zero."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from kinesphere.data import Mask, Recording
from kinesphere.quality.extent import usual_extent
from kinesphere.quality.findings import Finding

AT_ZERO = "at-zero"
NEAR = 0.2
"""Share of the markers' extent from the origin within which a marker may be about to pass it: 0.08
to 0.13 m of people, 0.01 m of a hand."""


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

    A zero stays only where the marker may have passed the origin: it is there in one frame of the
    recording, no other marker is there with it, and in the frames beside it, as far as they show
    it, it is within `NEAR` of the origin. Nothing is measured there to the last bit twice.

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
    once = gone & (gone.sum(axis=0) == 1) & (gone.sum(axis=1, keepdims=True) == 1)
    if once.any():
        near = NEAR * usual_extent(markers)
        for frame, c in np.argwhere(once):
            away = np.linalg.norm(markers[max(0, frame - 1) : frame + 2, c], axis=1)
            away = away[np.isfinite(away)]
            if len(away) and (away < near).all():
                gone[frame, c] = False
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
