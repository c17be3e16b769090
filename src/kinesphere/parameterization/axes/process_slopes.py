"""The likelihood of a joint's angles as processes in time, and what it changes with."""

import numpy as np

from kinesphere.data import Array
from kinesphere.kernels.jit import kernel
from kinesphere.parameterization.axes.process_kernels import (
    ERRORS,
    MEANS,
    STATES,
    Tape,
    filtered,
    transition,
)
from kinesphere.parameterization.axes.steps_back import (
    add_block,
    by_course,
    by_size,
    foretell_back,
    take_back,
)
from kinesphere.parameterization.samples import Frames


@kernel
def surprise(
    angles: Array,
    loads: Array,
    gaps: Array,
    movement: Frames,
    deviations: Array,
    memories: Array,
    error: float,
    error_memory: float,
    posture: float,
    floor: float,
    tape: Tape,
) -> tuple[float, Array, Array, Array, Array, Array]:
    """Return the negative logarithm of the likelihood of three angles over time, and its slopes.

    Each angle is a smooth Gaussian process about a mean of its own (Matérn 5/2), begun anew in
    every movement; the error of a pose is an Ornstein–Uhlenbeck process about each of three axes,
    which spoils all three angles and takes no notice of movements. The slopes are the filter's
    steps taken backwards (reverse accumulation), which costs about one more filter.

    Parameters
    ----------
    angles : (n, 3) rad
    loads : (n, 3, 3)
        How each angle, first index, depends on the error about each axis.
    gaps : (n - 1,)
        s between frames.
    movement : (n,)
        Which one a frame belongs to, growing from 0.
    deviations : (n_movements, 3)
        rad, of each angle's process.
    memories : (3,)
        s
    error, error_memory
        rad and s.
    posture
        rad, standard deviation of a mean's change from movement to movement.
    floor
        rad², variance that every angle has besides.
    tape
        Of as many frames.

    Returns
    -------
    total
        The negative logarithm, less a constant.
    by_angles, by_loads, by_deviations, by_memories
        Its slopes, shaped as what they are by.
    by_others : (3,)
        By error, error_memory and posture.

    References
    ----------
    Hartikainen & Särkkä (2010), doi:10.1109/MLSP.2010.5589113, for the processes as states.
    """
    rates = np.sqrt(5.0) / memories
    total = filtered(
        angles, loads, gaps, movement, deviations, rates, error, error_memory, posture, floor, tape
    )
    before, halves, rows, seen, errors = tape
    n = len(angles)
    by_angles, by_loads = np.zeros((n, 3)), np.zeros((n, 3, 3))
    by_deviations, by_rates, by_others = np.zeros(deviations.shape), np.zeros(3), np.zeros(3)
    by_state, by_p = np.zeros(STATES), np.zeros((STATES, STATES))
    by_still, by_move = np.zeros((3, 3, 3)), np.zeros((3, 3, 3))
    move, half = np.zeros((3, 3, 3)), np.zeros((STATES, STATES))
    by_row, by_error, keep, last = np.empty(STATES), 0.0, 0.0, -1.0
    for f in range(n - 1, -1, -1):
        for k in range(2, -1, -1):
            take_back(
                k,
                loads[f, k],
                rows[f, k],
                seen[f, k],
                errors[f, k],
                by_state,
                by_p,
                by_row,
                by_angles[f],
                by_loads[f, k],
            )
        if f == 0:
            break
        if movement[f] != movement[f - 1]:
            for k in range(3):
                b, m = 3 * k, MEANS + k
                add_block(by_still[k], by_p, b, 1.0)
                by_size(
                    k,
                    by_still[k],
                    deviations[movement[f], k],
                    rates[k],
                    by_deviations[movement[f]],
                    by_rates,
                )
                by_state[b : b + 3] = 0.0
                by_p[b : b + 3] = 0.0
                by_p[:, b : b + 3] = 0.0
                by_others[2] += 2.0 * posture * by_p[m, m]
        if gaps[f - 1] != last:
            if last >= 0.0:
                by_course(by_move, by_rates, rates, last)
            last = gaps[f - 1]
            keep = np.exp(-last / error_memory)
            for k in range(3):
                transition(move[k], rates[k], last)
        by_keep = 0.0
        for k in range(3):
            b, e = 3 * k, ERRORS + k
            for i in range(3):
                for j in range(3):
                    by_move[k, i, j] += by_state[b + i] * before[f, b + j]
            for c in range(STATES):
                by_keep += 2.0 * by_p[e, c] * halves[f, c, e]
                for i in range(3):
                    for j in range(3):
                        by_move[k, i, j] += 2.0 * by_p[b + i, c] * halves[f, c, b + j]
            by_keep += by_state[e] * before[f, e]
            add_block(by_still[k], by_p, b, 1.0)
            by_error += by_p[e, e]
        by_others[1] += by_keep * keep * last / error_memory**2
        foretell_back(by_state, by_p, half, move, keep)
        for k in range(3):
            b, e = 3 * k, ERRORS + k
            add_block(by_still[k], by_p, b, -1.0)
            by_error -= by_p[e, e]
    if last >= 0.0:
        by_course(by_move, by_rates, rates, last)
    for k in range(3):
        add_block(by_still[k], by_p, 3 * k, 1.0)
        by_error += by_p[ERRORS + k, ERRORS + k]
        by_size(k, by_still[k], deviations[0, k], rates[k], by_deviations[0], by_rates)
    by_others[0] = 2.0 * error * by_error
    return total, by_angles, by_loads, by_deviations, -by_rates * rates / memories, by_others
