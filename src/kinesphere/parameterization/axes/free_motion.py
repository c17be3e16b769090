"""Two axes from free motion with twist in it, by the likelihood of the angles as processes."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from kinesphere.data import Array
from kinesphere.geometry.rotations import nearest_rotation, tangent_basis
from kinesphere.parameterization.axes.joint_kernels import angles_and_loads
from kinesphere.parameterization.axes.kernels import surprise

SPACING = 0.1  # s between frames; people's angles hardly change their course within that
RESTLESS = np.deg2rad(0.7)  # errors new in every frame; correlated ones of 3° look like 0.5°
MOST_FRAMES = 1200  # of longer motion, every second, third… frame
USUAL = np.log([0.3, 0.3, 0.1, 0.5, 0.5, 0.5, 0.02, 0.4])
"""Deviations of both angles and the twist (rad) and their memories (s), error of a pose (rad) and
its memory (s): 17°, 17°, 6°, half a second, 1°, 0.4 s."""
FACTORS = np.array([1.0, 1.0, 1.0, 0.7, 0.7, 0.7, 0.7, 0.5])
"""Standard deviations of these logarithms: half or double is nothing unusual."""
WIDEST = 3.0  # of those deviations
FLOOR = 0.002  # rad, of an angle without any error
FLATTEST = (
    0.05  # least determinant of the angles' Jacobian: nearer to gimbal lock angles say little
)
REACH = 0.02  # rad, deviation of a limb out of reach
TRIAL, STEPS = 15, 80  # of a descent that is tried, and of the last
TRIAL_FRAMES = 300  # tell starts apart


@dataclass(frozen=True, eq=False)
class FreeMotion:
    """Frames of a joint that does what it likes."""

    rotations: Array
    """(n, 3, 3) ``parent_from_child``."""
    times: Array
    """(n,) s, growing."""
    long_axis: Array
    """(3,) in the child; what it twists about."""
    reference: Array
    """(3, 3) ``parent_from_child`` where the distal axis is told."""

    def thinned(self) -> "FreeMotion":
        """Return frames at least `SPACING` apart, at most `MOST_FRAMES` of them.

        Where errors are new in every frame, no process can follow them: there a frame stands for
        the mean of its `SPACING`.
        """
        cells = np.floor(self.times / SPACING + 1e-6)
        at = np.flatnonzero(np.diff(cells, prepend=-np.inf) > 0)
        stride = slice(None, None, 1 + (len(at) - 1) // MOST_FRAMES)
        if _new_in_every_frame(self.rotations) < RESTLESS:
            return self._at(at[stride])
        means = nearest_rotation(np.add.reduceat(self.rotations, at))
        times = np.add.reduceat(self.times, at) / np.diff(at, append=len(cells))
        few = replace(self, rotations=means, times=times)
        return few._at(np.arange(len(at))[stride])

    def first(self, count: int) -> "FreeMotion":
        """Return the first few frames."""
        return self._at(np.arange(min(count, len(self.times))))

    def _at(self, frames: NDArray[np.intp]) -> "FreeMotion":
        rotations = np.ascontiguousarray(self.rotations[frames])
        return replace(self, rotations=rotations, times=self.times[frames])


class AxesFit(NamedTuple):
    """Two axes, and how likely they are."""

    axes: Array
    """(2, 3) in the parent, distal first, the distal one where the limb is in its reference."""
    cost: float
    """Negative logarithm of the posterior, less a constant."""


def likeliest_axes(motion: FreeMotion, starts: Sequence[Array]) -> AxesFit:
    """Return two axes by maximum a posteriori.

    Two axes and a twist rebuild every pose, so only what the three angles are like in time speaks
    for one pair of axes against another. Seen about the axes a person moves around, they go their
    own ways: each is taken as a Gaussian process of its own deviation and memory, estimated with
    the axes; about wrong axes the angles mix, and mixtures are the less likely (as in the
    separation of sources: Pham & Garat 1997, doi:10.1109/78.599941). Errors of the poses are a
    process, too, that spoils angles the more, the nearer they are to gimbal lock. Densities are
    those of poses, so the determinant of the angles' Jacobian is their unit.

    Where the limb twists little, least twist (`universal_joint`) is nearly as good; where it
    twists as far as it swings, this is several times better.

    Parameters
    ----------
    motion
        Some 200 frames at least.
    starts : (2, 3) each
        The one that a few steps make likeliest counts.
    """
    thinned = motion.thinned()
    if len(starts) == 1:
        return _descend(thinned, starts[0], STEPS)
    few = thinned.first(TRIAL_FRAMES)
    best = min((_descend(few, start, TRIAL) for start in starts), key=lambda fit: fit.cost)
    return _descend(thinned, best.axes, STEPS)


def _descend(motion: FreeMotion, start: Array, steps: int) -> AxesFit:
    bases = [tangent_basis(axis) for axis in start]
    gaps = np.round(np.diff(motion.times), 6)

    def axes_at(v: NDArray[np.float64]) -> Array:
        moved = start + np.stack([v[:2] @ bases[0], v[2:4] @ bases[1]])
        return np.asarray(moved / np.linalg.norm(moved, axis=1)[:, None])

    def cost(v: NDArray[np.float64]) -> float:
        return _cost(motion, gaps, axes_at(v), v[4:])

    low, high = USUAL - WIDEST * FACTORS, USUAL + WIDEST * FACTORS
    angles, *_ = angles_and_loads(
        motion.rotations, start[0], start[1], motion.reference, motion.long_axis, FLATTEST
    )
    sizes = np.log(np.maximum(angles.std(axis=0), FLOOR))
    first = np.clip(np.concatenate([sizes, USUAL[3:]]), low, high)
    found = minimize(
        cost,
        np.concatenate([np.zeros(4), first]),
        method="L-BFGS-B",
        bounds=[(-1.0, 1.0)] * 4 + list(zip(low, high, strict=True)),
        options={"maxiter": steps},
    )
    return AxesFit(axes_at(found.x), float(found.fun))


def _cost(motion: FreeMotion, gaps: Array, axes: Array, logs: Array) -> float:
    """Return the negative logarithm of the posterior of axes, (2, 3), and of processes, (8,)."""
    angles, loads, excess, unit = angles_and_loads(
        motion.rotations, axes[0], axes[1], motion.reference, motion.long_axis, FLATTEST
    )
    sizes = np.exp(logs)
    told = surprise(angles, loads, gaps, sizes[:3], sizes[3:6], sizes[6], sizes[7], FLOOR**2)
    out = 0.5 * ((excess / REACH) ** 2).sum()
    prior = 0.5 * (((logs - USUAL) / FACTORS) ** 2).sum()
    return float(told + unit + out + prior)


def _new_in_every_frame(rotations: Array) -> float:
    """Return the standard deviation in rad, about each axis, of errors that no frame shares."""
    if len(rotations) < 3:
        return 0.0
    bends = rotations[2:] + rotations[:-2] - 2 * rotations[1:-1]
    # of independent errors the squares of the nine entries add up to 36 variances
    return float(np.median(np.sqrt((bends**2).sum(axis=(1, 2))))) / 6
