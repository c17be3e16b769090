"""A joint's angles as processes in time: a filter that keeps what its slopes need."""

from typing import NamedTuple

import numpy as np

from kinesphere.data import Array
from kinesphere.kernels.jit import kernel
from kinesphere.parameterization.samples import Frames

ERRORS = 9  # states: each angle with its first two derivatives, then errors, then means
MEANS = 12
STATES = 15
_VAGUE = 1.0  # rad², of the angles' means


class Tape(NamedTuple):
    """What a filter leaves for its slopes."""

    before: Array
    """(n, 15) the state in the frame before."""
    halves: Array
    """(n, 15, 12) A (P − P∞) of the step to each frame, without the means' columns."""
    rows: Array
    """(n, 3, 15) covariance of every state with each angle of a frame."""
    seen: Array
    """(n, 3, 5) of each angle its variance, how far off it is, and the errors believed before."""
    errors: Array
    """(n, 3, 3, 15) the errors' rows of P before each angle."""


def blank_tape(n: int) -> Tape:
    """Return a tape for so many frames, to be used again: new memory takes longer than to fill."""
    shapes = (STATES,), (STATES, MEANS), (3, STATES), (3, 5), (3, 3, STATES)
    return Tape(*(np.zeros((n, *shape)) for shape in shapes))


@kernel
def filtered(
    angles: Array,
    loads: Array,
    gaps: Array,
    movement: Frames,
    deviations: Array,
    rates: Array,
    error: float,
    error_memory: float,
    posture: float,
    floor: float,
    tape: Tape,
) -> float:
    """Return the negative logarithm of the likelihood of three angles, less a constant.

    See `kinesphere.parameterization.axes.process_slopes.surprise`; ``rates``, (3,) 1/s, are √5 over
    the memories.
    """
    before, halves, rows, seen, errors = tape
    n = len(angles)
    state = np.zeros(STATES)
    p = np.zeros((STATES, STATES))
    still = np.zeros((3, 3, 3))
    move = np.zeros((3, 3, 3))
    for k in range(3):
        stationary(still[k], deviations[0, k], rates[k])
        p[3 * k : 3 * k + 3, 3 * k : 3 * k + 3] = still[k]
        p[ERRORS + k, ERRORS + k] = error**2
        p[MEANS + k, MEANS + k] = _VAGUE
    half = np.zeros((STATES, STATES))
    total, keep, last = 0.0, 0.0, -1.0
    for f in range(n):
        if f > 0:
            if gaps[f - 1] != last:
                last = gaps[f - 1]
                keep = np.exp(-last / error_memory)
                for k in range(3):
                    transition(move[k], rates[k], last)
            before[f, :] = state
            _foretell(state, p, half, still, move, keep, error**2)
            for i in range(STATES):
                for j in range(MEANS):
                    halves[f, i, j] = half[i, j]
            if movement[f] != movement[f - 1]:
                for k in range(3):
                    stationary(still[k], deviations[movement[f], k], rates[k])
                    _begin_anew(state, p, 3 * k, still[k])
                    p[MEANS + k, MEANS + k] += posture**2
        for k in range(3):
            b, m, row = 3 * k, MEANS + k, rows[f, k]
            expected = state[b] + state[m]
            for j in range(STATES):
                row[j] = p[b, j] + p[m, j]
                for i in range(3):
                    row[j] += loads[f, k, i] * p[ERRORS + i, j]
            variance = floor + row[b] + row[m]
            for i in range(3):
                expected += loads[f, k, i] * state[ERRORS + i]
                variance += loads[f, k, i] * row[ERRORS + i]
                seen[f, k, 2 + i] = state[ERRORS + i]
                for j in range(STATES):
                    errors[f, k, i, j] = p[ERRORS + i, j]
            off = angles[f, k] - expected
            seen[f, k, 0], seen[f, k, 1] = variance, off
            total += 0.5 * (off * off / variance + np.log(variance))
            for i in range(STATES):
                gain = row[i] / variance
                state[i] += gain * off
                for j in range(STATES):
                    p[i, j] -= gain * row[j]
    return total


@kernel
def stationary(c: Array, deviation: float, rate: float) -> None:
    """Write the covariance of a Matérn 5/2 process and its first two derivatives, (3, 3)."""
    size = deviation**2
    c[0, 0] = size
    c[1, 1] = size * rate**2 / 3
    c[0, 2] = c[2, 0] = -c[1, 1]
    c[2, 2] = size * rate**4


@kernel
def _begin_anew(state: Array, p: Array, b: int, still: Array) -> None:
    """Forget what the process at ``b`` has been doing."""
    state[b : b + 3] = 0.0
    p[b : b + 3] = 0.0
    p[:, b : b + 3] = 0.0
    p[b : b + 3, b : b + 3] = still


@kernel
def transition(a: Array, rate: float, dt: float) -> None:
    """Write what a Matérn 5/2 process keeps of itself over ``dt`` seconds, (3, 3)."""
    e, k = np.exp(-rate * dt), rate * dt
    a[0, 0] = e * (1 + k + k * k / 2)
    a[0, 1] = e * dt * (1 + k)
    a[0, 2] = e * dt * dt / 2
    a[1, 0] = -e * rate * k * k / 2
    a[1, 1] = e * (1 + k - k * k)
    a[1, 2] = e * dt * (1 - k / 2)
    a[2, 0] = e * rate**2 * k * (k / 2 - 1)
    a[2, 1] = e * rate * k * (k - 3)
    a[2, 2] = e * (1 - 2 * k + k * k / 2)


@kernel
def _foretell(
    state: Array, p: Array, half: Array, still: Array, move: Array, keep: float, error: float
) -> None:
    """Carry state and covariance on in time: A x, and A (P − P∞) Aᵀ + P∞."""
    for k in range(3):
        b = 3 * k
        for i in range(3):
            for j in range(3):
                p[b + i, b + j] -= still[k, i, j]
        p[ERRORS + k, ERRORS + k] -= error
    for k in range(3):
        b, a = 3 * k, move[k]
        for i in range(3):
            for j in range(STATES):
                half[b + i, j] = a[i, 0] * p[b, j] + a[i, 1] * p[b + 1, j] + a[i, 2] * p[b + 2, j]
        for j in range(STATES):
            half[ERRORS + k, j] = keep * p[ERRORS + k, j]
            half[MEANS + k, j] = p[MEANS + k, j]
    for k in range(3):
        b, a, e, m = 3 * k, move[k], ERRORS + k, MEANS + k
        for i in range(STATES):
            for j in range(3):
                p[i, b + j] = (
                    half[i, b] * a[j, 0] + half[i, b + 1] * a[j, 1] + half[i, b + 2] * a[j, 2]
                )
            p[i, e] = keep * half[i, e]
            p[i, m] = half[i, m]
        x, y, z = state[b], state[b + 1], state[b + 2]
        for i in range(3):
            state[b + i] = a[i, 0] * x + a[i, 1] * y + a[i, 2] * z
        state[e] *= keep
    for k in range(3):
        b = 3 * k
        for i in range(3):
            for j in range(3):
                p[b + i, b + j] += still[k, i, j]
        p[ERRORS + k, ERRORS + k] += error
