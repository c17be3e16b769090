"""Units of length as files spell them."""

import numpy as np

from kinesphere.data import Array

_SPELLINGS = {
    1e-6: "um µm μm micrometer micrometre micron microns",
    1e-3: "mm millimeter millimetre millimeters millimetres",
    1e-2: "cm centimeter centimetre centimeters centimetres",
    1e-1: "dm decimeter decimetre decimeters decimetres",
    1.0: "m meter metre meters metres",
    0.0254: 'in inch inches "',
    0.3048: "ft foot feet",
}
_METRES = {name: metres for metres, names in _SPELLINGS.items() for name in names.split()}
_METRES_OR_MILLIMETRES = 20.0
"""A capture volume spans less than this in metres and more than this in millimetres."""
_VOLUME = (0.005, 200.0)
"""m; what moves through less or more than this was not recorded in the unit its file names."""


def metres_from_unit(unit: str) -> float | None:
    """Return how many metres a unit is; None if nobody knows it."""
    return _METRES.get(unit.strip(" \0\t.").casefold())


def guess_unit(points: Array) -> str:
    """Return ``"mm"`` or ``"m"``, whichever lets the markers span a room.

    Parameters
    ----------
    points : (n_frames, n_markers, 3)
        In the unknown unit, NaN where not seen.
    """
    return "m" if _extent(points) < _METRES_OR_MILLIMETRES else "mm"


def length_unit(said: str, points: Array) -> tuple[str, float, tuple[str, ...]]:
    """Return the unit of a file's lengths, how many metres it is, and what is doubtful about it.

    Parameters
    ----------
    said
        What the file says, perhaps nothing.
    points : (n_frames, n_markers, 3)
        In that unit, NaN where not seen.
    """
    unit = said.strip(" \0\t.")
    metres = metres_from_unit(unit)
    if metres is not None:
        extent = _extent(points) * metres
        if np.isfinite(extent) and extent > 0 and not _VOLUME[0] <= extent <= _VOLUME[1]:
            return (
                unit,
                metres,
                (f"the unit is {unit} as the file says, but then the markers span {extent:.3g} m",),
            )
        return unit, metres, ()
    guess = guess_unit(points)
    why = f"the file's unit {unit!r} is unknown" if unit else "the file names no unit of length"
    return (
        guess,
        _METRES[guess],
        (f"{why}; {guess} is guessed, as the markers span {_extent(points):.3g}",),
    )


def _extent(points: Array) -> float:
    """Return the widest 5–95 % range along an axis; NaN if no marker is seen."""
    seen = points[np.isfinite(points).all(axis=-1)]
    if not len(seen):
        return float("nan")
    low, high = np.percentile(seen, [5, 95], axis=0)
    return float((high - low).max())
