"""Whether the body is the right way round or its mirror image.

A left-handed export, or one negated axis, turns a person into their mirror image: seen from
outside, left and right, up and down, front and back no longer fit together. That does not depend
on which way is up in the file, nor on posture, if each triple is taken within one body part.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from kinesphere.data import Array
from kinesphere.quality import body as names
from kinesphere.quality.body import Body, unit
from kinesphere.quality.feet import exchanged_heel

DECISIVE = 0.2
"""Least |(up × left-to-right) · forward| of unit vectors that says anything: a part whose three
directions lie nearly in a plane may tip over by noise alone."""

ACROMIA = ("SHO", "SHOULDER", "FSH", "BSH", "ACR")


@dataclass(frozen=True)
class Chirality:
    """How often body parts are the right way round; shares of what was decisive."""

    right: float
    """Share of part-frames with up × (left to right) · forward > 0, as in a right-handed world."""
    n: int
    """Number of part-frames that decide; 0: nothing known."""


class _Part(NamedTuple):
    """Two points along each of the three directions of one body part, (n_frames, 3) m each."""

    bottom: Array | None
    top: Array | None
    left: Array | None
    right: Array | None
    back: Array | None
    front: Array | None


def find_chirality(bodies: Iterable[Body]) -> Chirality:
    """Return how the trunk, the pelvis and the feet of every body and frame are turned."""
    volumes = [v for body in bodies for part in _parts(body) if (v := _volume(part)) is not None]
    together: Array = np.concatenate([*volumes, np.empty(0)])
    decisive = together[np.abs(together) > DECISIVE]  # NaN compares as False
    right = float(np.mean(decisive > 0)) if len(decisive) else float("nan")
    return Chirality(right, len(decisive))


def contradicted_girdles(body: Body) -> set[str]:
    """Return which of ``shoulders`` and ``pelvis`` have left and right the wrong way round.

    As up and front of their own part have it, or of the feet for the pelvis, in most of what is
    decisive; either or both may be in a mirror image.
    """
    trunk, *rest = map(_volume, _parts(body))
    wrong = set()
    for name, volumes in (("shoulders", [trunk]), ("pelvis", rest)):
        together = np.concatenate([*(v for v in volumes if v is not None), np.empty(0)])
        decisive = together[np.abs(together) > DECISIVE]
        if len(decisive) and np.mean(decisive > 0) < 0.5:
            wrong.add(name)
    return wrong


def _parts(body: Body) -> list[_Part]:
    """Return trunk, pelvis and feet, each told by what the body has of its markers."""
    waist = (*names.WAIST_FRONT, *names.WAIST_BACK)
    left, right = (body.side(side, (*waist, *names.HIPS)) for side in "LR")
    trunk = _Part(
        bottom=body.middle("T10", "STRN"),
        top=body.middle("C7", "CLAV"),
        left=body.side("L", ACROMIA),
        right=body.side("R", ACROMIA),
        back=body.middle("C7", "T10"),
        front=body.middle("CLAV", "STRN"),
    )
    pelvis = _Part(
        bottom=body.middle(*waist),
        top=body.middle("C7", "CLAV"),
        left=left,
        right=right,
        back=body.middle(*names.WAIST_BACK),
        front=body.middle(*names.WAIST_FRONT),
    )
    return [trunk, pelvis, *(_foot(body, side, left, right) for side in "LR")]


def _foot(body: Body, side: str, left: Array | None, right: Array | None) -> _Part:
    if exchanged_heel(body, side):  # which way it points is known to be wrong
        return _Part(None, None, None, None, None, None)
    ankle, heel = body.side(side, names.ANKLES), body.side(side, names.HEELS)
    return _Part(
        bottom=ankle,
        top=body.side(side, names.KNEES),  # the shank's up: no foot points behind its shank
        left=left,
        right=right,
        back=ankle if heel is None else heel,
        front=body.side(side, names.TOES),
    )


def _volume(part: _Part) -> Array | None:
    """Return (up × left-to-right) · forward of unit vectors, (n_frames,); right: positive."""
    up = _between(part.bottom, part.top)
    rightward = _between(part.left, part.right)
    forward = _between(part.back, part.front)
    if up is None or rightward is None or forward is None:
        return None
    return np.asarray((np.cross(up, rightward) * forward).sum(axis=1))


def _between(start: Array | None, end: Array | None) -> Array | None:
    return None if start is None or end is None else unit(end - start)
