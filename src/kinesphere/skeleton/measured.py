"""A joint centre on the way from expectation to skeleton."""

from dataclasses import dataclass

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
