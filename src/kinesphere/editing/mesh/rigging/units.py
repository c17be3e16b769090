"""In which unit a mesh is a person."""

_UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "dm": 0.1}
_SHORT, _TALL = 1.2, 2.3  # m: what stands between is a person in that unit
_PERSON = 1.7


def unit_of(tall: float) -> tuple[str, float]:
    """Return the unit in which so tall a body is a person, and its m; a guess, said to people.

    Nothing depends on it but what is said: a body is fitted to the skeleton in any size.
    """
    for name, metres in _UNITS.items():
        if _SHORT <= tall * metres <= _TALL:
            return name, metres
    metres = _PERSON / tall
    return f"of {metres:.3g} m, as for a person", metres
