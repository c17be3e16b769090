"""What is asked for, beside what was measured."""

import math
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Bar:
    """One figure against the number it is held to."""

    section: str
    what: str
    value: float
    unit: str
    bar: float
    at_least: bool = False
    """True where more is better."""
    beside: bool = False
    """True where the figure was added later, to say more about one that was asked for."""

    @property
    def met(self) -> bool:
        """Whether the figure is good enough; nothing measured is not."""
        if not math.isfinite(self.value):
            return False
        return self.value >= self.bar if self.at_least else self.value <= self.bar

    @property
    def verdict(self) -> str:
        """``met`` or a bold ``missed``."""
        return "met" if self.met else "**missed**"

    @property
    def measured(self) -> str:
        """The figure with its unit."""
        if not math.isfinite(self.value):
            return "–"
        if self.unit == "rad":
            return f"{self.value:.0e} rad"
        return f"{number(self.value)} {self.unit}" if self.unit else f"{self.value:.3g}"

    @property
    def asked(self) -> str:
        """The bar with its direction and unit."""
        return f"{'≥' if self.at_least else '≤'} {self.bar:g} {self.unit}".rstrip()

    def as_json(self) -> dict[str, Any]:
        """Return what JSON can hold."""
        return {
            "section": self.section,
            "what": self.what,
            "value": round(self.value, 6) if math.isfinite(self.value) else None,
            "unit": self.unit,
            "bar": self.bar,
            "at_least": self.at_least,
            "met": self.met,
            "beside": self.beside,
        }


def number(value: float | None, digits: int = 3) -> str:
    """Return a number in as many digits as mean something; – for none."""
    if value is None or not math.isfinite(value):
        return "–"
    if abs(value) < 1e-9:
        return "0"
    size = abs(value)
    if size < 0.0005:
        return f"{value:.0e}"
    places = max(0, digits - 1 - math.floor(math.log10(size))) if size >= 0.1 else 3
    return f"{value:.{min(places, 3)}f}"
