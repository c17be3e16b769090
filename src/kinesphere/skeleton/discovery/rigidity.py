"""How steady the distances between markers are: what rides on one body and what does not."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array
from kinesphere.errors import BadRecording, DegenerateMotion
from kinesphere.geometry.pair_distances import pair_distances
from kinesphere.skeleton.averages import median_seen

LEAST_FRAMES = 10
"""Frames that must show a marker, or two of them together, to say anything."""
UNSTEADY = 0.05
"""m, at a person's size: no skin lets neighbours on one limb drift so far apart."""
STILL = 3.0
"""Where no distance wanders so many times more than the steadiest ones do, nothing has moved."""
MOST_TRIMMED = 0.05
"""Share of a pair's frames that is left out at either end at most."""
RESOLVED = 1e-5
"""Share of the usual distance between two markers below which nothing is told apart: no optical
system does, and what is left of exactly rigid data is rounding error, of any pattern."""
ALL_ONE = 0.02
"""m: a thing whose every distance wanders less than its noise, and that itself travels this far
between frames of the sample, is one rigid body rather than a person who stands still."""


@dataclass(frozen=True, eq=False)
class Rigidity:
    """How markers wander relative to each other, over a sample of the frames."""

    points: Array
    """(n_sample, n, 3) m in the world; NaN where not seen."""
    mean: Array
    """(n, n) m."""
    wander: Array
    """(n, n) m, standard deviation of each distance, the outer frames at either end left out that a
    reflection may take up; NaN where two markers are hardly ever seen together."""
    noise: float
    """m, wander of the distance to a marker's steadiest neighbour, median over markers: what is
    steady in this recording. Never less than can be resolved."""

    def unlikeness(self, near: float) -> Array:
        """Return (n, n) m: wander, the larger the farther apart two markers are.

        Marker sets put what belongs to one body near to each other; ``near`` (m) is the distance at
        which that begins to matter.
        """
        return np.asarray(self.wander * np.sqrt(1 + (self.mean / near) ** 2))

    @property
    def is_one_body(self) -> bool:
        """Whether no distance wanders beyond what is steady: nothing here moves by itself."""
        return bool(np.isfinite(self.wander).all()) and self.most <= STILL * self.noise

    @property
    def most(self) -> float:
        """m, what the 5 % of distances that wander most exceed."""
        known = self.wander[np.triu_indices(len(self.wander), 1)]
        return float(np.percentile(known[np.isfinite(known)], 95))


def trimmed_share(seconds: float, ghost_s: float) -> float:
    """Return which share of the frames a reflection's life may be, 5 % at most.

    What a swap or a reflection does to a distance is left out at either end, and no more: one of
    many joints moves in a few seconds of a minute, and 5 % of that minute would hide its bend.
    """
    return min(MOST_TRIMMED, ghost_s / seconds) if seconds > 0 else MOST_TRIMMED


def measure_rigidity(points: Array, unit: float = 1.0, *, trim: float = MOST_TRIMMED) -> Rigidity:
    """Return how steady all distances are.

    Parameters
    ----------
    points : (n_sample, n, 3) m
        Markers that are seen, at a person's size; NaN where one is not.
    unit
        How many times larger the subject is; for messages.
    trim
        Share of a pair's frames left out at either end, see `trimmed_share`.

    Raises
    ------
    BadRecording
        If there are fewer than three markers or ten frames.
    DegenerateMotion
        If the markers hardly move relative to each other, nor as a whole, or none keep their
        distances.
    """
    n_frames, n = points.shape[:2]
    if n < 3 or n_frames < LEAST_FRAMES:
        raise BadRecording(
            f"{n} markers in {n_frames} frames; bodies are found from at least 3 markers in "
            f"{LEAST_FRAMES} frames"
        )
    found = pair_distances(points, trim=trim)
    wander = np.where(found.frames >= LEAST_FRAMES, found.trimmed_std, np.nan)
    finest = resolution(points, found.mean)
    wander = np.hypot(wander, finest * ~np.eye(n, dtype=bool))
    alone = wander + np.diag(np.full(n, np.inf))
    steadiest = np.nanmin(np.where(np.isfinite(alone), alone, np.inf), axis=1)
    steady = steadiest[np.isfinite(steadiest)]
    if not len(steady):
        raise BadRecording("no two markers are ever seen together in ten frames")
    rigidity = Rigidity(points, found.mean, wander, float(np.median(steady)))
    _check_motion(rigidity, unit)
    return rigidity


def resolution(points: Array, mean: Array) -> float:
    """Return how small a wander means nothing, m.

    A share of the usual distance between two markers, or a step of single precision, which files
    hold coordinates in, where the world's origin is that far away.

    Parameters
    ----------
    points : (n_sample, n, 3) m
    mean : (n, n) m
        Mean distances, NaN where unknown.
    """
    usual = float(median_seen(mean[np.triu_indices(len(mean), 1)]))
    away = float(median_seen(np.abs(points).max(axis=2).ravel()))
    return float(np.nanmax([RESOLVED * usual, np.finfo(np.float32).eps * away]))


def _check_motion(rigidity: Rigidity, unit: float) -> None:
    way = travels(rigidity.points)
    if way <= STILL * rigidity.noise and rigidity.noise > UNSTEADY:
        raise DegenerateMotion(
            "no markers keep their distances (they wander by "
            f"{rigidity.most * unit * 1e3:.1f} mm, by {rigidity.noise * unit * 1e3:.1f} mm even "
            "between the steadiest neighbours): nothing rides on one body; look for markers that "
            "change places, and for missing ones written as positions"
        )
    if way <= STILL * rigidity.noise or (rigidity.is_one_body and way < ALL_ONE):
        raise DegenerateMotion(
            "the markers hardly move relative to each other (distances wander by "
            f"{rigidity.most * unit * 1e3:.1f} mm, {rigidity.noise * unit * 1e3:.1f} mm within "
            "bodies): nothing tells one body from another; record a motion of every joint, or give "
            "a model"
        )


def travels(points: Array) -> float:
    """Return how far the markers travel, rms about each one's mean, (n_frames, n, 3) m → m."""
    with np.errstate(invalid="ignore"):
        off = points - np.nanmean(points, axis=0)
    square = (off**2).sum(axis=2)
    return float(np.sqrt(np.nanmean(square)))
