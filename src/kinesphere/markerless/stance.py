"""How a person may stand or lie in a visual hull: where, how large, which way."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array
from kinesphere.markerless.anatomy import UP
from kinesphere.markerless.body import Body

_HEADINGS = 12
_SIZES = (-0.05, 0.05)
"""Logarithms by which a body is tried smaller and larger than the hull says."""
_LYING = 0.65
"""Height of a hull, as a share of its length, below which the person is taken to lie."""
_COLUMN = 0.25
"""m about the middle in which a standing person's height is looked for: arms may be raised."""


@dataclass(frozen=True, eq=False)
class Stance:
    """One way of standing or lying, to be tried with several headings."""

    place: Array
    """(3,) m, the pelvis."""
    up: Array
    """(3,) unit, from the feet to the head."""
    headings: tuple[Array, ...]
    """Unit vectors, where the person may look."""
    log_size: float
    """Logarithm of how much larger than the body as it is."""


def stances_of(
    hull: Array, body: Body, position: Array | None, heading: Array | None, *, sizes: bool
) -> list[Stance]:
    """Return what a hull allows, (n, 3) m.

    A hull about as high as long is taken as standing; a flat one as lying along its length, either
    way round, on any side.

    Parameters
    ----------
    position, heading
        About where the pelvis is and where the person looks, if known.
    sizes
        Whether the body may be of another size.
    """
    middle = hull.mean(axis=0)
    along = np.linalg.svd(hull - middle, full_matrices=False)[2][0]
    length = float(np.ptp(hull @ along))
    tall = float(np.ptp(hull[:, 1]))
    lies = tall < _LYING * length
    if not lies:
        column = np.linalg.norm(hull[:, [0, 2]] - np.median(hull[:, [0, 2]], axis=0), axis=1)
        near = hull[column < _COLUMN, 1]
        length = float(np.ptp(near)) if len(near) else tall
    own = float(np.ptp(body.bind[:, 1]))
    log_size = float(np.clip(np.log(max(length, 0.1) / own), -0.35, 0.25)) if sizes else 0.0
    stances = []
    for up in (along, -along) if lies else (UP,):
        for more in _SIZES if sizes else (0.0,):
            size = np.exp(log_size + more)
            if position is not None:
                place = position
            elif lies:
                place = middle
            else:
                pelvis = size * (body.chain.centres[0][1] - body.bind[:, 1].min())
                place = np.array([middle[0], hull[:, 1].min() + pelvis, middle[2]])
            stances.append(Stance(place, up, _headings(up, heading), log_size + more))
    return stances


def _headings(up: Array, heading: Array | None) -> tuple[Array, ...]:
    first = np.cross(up, np.eye(3)[np.abs(up).argmin()]) if heading is None else heading
    first = first - (first @ up) * up
    first = first / max(float(np.linalg.norm(first)), 1e-9)
    side = np.cross(up, first)
    turns = 2 * np.pi * np.arange(_HEADINGS) / _HEADINGS
    if heading is not None:
        turns = np.radians([-20.0, 0.0, 20.0])
    return tuple(np.cos(t) * first + np.sin(t) * side for t in turns)
