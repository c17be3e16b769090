"""One step of damped Gauss–Newton on all cameras' equations, a prediction and a rest pose."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array
from kinesphere.markerless.chain import Chain
from kinesphere.markerless.pose import Pose, difference, limited, moved

STEP = 0.4
"""rad (and, for the root's shift, ×1 m): the longest step along one degree of freedom."""


@dataclass(frozen=True, eq=False)
class Prior:
    """Where a pose is expected, and how far it may be from there."""

    pose: Pose
    spread: Array
    """(n_dofs,) rad and m; infinite where nothing is expected."""


@dataclass(eq=False)
class Normals:
    """Normal equations, summed up: H step = g."""

    h: Array
    g: Array
    cost: float = 0.0

    @classmethod
    def empty(cls, n: int) -> "Normals":
        """Return equations that say nothing of ``n`` unknowns."""
        return cls(np.zeros((n, n)), np.zeros(n))

    def add(self, rows: Array, residuals: Array, weights: Array) -> None:
        """Add equations ``rows @ step = residuals``, (n, n_dofs) and (n,), by their weights."""
        weighted = rows * weights[:, None]
        self.h += rows.T @ weighted
        self.g += weighted.T @ residuals
        self.cost += float(weights @ residuals**2)


def solve_step(
    chain: Chain, pose: Pose, equations: Normals, priors: tuple[Prior, ...], damping: float
) -> tuple[Pose, float]:
    """Return the pose after one step, and the step's largest turn or shift.

    A joint at its limit that would be pushed beyond it is held there, and the rest is solved anew.

    Parameters
    ----------
    damping
        Share of the diagonal added to it (Levenberg–Marquardt).
    """
    h, g = equations.h.copy(), equations.g.copy()
    diagonal = np.arange(chain.n_dofs)
    h[diagonal, diagonal] *= 1 + damping
    for prior in priors:
        weight = 1.0 / prior.spread**2
        h[diagonal, diagonal] += weight
        g += weight * difference(chain, pose, prior.pose)
    # what nothing speaks of stays where it is
    h[diagonal, diagonal] += 1e-9 * (1 + h[diagonal, diagonal])
    step = _held_solution(chain, pose, h, g)
    largest = float(np.abs(step).max())
    step *= min(1.0, STEP / max(largest, 1e-12))
    return limited(chain, moved(chain, pose, step)), min(largest, STEP)


def _held_solution(chain: Chain, pose: Pose, h: Array, g: Array) -> Array:
    low, high = chain.limits
    free = np.ones(chain.n_dofs, dtype=bool)
    step = np.zeros(chain.n_dofs)
    for _ in range(3):
        if free.all():
            step[:] = np.linalg.solve(h, g)
        else:
            step[:] = 0
            step[free] = np.linalg.solve(h[np.ix_(free, free)], g[free])
        beyond = ((pose.angles + step > high) & (pose.angles >= high - 1e-6)) | (
            (pose.angles + step < low) & (pose.angles <= low + 1e-6)
        )
        if not (beyond & free).any():
            break
        free &= ~beyond
    return step
