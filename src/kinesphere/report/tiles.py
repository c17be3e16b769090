"""The figures at the top of the page, which sum up a solution."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array, Solution
from kinesphere.report.wording import counted, millimetres, number_in_words


@dataclass(frozen=True)
class Tile:
    """One figure at the top of the page."""

    name: str
    value: str
    aside: str = ""


def tiles(solution: Solution) -> list[Tile]:
    """Return the figures that sum up a solution."""
    motion, parameters = solution.motion, solution.parameters
    joints = solution.skeleton.joints
    sure = sum(joint.observability in ("determined", "given") for joint in joints)
    centres = [joint.residual * 1e3 for joint in joints if np.isfinite(joint.residual)]
    of = f" of {len(centres)}" if 0 < len(centres) < len(joints) else ""
    return [
        Tile(
            "Recording",
            number_in_words(motion.n_frames / motion.rate, "s"),
            f"{counted(motion.n_frames, 'frame')} at {motion.rate:g} Hz",
        ),
        Tile(
            "Skeleton",
            f"{len(motion.skeleton.limbs)} limbs",
            f"model {solution.model_name}",
        ),
        Tile("Limb fit", millimetres(rms(motion.residuals)), "rms, markers against rigid limbs"),
        Tile(
            "Joint centres",
            millimetres(float(np.median(centres)) / 1e3 if centres else float("nan")),
            f"median residual{of}; {sure} of {len(joints)} fixed by the motion",
        ),
        Tile(
            "Rebuilt",
            millimetres(rms(parameters.residuals)),
            "rms, limb mid points from the parameters",
        ),
        Tile("Seen", f"{motion.seen.mean():.1%}", "of all limb poses"),
    ]


def rms(values: Array) -> float:
    """Return the root mean square of what is no NaN; NaN of nothing."""
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if len(known) else float("nan")
