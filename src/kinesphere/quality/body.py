"""Where head, feet, front and back are, by what markers are commonly called.

A model names its segments; without one, or where it names none of them, the customary labels of
gait and animation layouts (Plug-in-Gait, CMU, Qualisys, OpenSim, OpenPose) serve as well: to tell
up from down and left from right it does not matter exactly where a marker sits.
"""

import re
from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np

from kinesphere.data import Array, Recording, TopologicalModel
from kinesphere.geometry.even_frames import every_nth
from kinesphere.geometry.lifetimes import GHOST, worth_grouping
from kinesphere.geometry.vectors import is_seen, lengths

HEAD = (
    *("FHD", "BHD", "HD", "HEAD", "ARIEL", "HDF", "HDB"),
    *("TEMP", "TEMPLE", "TOP.HEAD", "NOSE", "VERTEX"),
)
SHOULDERS = (
    *("SHO", "SHOULDER", "FSH", "BSH", "ACR", "AC", "ACROMION", "ACROMIUM"),
    *("C7", "CV7", "CLAV", "CLA", "STERNUM", "NECK"),
)
WAIST_FRONT = ("ASI", "ASIS", "IAS", "FWT")
WAIST_BACK = ("PSI", "PSIS", "IPS", "BWT", "SACR", "VSAC")
HIPS = ("HIP", "HJC")
TOES = ("TOE", "TOE5", "MT1", "MT2", "MT5", "FM1", "FM5", "FTF", "BIGTOE", "SMALLTOE", "TOE.TIP")
HEELS = ("HEE", "HEEL", "HEL", "FCC", "CAL", "FTB")
ANKLES = ("ANK", "ANKLE", "FAL", "ANL", "LMAL")
KNEES = ("KNE", "KNEE", "FLE", "LFC")

ENOUGH_FRAMES = 6000
"""Frames, evenly spread, that tell which way is up, how tall and which way round a body is."""

_SIDED = re.compile(r"(?:(?P<side>[LR])(?:EFT|IGHT)?[_. ]?)?(?P<core>.*)", re.DOTALL)


class LongAxes(NamedTuple):
    """Which way bodies stand."""

    towards_head: Array
    """(n, 3) unit vectors from the feet to the head, one per person and frame seen."""
    below: str
    """What they begin at, in words: ``feet``, or what stands in for them."""


class Body:
    """One person's markers, found by their customary names."""

    def __init__(self, recording: Recording, columns: Mapping[str, int]) -> None:
        """Take the markers at ``columns`` (name without subject, any case → column)."""
        self.markers = recording.markers
        self._columns: dict[str, list[int]] = {}
        sides: dict[str, dict[str, int]] = {"L": {}, "R": {}}
        for name, column in columns.items():
            whole = name.upper()
            match = _SIDED.fullmatch(whole)
            assert match is not None  # every string is a core with no side
            side, core = match["side"] or "", match["core"]
            for spelling in {whole, core, side + core}:
                self._columns.setdefault(spelling, []).append(column)
            if side:
                sides[side].setdefault(core, column)
        left, right = sides["L"], sides["R"]
        self.pairs = {core: (left[core], right[core]) for core in left if core in right}
        """Name without side → columns of the left and the right marker, where both are there."""

    def middle(self, *names: str) -> Array | None:
        """Return the middle of the markers of these names that are seen, (n_frames, 3) m.

        A name without a side (``TOE``) means both. None if there is no such marker; NaN in frames
        where none of them is seen.
        """
        columns = sorted({c for name in names for c in self._columns.get(name, ())})
        return mean_seen(self.markers[:, columns]) if columns else None

    def side(self, side: str, names: Iterable[str]) -> Array | None:
        """Return the middle of one side's markers, ``L`` or ``R``, as ``middle`` does."""
        return self.middle(*(side + name for name in names))

    def columns(self, side: str, names: Iterable[str]) -> list[int]:
        """Return the columns of one side's markers of these names, in the order of the names."""
        found = (c for name in names for c in self._columns.get(side + name, ()))
        return list(dict.fromkeys(found))

    def rightwards(self, names: Iterable[str]) -> Array | None:
        """Return what points from the left side's markers to the right side's, (n_frames, 3) m."""
        left, right = (self.side(side, names) for side in "LR")
        return None if left is None or right is None else right - left


def thinned(recording: Recording, most: int) -> Recording:
    """Return frames spread evenly, about ``most``: markers and labels alone, at a lower rate.

    What holds of most of a long recording shows in some thousand of its frames.
    """
    step = -(-recording.n_frames // most)
    if step <= 1:
        return recording
    frames = every_nth(recording.n_frames, step)
    rate = recording.rate * len(frames) / recording.n_frames
    return Recording(recording.markers[frames], recording.labels, rate)


def find_bodies(recording: Recording) -> tuple[Body, ...]:
    """Return one body for every subject that the labels name, at least one."""
    people: dict[str, dict[str, int]] = {}
    for column, label in enumerate(recording.labels):
        subject, _, name = label.rpartition(":")
        people.setdefault(subject, {}).setdefault(name.strip(), column)
    return tuple(Body(recording, columns) for columns in people.values())


def find_long_axes(
    recording: Recording, model: TopologicalModel | None, bodies: Iterable[Body]
) -> LongAxes:
    """Return which way bodies stand, one vector per person and frame seen.

    Feet and head are the model's segments of that name where the recording has their markers, else
    what the customary labels say; shoulders, then waist stand in for a head without markers, shanks
    or knees for feet without.
    """
    found = [] if model is None else [_segments_axis(recording, model)]
    if not any(way is not None for way in found):
        found = [_named_axis(body) for body in bodies]
    ways = [way for way in found if way is not None]
    together: Array = np.concatenate([*(unit(way) for way, _ in ways), np.empty((0, 3))])
    below = tuple(dict.fromkeys(end for _, end in ways))
    return LongAxes(together[np.isfinite(together).all(axis=1)], " or ".join(below))


def _segments_axis(recording: Recording, model: TopologicalModel) -> tuple[Array, str] | None:
    owned = {s.name: [m for m in s.markers if m in recording.labels] for s in model.segments}
    upper = owned.get("head") or owned.get("trunk")
    for part, said in (("foot", "feet"), ("shank", "shanks")):
        lower = [m for side in ("left", "right") for m in owned.get(f"{side}_{part}", ())]
        if upper and lower:
            high, low = (
                mean_seen(recording.markers[:, recording.columns(tuple(end))])
                for end in (upper, lower)
            )
            return high - low, said
    return None


def _named_axis(body: Body) -> tuple[Array, str] | None:
    waist = (*WAIST_FRONT, *WAIST_BACK, *HIPS)
    ends = (body.middle(*names) for names in (HEAD, SHOULDERS, waist))
    upper = next((end for end in ends if end is not None), None)
    for names, said in (((*TOES, *HEELS, *ANKLES), "feet"), (KNEES, "knees")):
        lower = body.middle(*names)
        if upper is not None and lower is not None:
            return upper - lower, said
    return None


def labelled_columns(recording: Recording) -> list[int]:
    """Return the columns of all points that somebody labelled."""
    return [c for c, label in enumerate(recording.labels) if label.rpartition(":")[2][:1] != "*"]


def judged_columns(recording: Recording) -> list[int]:
    """Return the columns whose gaps matter: labelled ones; where there are none, long-lived ones.

    Without labels motion alone tells the bodies, from every marker that is no reflection.
    """
    return labelled_columns(recording) or lasting_columns(recording)


def lasting_columns(recording: Recording) -> list[int]:
    """Return the columns of all points, labelled or not, that live too long for a reflection."""
    return np.flatnonzero(worth_grouping(recording.seen, recording.rate, GHOST)).tolist()


def mean_seen(points: Array) -> Array:
    """Return the mean over markers of what is seen, (n_frames, n, 3) → (n_frames, 3)."""
    seen = is_seen(points)[..., None]
    with np.errstate(invalid="ignore"):
        return np.asarray(np.where(seen, points, 0.0).sum(axis=1) / seen.sum(axis=1))


def unit(vectors: Array) -> Array:
    """Return vectors divided by their length, (..., 3); NaN where that is zero."""
    with np.errstate(invalid="ignore"):
        return np.asarray(vectors / lengths(vectors)[..., None])
