"""How much later one of two records has it, and how that is known."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class TimeOffset:
    """What is at time t on one side is at ``t + seconds`` on the other."""

    seconds: float
    correlation: float
    """Of the turning speeds of all common limbs at this offset; NaN where it was not sought."""
    overlap: float
    """s that both have in common."""
    given: bool
    """Whether the user said it."""
    shared: bool = False
    """Whether both have the frames of one recording, so that it is 0 and was not sought."""
    warnings: tuple[str, ...] = ()

    @property
    def source(self) -> str:
        """Where it is from, in words."""
        if self.given:
            return "as given"
        if self.shared:
            return "frames of one recording"
        if np.isfinite(self.correlation):
            return f"limb speeds correlate by {self.correlation:.3f}"
        return "not to be told"
