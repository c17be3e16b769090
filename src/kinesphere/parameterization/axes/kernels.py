"""The likelihood of a joint's angles as processes in time, and how fast a limb twists."""

import numpy as np

from kinesphere.data import Array
from kinesphere.kernels.jit import kernel
from kinesphere.parameterization.samples import Frames

_ERRORS = 9  # states: each angle with its first two derivatives, then errors, then means
_MEANS = 12
_STATES = 15
_VAGUE = 1.0  # rad², of the angles' means


@kernel
def surprise(
    angles: Array,
    loads: Array,
    gaps: Array,
    deviations: Array,
    memories: Array,
    error: float,
    error_memory: float,
    floor: float,
) -> float:
    """Return the negative logarithm of the likelihood of three angles over time, less a constant.

    Each angle is a smooth Gaussian process about a mean of its own (Matérn 5/2); the error of a
    pose is an Ornstein–Uhlenbeck process about each of three axes, which spoils all three angles.

    Parameters
    ----------
    angles : (n, 3) rad
    loads : (n, 3, 3)
        How each angle, first index, depends on the error about each axis.
    gaps : (n - 1,)
        s between frames.
    deviations, memories : (3,)
        rad and s, of each angle's process.
    error, error_memory
        rad and s.
    floor
        rad², variance that every angle has besides.

    References
    ----------
    Hartikainen & Särkkä (2010), doi:10.1109/MLSP.2010.5589113, for the processes as states.
    """
    state = np.zeros(_STATES)
    p = np.zeros((_STATES, _STATES))
    still = np.zeros((3, 3, 3))
    move = np.zeros((3, 3, 3))
    for k in range(3):
        _stationary(still[k], deviations[k], np.sqrt(5.0) / memories[k])
        p[3 * k : 3 * k + 3, 3 * k : 3 * k + 3] = still[k]
        p[_ERRORS + k, _ERRORS + k] = error**2
        p[_MEANS + k, _MEANS + k] = _VAGUE
    half = np.zeros((_STATES, _STATES))
    row = np.empty(_STATES)
    total, keep, before = 0.0, 0.0, -1.0
    for f in range(len(angles)):
        if f > 0:
            if gaps[f - 1] != before:
                before = gaps[f - 1]
                keep = np.exp(-before / error_memory)
                for k in range(3):
                    _transition(move[k], np.sqrt(5.0) / memories[k], before)
            _foretell(state, p, half, still, move, keep, error**2)
        for k in range(3):
            b, m = 3 * k, _MEANS + k
            seen = state[b] + state[m]
            for j in range(_STATES):
                row[j] = p[b, j] + p[m, j]
                for i in range(3):
                    row[j] += loads[f, k, i] * p[_ERRORS + i, j]
            variance = floor + row[b] + row[m]
            for i in range(3):
                seen += loads[f, k, i] * state[_ERRORS + i]
                variance += loads[f, k, i] * row[_ERRORS + i]
            off = angles[f, k] - seen
            total += 0.5 * (off * off / variance + np.log(variance))
            for i in range(_STATES):
                gain = row[i] / variance
                state[i] += gain * off
                for j in range(_STATES):
                    p[i, j] -= gain * row[j]
    return total


@kernel
def _stationary(c: Array, deviation: float, rate: float) -> None:
    """Write the covariance of a Matérn 5/2 process and its first two derivatives, (3, 3)."""
    size = deviation**2
    c[0, 0] = size
    c[1, 1] = size * rate**2 / 3
    c[0, 2] = c[2, 0] = -c[1, 1]
    c[2, 2] = size * rate**4


@kernel
def _transition(a: Array, rate: float, dt: float) -> None:
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
        p[b : b + 3, b : b + 3] -= still[k]
        p[_ERRORS + k, _ERRORS + k] -= error
    for k in range(3):
        b, a = 3 * k, move[k]
        for i in range(3):
            for j in range(_STATES):
                half[b + i, j] = a[i, 0] * p[b, j] + a[i, 1] * p[b + 1, j] + a[i, 2] * p[b + 2, j]
        for j in range(_STATES):
            half[_ERRORS + k, j] = keep * p[_ERRORS + k, j]
            half[_MEANS + k, j] = p[_MEANS + k, j]
    for k in range(3):
        b, a, e, m = 3 * k, move[k], _ERRORS + k, _MEANS + k
        for i in range(_STATES):
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
        p[b : b + 3, b : b + 3] += still[k]
        p[_ERRORS + k, _ERRORS + k] += error


@kernel
def turned_between(rotations: Array, before: Frames, after: Frames) -> Array:
    """Return how far something turns from one frame to another, (n,) rad.

    Parameters
    ----------
    rotations : (n_frames, 3, 3)
        NaN gives NaN.
    before, after : (n,)
        Frames from which and to which it turns.
    """
    n = len(before)
    turned = np.empty(n)
    for f in range(n):
        a, b = rotations[before[f]], rotations[after[f]]
        chord = 0.0
        for i in range(3):
            for j in range(3):
                chord += (b[i, j] - a[i, j]) ** 2
        # the chord is precise for small angles, where the trace is not
        sine = np.sqrt(chord / 8.0)
        turned[f] = np.pi if sine > 1.0 else 2.0 * np.arcsin(sine)
    return turned
