"""A joint centre on the way from expectation to skeleton."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array, JointModel
from kinesphere.geometry.centres import CentreFit


@dataclass(frozen=True)
class MeasuredJoint:
    """A joint centre with what it was expected to be."""

    model: JointModel
    fit: CentreFit
    expected: Array
    """(3,) m in the parent."""
    spread: float
    """m, how far off the expectation may be."""
    source: str
    """Where the expectation comes from."""
    drawn: float = 0.0
    """m, how far anatomy has drawn the centre from where the motion alone has it."""

    @property
    def off(self) -> float:
        """Return how far, in m, the centre is from where it was expected."""
        return float(np.linalg.norm(self.fit.centre - self.expected))

    @property
    def drawn_away(self) -> bool:
        """Whether the motion puts the centre elsewhere than expected, however little it tells."""
        return self.off > self.spread
