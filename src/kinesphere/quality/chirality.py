"""Whether the body is the right way round or its mirror image.

A left-handed export, or one negated axis, turns a person into their mirror image: seen from
outside, left and right, up and down, front and back no longer fit together. That does not depend
on which way is up in the file, nor on posture, if each triple is taken within one body part.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array
from kinesphere.quality import body as names
from kinesphere.quality.body import Body, unit

DECISIVE = 0.2
"""Least |(up × left-to-right) · forward| of unit vectors that says anything: a part whose three
directions lie nearly in a plane may tip over by noise alone."""


@dataclass(frozen=True)
class Chirality:
    """How often body parts are the right way round; shares of what was decisive."""

    right: float
    """Share of part-frames with up × (left to right) · forward > 0, as in a right-handed world."""
    n: int
    """Number of part-frames that decide; 0: nothing known."""


def find_chirality(bodies: Iterable[Body]) -> Chirality:
    """Return how the trunk, the pelvis and the feet of every body and frame are turned."""
    volumes = [v for body in bodies for part in _parts(body) if (v := _volume(*part)) is not None]
    together: Array = np.concatenate([*volumes, np.empty(0)])
    decisive = together[np.abs(together) > DECISIVE]  # NaN compares as False
    right = float(np.mean(decisive > 0)) if len(decisive) else float("nan")
    return Chirality(right, len(decisive))


def _parts(body: Body) -> list[tuple[Array | None, ...]]:
    """Return (top, bottom, right, left, front, back) of every part that is its own witness."""
    waist = (*names.WAIST_FRONT, *names.WAIST_BACK)
    right, left = (body.side(side, (*waist, *names.HIPS)) for side in "RL")
    shoulders = ("SHO", "SHOULDER", "FSH", "BSH", "ACR")
    trunk = (
        body.middle("C7", "CLAV"),
        body.middle("T10", "STRN"),
        body.side("R", shoulders),
        body.side("L", shoulders),
        body.middle("CLAV", "STRN"),
        body.middle("C7", "T10"),
    )
    pelvis = (
        body.middle("C7", "CLAV"),
        body.middle(*waist),
        right,
        left,
        body.middle(*names.WAIST_FRONT),
        body.middle(*names.WAIST_BACK),
    )
    feet = [
        (
            body.side(side, names.KNEES),
            body.side(side, names.ANKLES),
            right,
            left,
            body.side(side, names.TOES),
            _first(body.side(side, names.HEELS), body.side(side, names.ANKLES)),
        )
        for side in "LR"
    ]
    return [trunk, pelvis, *feet]


def _first(*points: Array | None) -> Array | None:
    return next((point for point in points if point is not None), None)


def _volume(
    top: Array | None,
    bottom: Array | None,
    right: Array | None,
    left: Array | None,
    front: Array | None,
    back: Array | None,
) -> Array | None:
    up, rightward, forward = _between(bottom, top), _between(left, right), _between(back, front)
    if up is None or rightward is None or forward is None:
        return None
    return np.asarray((np.cross(up, rightward) * forward).sum(axis=1))


def _between(start: Array | None, end: Array | None) -> Array | None:
    return None if start is None or end is None else unit(end - start)
