"""Tracks too short to tell bodies where all are broken: what they ride on, and what is missing."""

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Mask, Recording
from kinesphere.geometry.even_frames import even_frames
from kinesphere.skeleton.discovery.breaks import STATISTICS
from kinesphere.skeleton.discovery.joint_costs import Members
from kinesphere.skeleton.discovery.places import measure_places, riding
from kinesphere.skeleton.settings import SkeletonSettings

LASTING = 0.4
"""Share of what markers are usually seen in below which a track is left over."""
LOOKS = 12_000
"""Frames that are looked at, at most."""
WHOLE, HALF = 0.9, 0.5
"""Share of all that is seen which bodies show: from the first on nothing of names is doubted, at
the second nothing is left of their confidence."""


class Leftover(NamedTuple):
    """What becomes of tracks that tell no bodies."""

    rides: dict[int, int]
    """Column → body that it is rigid with."""
    astray: tuple[int, ...]
    """Columns that are rigid with no body, or with several."""
    shown: float = 1.0
    """Share of all that is seen which is on some body."""

    @property
    def trust(self) -> float:
        """0…1, what is left of the confidence in names: a limb may be among what is missing."""
        return float(np.clip((self.shown - HALF) / (WHOLE - HALF), 0, 1))

    def told(self) -> tuple[str, ...]:
        """Return what a person should be warned of."""
        if not self.rides and not self.astray:
            return ()
        return (
            f"{len(self.rides) + len(self.astray)} pieces of trajectories are too short to tell "
            f"bodies: {len(self.rides)} ride on one, {len(self.astray)} on none; bodies show "
            f"{self.shown:.0%} of what is seen",
        )


def left_over(seen: Mask) -> NDArray[np.bool_]:
    """Return which tracks are seen too little to tell bodies beside those of others, (n,).

    As many markers as are seen at once are there; half of these tracks at least show what is usual.

    Parameters
    ----------
    seen : (n_frames, n)
    """
    often = np.sort(seen.sum(axis=0))[::-1]
    at_once = int(np.percentile(seen.sum(axis=1), 99))
    usual = often[min(at_once // 2, len(often) - 1)]
    return np.asarray(seen.sum(axis=0) < LASTING * usual)


def settle(
    recording: Recording,
    columns: NDArray[np.intp],
    others: Collection[int],
    bodies: Sequence[Members],
    unit: float,
    limits: SkeletonSettings,
) -> Leftover:
    """Return what the rest of the trajectories rides on.

    Parameters
    ----------
    recording
        Pieces joined.
    columns
        Of the recording, of the markers that bodies are of.
    others
        Columns that are neither: copies, and pieces that were joined.
    bodies
        Of places in ``columns``.
    unit
        How many times larger the subject is than a person.
    limits
    """
    often = recording.seen.sum(axis=0)
    rest = np.setdiff1d(np.flatnonzero(often), [*columns, *others])
    if not len(rest):
        return Leftover({}, ())
    looks = min(LOOKS, max(2, round(recording.n_frames / recording.rate * STATISTICS)))
    frames = even_frames(recording.n_frames, looks)
    points = recording.markers[frames][:, np.concatenate([columns, rest])] / unit
    on = riding(measure_places(points, bodies, limits))[len(columns) :]
    rides = {int(m): int(b) for m, b in zip(rest, on, strict=True) if b >= 0}
    shown = np.concatenate([*(columns[members] for members in bodies), [*rides]]).astype(np.intp)
    total = often[[*columns, *rest]].sum()
    astray = tuple(int(m) for m in rest if int(m) not in rides)
    return Leftover(rides, astray, float(often[shown].sum() / total))
