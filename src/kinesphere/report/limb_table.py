"""The table of limbs: their lengths, beside the other side's, and how they were seen."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import PoseFlag, Solution
from kinesphere.report.tiles import rms
from kinesphere.report.wording import in_words, millimetres, number_in_words


@dataclass(frozen=True)
class LimbRow:
    """What a person needs to know of one limb."""

    name: str
    length: str
    other_side: str
    """Difference to the same limb of the other side."""
    markers: str
    residual: str
    measured: str
    unseen: str


def limb_rows(solution: Solution) -> list[LimbRow]:
    """Return one row a limb, root first."""
    motion, lengths = solution.motion, {limb.name: limb.length for limb in solution.skeleton.limbs}
    rows = []
    for i, limb in enumerate(solution.skeleton.limbs):
        flags = motion.flags[:, i]
        own = np.isin(flags, (PoseFlag.MEASURED, PoseFlag.JOINT_AIDED)).mean()
        rows.append(
            LimbRow(
                name=in_words(limb.name),
                length=number_in_words(limb.length * 1e3, "mm", digits=4),
                other_side=_against_other_side(limb.name, lengths),
                markers=", ".join(limb.markers),
                residual=millimetres(rms(motion.residuals[:, i])),
                measured=f"{own:.1%}",
                unseen=f"{(flags == PoseFlag.UNSEEN).mean():.1%}",
            )
        )
    return rows


def other_side(name: str) -> str:
    """Return the name of the limb or joint of the other side, in either spelling."""
    for side, other in (("left", "right"), ("right", "left")):
        if name.startswith((f"{side}_", f"{side} ")):
            return other + name.removeprefix(side)
    return name


def _against_other_side(name: str, lengths: dict[str, float]) -> str:
    own, twin = lengths[name], lengths.get(other_side(name), np.nan)
    if not (np.isfinite(own) and np.isfinite(twin)) or name == other_side(name):
        return ""
    return f"{2 * (own - twin) / (own + twin):+.1%}"
