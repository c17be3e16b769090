"""Two axes from free motion with twist in it, by the likelihood of the angles as processes."""

from collections.abc import Sequence
from functools import partial

import numpy as np
from scipy.optimize import minimize

from kinesphere.data import Array
from kinesphere.geometry.rotations import tangent_basis
from kinesphere.parameterization.axes.free_motion import FLATTEST, FLOOR, AxesFit, FreeMotion
from kinesphere.parameterization.axes.joint_kernels import angles_and_loads
from kinesphere.parameterization.axes.movements import Movements
from kinesphere.parameterization.axes.process_kernels import Tape, blank_tape
from kinesphere.parameterization.axes.process_slopes import surprise

USUAL = np.log([0.3, 0.3, 0.1, 0.5, 0.5, 0.5, 0.02, 0.4, 0.01, 0.05])
"""Deviations of both angles and the twist (rad) and their memories (s), error of a pose (rad) and
its memory (s): 17°, 17°, 6°, half a second, 1°, 0.4 s. Where angles rest, too: their deviation
there, and that of their means from movement to movement (rad): 0.6°, 3°."""
FACTORS = np.array([1.0, 1.0, 1.0, 0.7, 0.7, 0.7, 0.7, 0.5, 1.0, 1.0])
"""Standard deviations of these logarithms: half or double is nothing unusual."""
ALWAYS = 8  # of them; the others are where angles rest
WIDEST = 3.0  # of those deviations
REACH = 0.02  # rad, deviation of a limb out of reach
TRIAL, STEPS = 15, 80  # of a descent that is tried, and of the last
TRIAL_FRAMES = 300  # tell starts apart
NUDGE = 1e-6  # rad, of an axis, by which angles are differentiated


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
    return _descend(thinned, best.axes, STEPS, best.logs)


def likeliest_with_rests(motion: FreeMotion, smooth: AxesFit) -> AxesFit:
    """Return two axes likewise where angles may rest in a movement while others move.

    `likeliest_axes` expects of every angle that it goes on as it is used to. Who moves about one
    axis at a time breaks that: the other angle, which rests, then says more than the one that
    moves, for tilted axes would make it move along. So each angle's process begins anew in every
    movement, as wide as ever or hardly there, whichever it looks like about the axes of the start.

    Parameters
    ----------
    motion
        Thinned.
    smooth
        From `likeliest_axes`. Returned as it is where no angle ever rests.
    """
    movements = Movements.by_rests(motion.times, _told(motion, smooth.axes)[0])
    if not movements.resting:
        return smooth
    logs = np.concatenate([smooth.logs, USUAL[ALWAYS:]])
    return _descend(motion, smooth.axes, STEPS, logs, movements)


def _descend(
    motion: FreeMotion,
    start: Array,
    steps: int,
    logs: Array | None = None,
    movements: Movements | None = None,
) -> AxesFit:
    if movements is None:
        movements = Movements.one(len(motion.times))
    if logs is None:
        sizes = _told(motion, start)[0].std(axis=0)
        logs = np.concatenate([np.log(np.maximum(sizes, FLOOR)), USUAL[3:ALWAYS]])
    usual, factors = USUAL[: len(logs)], FACTORS[: len(logs)]
    low, high = usual - WIDEST * factors, usual + WIDEST * factors
    found = minimize(
        partial(_cost_along, motion, movements, start, blank_tape(len(motion.times))),
        np.concatenate([np.zeros(4), np.clip(logs, low, high)]),
        jac=True,
        method="L-BFGS-B",
        bounds=[(-1.0, 1.0)] * 4 + list(zip(low, high, strict=True)),
        options={"maxiter": steps},
    )
    return AxesFit(_moved(start, found.x[:4]), float(found.fun), found.x[4:])


def _moved(start: Array, by: Array) -> Array:
    """Return two axes, (2, 3), moved along their tangent planes, (4,)."""
    bases = [tangent_basis(axis) for axis in start]
    moved = start + np.stack([by[:2] @ bases[0], by[2:] @ bases[1]])
    return np.asarray(moved / np.linalg.norm(moved, axis=1)[:, None])


def _cost_along(
    motion: FreeMotion, movements: Movements, start: Array, tape: Tape, v: Array
) -> tuple[float, Array]:
    """Return the cost of moves of both axes, (4,), and of logarithms after them, and its slopes."""
    told = _told(motion, _moved(start, v[:4]))
    cost, by_angles, by_loads, by_logs = _cost(motion, movements, told, v[4:], tape)
    slopes = np.empty(len(v))
    slopes[4:] = by_logs
    for k in range(4):
        nudged = v[:4].copy()
        nudged[k] += NUDGE
        near = _told(motion, _moved(start, nudged))
        rise = (by_angles * (near[0] - told[0])).sum() + (by_loads * (near[1] - told[1])).sum()
        slopes[k] = (rise + _beside(*near[2:]) - _beside(*told[2:])) / NUDGE
    return cost, slopes


def _cost(
    motion: FreeMotion,
    movements: Movements,
    told: tuple[Array, Array, Array, float],
    logs: Array,
    tape: Tape,
) -> tuple[float, Array, Array, Array]:
    """Return the negative logarithm of the posterior of axes and processes, and its slopes.

    By angles, (n, 3), by loads, (n, 3, 3), and by the logarithms, (8,) or (10,).
    """
    angles, loads, excess, unit = told
    sizes = np.exp(logs)
    sway, posture = sizes[ALWAYS:] if len(logs) > ALWAYS else (0.0, 0.0)
    gaps = np.round(np.diff(motion.times), 6)
    found, by_angles, by_loads, by_deviations, by_memories, by_others = surprise(
        angles,
        loads,
        gaps,
        movements.of_frame,
        movements.deviations(sizes[:3], sway),
        sizes[3:6],
        sizes[6],
        sizes[7],
        posture,
        FLOOR**2,
        tape,
    )
    widest = (by_deviations * movements.moving).sum(axis=0)
    least = (by_deviations * ~movements.moving).sum()
    slopes = np.array([*widest, *by_memories, *by_others[:2], least, by_others[2]])
    usual, factors = USUAL[: len(logs)], FACTORS[: len(logs)]
    unusual = (logs - usual) / factors
    cost = found + _beside(excess, unit) + 0.5 * (unusual**2).sum() + movements.surprise
    by_logs = slopes[: len(logs)] * sizes + unusual / factors
    return float(cost), by_angles, by_loads, by_logs


def _told(motion: FreeMotion, axes: Array) -> tuple[Array, Array, Array, float]:
    """Return angles about two axes, their loads, what is out of reach, and the unit."""
    return angles_and_loads(
        motion.rotations, axes[0], axes[1], motion.reference, motion.long_axis, FLATTEST
    )


def _beside(excess: Array, unit: float) -> float:
    """Return what poses cost beside the processes of their angles."""
    return float(unit + 0.5 * ((excess / REACH) ** 2).sum())
