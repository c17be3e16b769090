"""What a check found: where, what, and what to do about it."""

from dataclasses import dataclass
from typing import Literal

from kinesphere.data import Json

Severity = Literal["error", "warning", "note"]
"""No use as it is; a result may suffer; worth knowing."""


@dataclass(frozen=True)
class Finding:
    """One thing that is wrong with a recording."""

    rule: str
    """Short name of the check, e.g. ``gap``."""
    severity: Severity
    what: str
    """What was found, a sentence for a person; markers and frames named."""
    remedy: str
    """What would be right, or what can be done."""
    markers: tuple[str, ...] = ()
    """Labels concerned; empty where all are."""
    frame: int | None = None
    """First frame concerned, in the file's own count (``first_frame`` is the first)."""
    numbers: tuple[tuple[str, float], ...] = ()
    """Figures behind it; names end in their unit."""

    def as_json(self) -> dict[str, Json]:
        """Return the finding as a summary holds it."""
        return {
            "rule": self.rule,
            "severity": self.severity,
            "what": self.what,
            "remedy": self.remedy,
            "markers": list(self.markers),
            "frame": self.frame,
            **dict(self.numbers),
        }
