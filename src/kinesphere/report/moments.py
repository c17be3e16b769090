"""Where to look: gaps, poses hard to believe, and the file's own events, on the time line."""

from collections.abc import Iterator
from dataclasses import dataclass
from operator import attrgetter

import numpy as np

from kinesphere.data import Mask, PoseFlag, Solution
from kinesphere.report.improbable import improbable_poses

MOST = 60
"""Moments listed; the time line shows all."""
APART_S = 0.1
"""s; stretches nearer than this are one."""


@dataclass(frozen=True)
class Moment:
    """A stretch of frames that deserves a look."""

    first: int
    """Frame, counted from the first stored one."""
    end: int
    """The frame after the last."""
    kind: str
    """``event``, ``gap``, ``pose`` or ``improbable``."""
    what: str
    about: tuple[str, int] | None = None
    """What the player picks: ``joint``, ``marker`` (its column) or ``limb``, and the index."""


def find_moments(solution: Solution) -> list[Moment]:
    """Return every moment worth a look, in the order of time.

    Gaps are those of markers that a limb wears.
    """
    found = [*_events(solution), *_gaps(solution), *_unseen(solution), *_improbable(solution)]
    return sorted(found, key=attrgetter("first", "end", "what"))


def most_telling(moments: list[Moment], most: int = MOST) -> list[Moment]:
    """Return events, then the longest of the other moments, as many as a person reads."""
    by_weight = sorted(moments, key=lambda m: (m.kind != "event", m.first - m.end))
    return sorted(by_weight[:most], key=attrgetter("first", "end", "what"))


@dataclass(frozen=True)
class MomentRow:
    """A moment as the page lists it."""

    when: str
    what: str
    lasts: str
    kind: str


def moment_rows(solution: Solution) -> tuple[list[MomentRow], int]:
    """Return the moments to list, in words, and how many more there are."""
    found = find_moments(solution)
    listed = most_telling(found)
    rate = solution.motion.rate
    rows = [
        MomentRow(
            f"{moment.first / rate:.2f} s",
            moment.what,
            "" if moment.kind == "event" else _frames(moment.end - moment.first),
            moment.kind,
        )
        for moment in listed
    ]
    return rows, len(found) - len(listed)


def _frames(n: int) -> str:
    return "1 frame" if n == 1 else f"{n:,} frames"


def runs(mask: Mask) -> list[list[int]]:
    """Return [first, end) of every stretch of True in a mask (n_frames,)."""
    edges = np.flatnonzero(np.diff(np.r_[False, np.asarray(mask, dtype=bool), False].astype(int)))
    return [[int(a), int(b)] for a, b in edges.reshape(-1, 2)]


def _joined(mask: Mask, apart: int) -> list[list[int]]:
    """Return the runs of a mask, those with fewer than ``apart`` frames between them as one."""
    joined: list[list[int]] = []
    for first, end in runs(mask):
        if joined and first - joined[-1][1] < apart:
            joined[-1][1] = end
        else:
            joined.append([first, end])
    return joined


def _apart(solution: Solution) -> int:
    return max(1, round(APART_S * solution.motion.rate))


def _events(solution: Solution) -> Iterator[Moment]:
    last = solution.motion.n_frames - 1
    for event in solution.recording.events:
        if not np.isfinite(event.time):
            continue
        frame = int(np.clip(round(event.time * solution.motion.rate), 0, last))
        name = " ".join(part for part in (event.context, event.label) if part)
        yield Moment(frame, frame + 1, "event", name or "event")


def _gaps(solution: Solution) -> Iterator[Moment]:
    recording = solution.recording
    for limb in solution.skeleton.limbs:
        for label in limb.markers:
            if label not in recording.labels:
                continue
            column = recording.labels.index(label)
            for first, end in _joined(~recording.seen[:, column], _apart(solution)):
                yield Moment(first, end, "gap", f"{label} unseen", ("marker", column))


def _unseen(solution: Solution) -> Iterator[Moment]:
    for i, limb in enumerate(solution.skeleton.limbs):
        hidden = np.asarray(solution.motion.flags[:, i] == PoseFlag.UNSEEN)
        for first, end in _joined(hidden, _apart(solution)):
            yield Moment(first, end, "pose", f"{_in_words(limb.name)} has no pose", ("limb", i))


def _improbable(solution: Solution) -> Iterator[Moment]:
    for what, where in improbable_poses(solution).items():
        for j, joint in enumerate(solution.skeleton.joints):
            for first, end in _joined(where[:, j], _apart(solution)):
                text = f"{_in_words(joint.name)} {what}"
                yield Moment(first, end, "improbable", text, ("joint", j))


def _in_words(name: str) -> str:
    return name.replace("_", " ")
