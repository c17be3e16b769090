"""Poses that are hard to believe, told by what a joint usually does."""

import numpy as np

from kinesphere.data import JointFlag, Mask, Solution

FAR_OUT = 3.0
"""Interquartile ranges beyond the upper quartile: Tukey's fence for values that are far out."""
LEAST_STRAY = 0.03
"""m; a limb nearer to where its axes take it is never called astray."""
FASTEST = np.deg2rad(8000.0)
"""rad/s; a limb that turns faster against its parent has leapt. The fastest of people, an upper arm
in throwing, may reach 7700 °/s (Seroyer et al. 2010, Sports Health 2(2), PMC3445080)."""


def improbable_poses(solution: Solution) -> dict[str, Mask]:
    """Return for each way of being improbable where it is so, (n_frames, n_joints).

    A joint comes apart where its flag says so. A limb goes astray where it lies farther from what
    the parameters rebuild than it usually does; it leaps where no limb turns so fast.
    """
    return {
        "comes apart": np.asarray((solution.parameters.flags & JointFlag.DISLOCATED) > 0),
        "goes where its axes do not take it": _astray(solution),
        "leaps": _leaps(solution),
    }


def _astray(solution: Solution) -> Mask:
    residuals = solution.parameters.residuals
    far = np.zeros(residuals.shape, dtype=bool)
    for j, column in enumerate(residuals.T):
        known = column[np.isfinite(column)]
        if len(known):
            lower, upper = np.percentile(known, [25, 75])
            far[:, j] = column > max(LEAST_STRAY, upper + FAR_OUT * (upper - lower))
    return far


def _leaps(solution: Solution) -> Mask:
    relative = solution.motion.relative_rotations()
    leaps = np.zeros(relative.shape[:2], dtype=bool)
    # the trace of a turn is 1 + 2 cos(angle); NaN where either frame is unseen, and no leap
    trace = np.einsum("fjab,fjab->fj", relative[1:], relative[:-1])
    largest = FASTEST / solution.motion.rate
    if largest < np.pi:
        leaps[1:] = trace < 1 + 2 * np.cos(largest)
    return leaps
