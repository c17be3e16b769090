"""Lengths as a person reads them, of whatever size."""


def in_millimetres(metres: float) -> str:
    """Return a length in mm: whole ones, two digits below one, three of a kilometre and more."""
    length = metres * 1e3
    if length == 0 or 1.0 <= abs(length) < 1e6:
        return f"{length:.0f} mm"
    return f"{length:.2g} mm" if abs(length) < 1.0 else f"{length:.3g} mm"
