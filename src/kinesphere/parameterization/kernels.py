"""The two-circle solution for every frame, and the path through its two branches."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Mask
from kinesphere.kernels.jit import kernel

Branches = NDArray[np.int8]

MOST_CHANGE = 3.0  # rad, what the changes of a step may cost at most
APART = 4.0  # rad of the three angles: branches that differ by more do not meet in this step,
# however noisy it is; past a singularity 3° of correlated noise keep them 3.3 apart


@kernel
def two_axis_solutions(
    rotations: Array, distal: Array, proximal: Array, rest: Array, long_axis: Array
) -> tuple[Array, Array, Array]:
    """Return both solutions of ``R(proximal, θ2) R(distal, θ1) R(r, τ) rest ≈ rotations[i]``.

    Parameters
    ----------
    rotations : (n, 3, 3)
        NaN gives NaN.
    distal, proximal : (3,)
        Unit axes in the parent, not parallel.
    rest : (3, 3)
    long_axis : (3,)
        In the child.

    Returns
    -------
    solutions : (n, 2, 3)
        θ1, θ2, τ in rad; branch 0 lies on the rest position's side of the axes' plane.
    sines : (n,)
        Sine of the angle between the intermediate position and the plane of the axes, ≥ 0.
    excess : (n,)
        rad by which the limb's colatitude about the proximal axis misses what can be reached.
    """
    n = rotations.shape[0]
    solutions = np.empty((n, 2, 3))
    sines = np.empty(n)
    excess = np.empty(n)
    r = np.empty(3)
    for i in range(3):
        r[i] = rest[i, 0] * long_axis[0] + rest[i, 1] * long_axis[1] + rest[i, 2] * long_axis[2]
    k = distal[0] * proximal[0] + distal[1] * proximal[1] + distal[2] * proximal[2]
    normal = np.empty(3)
    normal[0] = distal[1] * proximal[2] - distal[2] * proximal[1]
    normal[1] = distal[2] * proximal[0] - distal[0] * proximal[2]
    normal[2] = distal[0] * proximal[1] - distal[1] * proximal[0]
    nu = normal[0] ** 2 + normal[1] ** 2 + normal[2] ** 2
    r1 = distal[0] * r[0] + distal[1] * r[1] + distal[2] * r[2]
    side = 1.0
    if r[0] * normal[0] + r[1] * normal[1] + r[2] * normal[2] < 0.0:
        side = -1.0
    psi = np.arctan2(np.sqrt(nu), k)
    phi = np.arccos(min(1.0, max(-1.0, r1)))
    nearest = abs(psi - phi)
    farthest = min(psi + phi, 2.0 * np.pi - psi - phi)
    p = np.empty(3)
    x = np.empty(3)
    swung = np.empty((3, 3))
    for f in range(n):
        q = rotations[f]
        for i in range(3):
            p[i] = q[i, 0] * long_axis[0] + q[i, 1] * long_axis[1] + q[i, 2] * long_axis[2]
        height = proximal[0] * p[0] + proximal[1] * p[1] + proximal[2] * p[2]
        if np.isnan(height):
            solutions[f] = np.nan
            sines[f] = np.nan
            excess[f] = np.nan
            continue
        # atan2 keeps full precision near the poles, where arccos does not
        cx = proximal[1] * p[2] - proximal[2] * p[1]
        cy = proximal[2] * p[0] - proximal[0] * p[2]
        cz = proximal[0] * p[1] - proximal[1] * p[0]
        colatitude = np.arctan2(np.sqrt(cx * cx + cy * cy + cz * cz), height)
        excess[f] = max(0.0, nearest - colatitude, colatitude - farthest)
        alpha = (r1 - k * height) / nu
        beta = (height - k * r1) / nu
        rest_of = (1.0 - alpha * alpha - beta * beta - 2.0 * alpha * beta * k) / nu
        # circles that miss leave x in the plane of the axes, of the azimuths that come nearest
        gamma = side * np.sqrt(max(0.0, rest_of))
        sines[f] = abs(gamma) * np.sqrt(nu)
        for branch in range(2):
            g = gamma if branch == 0 else -gamma
            for i in range(3):
                x[i] = alpha * distal[i] + beta * proximal[i] + g * normal[i]
            theta1 = angle_about(distal, r, x)
            theta2 = angle_about(proximal, x, p)
            swing(distal, theta1, proximal, theta2, rest, swung)
            solutions[f, branch, 0] = theta1
            solutions[f, branch, 1] = theta2
            solutions[f, branch, 2] = twist_between(swung, q, long_axis)
    return solutions, sines, excess


@kernel
def angle_about(axis: Array, source: Array, target: Array) -> float:
    """Return the angle about a unit axis that takes one (3,) vector's azimuth to another's, rad."""
    cross = (
        axis[0] * (source[1] * target[2] - source[2] * target[1])
        + axis[1] * (source[2] * target[0] - source[0] * target[2])
        + axis[2] * (source[0] * target[1] - source[1] * target[0])
    )
    s = axis[0] * source[0] + axis[1] * source[1] + axis[2] * source[2]
    t = axis[0] * target[0] + axis[1] * target[1] + axis[2] * target[2]
    dot = source[0] * target[0] + source[1] * target[1] + source[2] * target[2]
    return float(np.arctan2(cross, dot - s * t))


@kernel
def swing(
    distal: Array, theta1: float, proximal: Array, theta2: float, rest: Array, out: Array
) -> None:
    """Write ``R(proximal, θ2) R(distal, θ1) rest`` into ``out`` (3, 3), column by column."""
    s1, c1 = np.sin(theta1), np.cos(theta1)
    s2, c2 = np.sin(theta2), np.cos(theta2)
    for j in range(3):
        x, y, z = rest[0, j], rest[1, j], rest[2, j]
        x, y, z = turned(distal, s1, c1, x, y, z)
        x, y, z = turned(proximal, s2, c2, x, y, z)
        out[0, j] = x
        out[1, j] = y
        out[2, j] = z


@kernel
def turned(
    axis: Array, s: float, c: float, x: float, y: float, z: float
) -> tuple[float, float, float]:
    """Return a vector turned about a unit axis (Rodrigues)."""
    a, b, d = axis[0], axis[1], axis[2]
    along = (a * x + b * y + d * z) * (1.0 - c)
    return (
        c * x + s * (b * z - d * y) + a * along,
        c * y + s * (d * x - a * z) + b * along,
        c * z + s * (a * y - b * x) + d * along,
    )


@kernel
def twist_between(model: Array, actual: Array, long_axis: Array) -> float:
    """Return the twist in rad about the limb that best takes one orientation to another.

    With ``A`` the model, ``B`` the actual orientation and ``N = Aᵀ B`` seen in the limb, where the
    twist axis is the long axis u itself: ``τ = atan2(u·v(N), tr N − uᵀ N u)``.
    """
    n = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            n[i, j] = (
                model[0, i] * actual[0, j] + model[1, i] * actual[1, j] + model[2, i] * actual[2, j]
            )
    sine = (
        long_axis[0] * (n[2, 1] - n[1, 2])
        + long_axis[1] * (n[0, 2] - n[2, 0])
        + long_axis[2] * (n[1, 0] - n[0, 1])
    )
    along = 0.0
    for i in range(3):
        for j in range(3):
            along += long_axis[i] * n[i, j] * long_axis[j]
    return float(np.arctan2(sine, n[0, 0] + n[1, 1] + n[2, 2] - along))


@kernel
def smoothest_branches(
    solutions: Array, twist_known: Mask, own: Array, leap: float, nearby: int
) -> Branches:
    """Return the branch of every frame on the cheapest path (Viterbi, two states).

    A step costs the sum of the wrapped changes of θ1, θ2 and twist, at most 3 rad. Where keeping
    to the branches and changing them are 4 rad apart on the mean, the limb is not at a
    singularity, and the worse of the two costs ``leap`` more: noise while standing must not buy
    it. Frames of NaN are stepped over; past more than ``nearby`` frames the limb may have passed
    a singularity unseen, and no leap is told.

    Parameters
    ----------
    solutions : (n, 2, 3) rad
    twist_known : (n,) bool
    own : (n, 2)
        What each branch costs in each frame by itself, rad.
    leap : rad
    nearby
        Steps.

    Returns
    -------
    (n,) int8
        0 or 1; 0 where NaN.
    """
    n = solutions.shape[0]
    chosen = np.zeros(n, dtype=np.int8)
    origin = np.zeros((n, 2), dtype=np.int8)
    previous = np.full(n, -1, dtype=np.int64)
    cost = np.zeros(2)
    new = np.zeros(2)
    change = np.zeros((2, 2))
    last = -1
    for f in range(n):
        if np.isnan(solutions[f, 0, 0]):
            continue
        leap_to_same = leap_to_other = 0.0
        if last >= 0:
            parts = 3 if twist_known[f] and twist_known[last] else 2
            for a in range(2):
                for b in range(2):
                    change[a, b] = 0.0
                    for i in range(parts):
                        d = abs(solutions[f, b, i] - solutions[last, a, i])
                        change[a, b] += min(d, 2.0 * np.pi - d)
            keeping_less = change[0, 1] + change[1, 0] - change[0, 0] - change[1, 1]
            if f - last > nearby:
                leap_to_same = leap_to_other = 0.0
            elif keeping_less > 2.0 * APART * parts / 3.0:
                leap_to_other = leap
            elif -keeping_less > 2.0 * APART * parts / 3.0:
                leap_to_same = leap
        for b in range(2):
            if last < 0:
                new[b] = own[f, b]
                continue
            cheapest = np.inf
            for a in range(2):
                total = cost[a] + min(change[a, b], MOST_CHANGE)
                total += leap_to_same if a == b else leap_to_other
                if total < cheapest:
                    cheapest = total
                    origin[f, b] = a
            new[b] = cheapest + own[f, b]
        cost[0], cost[1] = new[0], new[1]
        previous[f] = last
        last = f
    state = 0 if cost[0] <= cost[1] else 1
    while last >= 0:
        chosen[last] = state
        state = int(origin[last, state])
        last = previous[last]
    return chosen
