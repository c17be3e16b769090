"""What every labeller returns, and what it is given."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, TopologicalModel


@dataclass(frozen=True)
class Match:
    """Which label each point bears, and how surely."""

    labels: NDArray[np.int64]
    """(n_points,) index into the labels asked for; −1 where none is given."""
    confidence: Array
    """(n_points,) 0…1: how far the labels given are from the best other ones; 0 for none."""
    fit: float
    """Nats a pair by which labels fit better than nothing; NaN where a method has no such thing."""
    note: str = ""
    """Why labels were refused, if they were."""
    bodies: int = 1
    """Bodies that were there; the one that the model fits best has labels."""

    def refused(self, note: str) -> "Match":
        """Return the same without any label."""
        nothing = np.full(len(self.labels), -1, dtype=np.int64)
        return Match(nothing, np.zeros(len(nothing)), self.fit, note)


Labeller: TypeAlias = Callable[[Array, TopologicalModel], Match]
"""Points (n_frames, n_points, 3), NaN where not seen, and a model → labels by index into
``model.labels``."""


def nothing(n_points: int, note: str) -> Match:
    """Return a match that labels nothing, and says why."""
    return Match(np.full(n_points, -1, dtype=np.int64), np.zeros(n_points), np.nan, note)
