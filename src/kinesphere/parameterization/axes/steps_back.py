"""The steps of a filter of processes taken backwards: each adds to slopes by what went into it."""

import numpy as np

from kinesphere.data import Array
from kinesphere.kernels.jit import kernel
from kinesphere.parameterization.axes.process_kernels import ERRORS, MEANS, STATES


@kernel
def take_back(
    k: int,
    load: Array,
    row: Array,
    seen: Array,
    errors: Array,
    by_state: Array,
    by_p: Array,
    by_row: Array,
    by_angle: Array,
    by_load: Array,
) -> None:
    """Take back what the filter made of one angle."""
    variance, off = seen[0], seen[1]
    b, m = 3 * k, MEANS + k
    along, across = 0.0, 0.0
    for i in range(STATES):
        turned = 0.0
        for j in range(STATES):
            turned += by_p[i, j] * row[j]
        along += by_state[i] * row[i]
        across += turned * row[i]
        by_row[i] = (by_state[i] * off - 2.0 * turned) / variance
    by_off = (off + along) / variance
    by_variance = (0.5 * (variance - off * off) - along * off + across) / variance**2
    by_angle[k] += by_off
    by_row[b] += by_variance
    by_row[m] += by_variance
    by_state[b] -= by_off
    by_state[m] -= by_off
    for i in range(3):
        e = ERRORS + i
        by_load[i] += by_variance * row[e] - by_off * seen[2 + i]
        by_row[e] += by_variance * load[i]
        by_state[e] -= by_off * load[i]
    for i in range(3):
        for j in range(STATES):
            by_load[i] += errors[i, j] * by_row[j]
    for j in range(STATES):
        x = 0.5 * by_row[j]
        by_p[b, j] += x
        by_p[j, b] += x
        by_p[m, j] += x
        by_p[j, m] += x
        for i in range(3):
            by_p[ERRORS + i, j] += load[i] * x
            by_p[j, ERRORS + i] += load[i] * x


@kernel
def foretell_back(by_state: Array, by_p: Array, half: Array, move: Array, keep: float) -> None:
    """Carry slopes back in time: Aᵀ x and Aᵀ P A."""
    for k in range(3):
        b, a, e, m = 3 * k, move[k], ERRORS + k, MEANS + k
        for j in range(STATES):
            for i in range(3):
                half[b + i, j] = (
                    a[0, i] * by_p[b, j] + a[1, i] * by_p[b + 1, j] + a[2, i] * by_p[b + 2, j]
                )
            half[e, j] = keep * by_p[e, j]
            half[m, j] = by_p[m, j]
        x, y, z = by_state[b], by_state[b + 1], by_state[b + 2]
        for i in range(3):
            by_state[b + i] = a[0, i] * x + a[1, i] * y + a[2, i] * z
        by_state[e] *= keep
    for k in range(3):
        b, a, e, m = 3 * k, move[k], ERRORS + k, MEANS + k
        for i in range(STATES):
            x, y, z = half[i, b], half[i, b + 1], half[i, b + 2]
            for j in range(3):
                by_p[i, b + j] = x * a[0, j] + y * a[1, j] + z * a[2, j]
            by_p[i, e] = keep * half[i, e]
            by_p[i, m] = half[i, m]


@kernel
def add_block(by_still: Array, by_p: Array, b: int, times: float) -> None:
    """Add the block at ``b`` of the slopes by a covariance, so many times."""
    for i in range(3):
        for j in range(3):
            by_still[i, j] += times * by_p[b + i, b + j]


@kernel
def by_size(
    k: int, by_still: Array, deviation: float, rate: float, by_deviation: Array, by_rates: Array
) -> None:
    """Add what a stationary covariance tells of its deviation and rate; begin anew with it."""
    middle = (by_still[1, 1] - by_still[0, 2] - by_still[2, 0]) / 3.0
    size = by_still[0, 0] + middle * rate**2  # how accelerations vary no angle shows
    by_deviation[k] += 2.0 * deviation * size
    by_rates[k] += deviation**2 * 2.0 * middle * rate
    by_still[:] = 0.0


@kernel
def by_course(by_move: Array, by_rates: Array, rates: Array, dt: float) -> None:
    """Add what a process keeps of itself over ``dt`` seconds tells of its rate; begin anew."""
    for c in range(3):
        rate, g = rates[c], by_move[c]
        k = rate * dt
        e = np.exp(-k)
        slope = -dt * k * k / 2 * g[0, 0] - dt * dt * k * g[0, 1] - dt**3 / 2 * g[0, 2]
        slope += k * k / 2 * (k - 3) * g[1, 0] + dt * k * (k - 3) * g[1, 1]
        slope += dt * dt / 2 * (k - 3) * g[1, 2] + rate * k * (3 * k - 3 - k * k / 2) * g[2, 0]
        slope += k * (6 * k - 6 - k * k) * g[2, 1] + dt * (3 * k - 3 - k * k / 2) * g[2, 2]
        by_rates[c] += e * slope
    by_move[:] = 0.0
