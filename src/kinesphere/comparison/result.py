"""What a comparison of two solutions found."""

from dataclasses import dataclass

from kinesphere.comparison.alignment import LimbAlignment, WorldAlignment
from kinesphere.comparison.kinship import Kinship
from kinesphere.comparison.measures import Agreement
from kinesphere.comparison.offset import TimeOffset
from kinesphere.data import Array


@dataclass(frozen=True, eq=False)
class ParameterComparison:
    """One angle of one joint on both sides, in rad, unwrapped, at the common times."""

    joint: str
    name: str
    """``flexion``, ``axis1``, ``twist``, ``bend``."""
    kind: str
    """``clinical`` (ISB), ``own`` (about the first side's movement axes), ``bend`` (between the
    long axes of two limbs)."""
    first: Array
    """(n,)"""
    second: Array | None
    """(n,) as the second side has it in its own frames; None where it has no such angle."""
    aligned: Array
    """(n,) the second side in the first's limb frames."""
    before: Agreement | None
    after: Agreement


@dataclass(frozen=True, eq=False)
class JointComparison:
    """One joint on both sides."""

    name: str
    orientation_before: float
    """rad, rms angle between the two ``parent_from_child``."""
    orientation_after: float
    """The same without constant differences of the limb frames."""
    centre: float
    """m, rms distance of the joint centres in one world."""
    centre_constant: float
    """m, length of the part of it that is fixed in the parent: another definition of the centre."""
    centre_after: float
    """m, rms distance that remains without that part."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """Two solutions of one motion, side by side; differences are the second minus the first."""

    times: Array
    """(n,) s on the first side's clock, at the slower of the two rates."""
    rate: float
    """Hz."""
    kinship: Kinship
    """What both have from one source, and what was therefore neither sought nor taken out."""
    offset: TimeOffset
    world: WorldAlignment | None
    """None where the joint centres do not tell it; worlds are then taken to be the same."""
    limbs: tuple[LimbAlignment, ...]
    joints: tuple[JointComparison, ...]
    parameters: tuple[ParameterComparison, ...]
    limbs_only_first: tuple[str, ...]
    limbs_only_second: tuple[str, ...]
    joints_only_first: tuple[str, ...]
    joints_only_second: tuple[str, ...]
    warnings: tuple[str, ...]

    def parameter(self, joint: str, name: str) -> ParameterComparison:
        """Return one angle of one joint; KeyError if there is none."""
        return {(p.joint, p.name): p for p in self.parameters}[joint, name]
