"""Numba of the default labeller: handedness of quadruples, cost of pairs, exchange of labels.

Arrays in, arrays out. A point without a label has −1, a label without a point as well.
"""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.geometry.handedness import FULL, handedness_of
from kinesphere.kernels.jit import kernel

Single = NDArray[np.float32]
Indices = NDArray[np.int64]
Signs = NDArray[np.int8]

_SOFT = 6.0
"""z / (1 + z / 6): no single pair, however wrong, outweighs six that fit."""
BASE = 0.5
"""Agreement of a quadruple that earns nothing: less is a cost, more a reward. With 0 labels that
have many stable quadruples attract points of their neighbours that are missing, with 1 labels that
have few of them do; both measure worse where markers are missing."""


@kernel
def _share(log_std: float) -> float:
    """Return what the mean of a distance with this logarithm of its deviation may be off by."""
    std = max(np.exp(log_std) - 0.01, 0.0)
    return float(0.6 * std * std)


@kernel
def pair_costs(
    mean: Array,
    log_std: Array,
    variance: Array,
    weight: Array,
    expected: Array,
    expected_variance: Array,
    expected_log: Array,
    log_variance: Array,
    stiller: float,
    outlier: float,
    costs: Single,
) -> None:
    """Fill the cost of every two points bearing every two labels.

    Parameters
    ----------
    mean, log_std, variance, weight : (n_points, n_points)
        Of the recording: mean distance, log of its deviation, what the mean may be off by
        (squared), and how much the pair counts (0 where never seen together).
    expected, expected_variance, expected_log, log_variance : (n_labels, n_labels)
        Of the template; NaN where it knows nothing of a pair.
    stiller
        What a deviation below the expected one counts, beside one above it.
    outlier
        What a pair costs about which nothing is known: the zero of all costs.
    costs : (n_points, n_labels, n_points, n_labels)
    """
    n, m = mean.shape[0], expected.shape[0]
    for k in range(n):
        for p in range(n):
            if k == p or not weight[k, p] > 0:
                continue
            for i in range(m):
                for j in range(m):
                    mu = expected[i, j]
                    if i == j or not np.isfinite(mu):
                        continue
                    v = expected_variance[i, j] + variance[k, p]
                    x = (mean[k, p] - mu) ** 2 / (2 * v)
                    y = (log_std[k, p] - expected_log[i, j]) ** 2 / (2 * log_variance[i, j])
                    if log_std[k, p] < expected_log[i, j]:
                        y *= stiller
                    usual = expected_variance[i, j] + _share(expected_log[i, j])
                    cost = x / (1 + x / _SOFT) + y / (1 + y / _SOFT) + 0.5 * np.log(v / usual)
                    costs[k, i, p, j] = weight[k, p] * (cost - outlier)


@kernel
def handed_energy(
    holder: Indices, quads: Indices, wanted: Array, table: Signs, only: Indices
) -> float:
    """Return the agreement of quadruples of labels with the points that hold them, negative.

    Parameters
    ----------
    holder : (n_labels,)
        The point that bears each label.
    quads : (n_quads, 4)
        Labels.
    wanted : (n_quads,)
        Handedness times weight.
    only : (n,)
        Which quadruples to look at.
    """
    energy = 0.0
    for q in only:
        a, b, c, d = (
            holder[quads[q, 0]],
            holder[quads[q, 1]],
            holder[quads[q, 2]],
            holder[quads[q, 3]],
        )
        if a >= 0 and b >= 0 and c >= 0 and d >= 0:
            energy += BASE * abs(wanted[q]) - wanted[q] * handedness_of(table, a, b, c, d) / FULL
    return energy


@kernel
def linear_terms(labels: Indices, costs: Single) -> Array:
    """Return (n_points, n_labels): what each point would cost with each label beside the others."""
    n, m = costs.shape[0], costs.shape[1]
    terms = np.zeros((n, m))
    for p in range(n):
        j = labels[p]
        if j >= 0:
            for k in range(n):
                for i in range(m):
                    terms[k, i] += costs[k, i, p, j]
    return terms


@kernel
def pair_energy(labels: Indices, costs: Single) -> float:
    """Return the cost of all pairs of labelled points."""
    total = 0.0
    n = labels.shape[0]
    for k in range(n):
        i = labels[k]
        if i >= 0:
            for p in range(k + 1, n):
                j = labels[p]
                if j >= 0:
                    total += costs[k, i, p, j]
    return total


@kernel
def exchange_gain(
    labels: Indices,
    holder: Indices,
    terms: Array,
    costs: Single,
    quads: Indices,
    wanted: Array,
    table: Signs,
    of_label: Indices,
    n_of_label: Indices,
    room_of: Array,
    a: int,
    j: int,
    bound: float,
) -> float:
    """Return what the energy changes by if point a takes label j and its holder a's label.

    With j = −1 point a loses its label. Changes that cannot be below ``bound`` are not computed to
    the end.
    """
    i = labels[a]
    b = holder[j] if j >= 0 else -1
    change = 0.0
    room = 0.0
    if i >= 0:
        change -= terms[a, i]
        room += room_of[i]
    if j >= 0:
        change += terms[a, j]
        room += room_of[j]
    if b >= 0:
        change -= terms[b, j]
        if i >= 0:
            change += terms[b, i] + costs[a, i, b, j] + costs[a, j, b, i]
    if change - room >= bound:
        return change
    before = 0.0
    after = 0.0
    if i >= 0:
        only = of_label[i, : n_of_label[i]]
        before += handed_energy(holder, quads, wanted, table, only)
    if j >= 0:
        only = of_label[j, : n_of_label[j]]
        before += _without(holder, quads, wanted, table, only, i)
    if i >= 0:
        holder[i] = b
    if j >= 0:
        holder[j] = a
    if i >= 0:
        only = of_label[i, : n_of_label[i]]
        after += handed_energy(holder, quads, wanted, table, only)
    if j >= 0:
        only = of_label[j, : n_of_label[j]]
        after += _without(holder, quads, wanted, table, only, i)
    if i >= 0:
        holder[i] = a
    if j >= 0:
        holder[j] = b
    return change + after - before


@kernel
def _without(
    holder: Indices, quads: Indices, wanted: Array, table: Signs, only: Indices, label: int
) -> float:
    """Return the energy of quadruples, leaving out those with one label: counted already."""
    energy = 0.0
    for q in only:
        if (
            quads[q, 0] == label
            or quads[q, 1] == label
            or quads[q, 2] == label
            or quads[q, 3] == label
        ):
            continue
        a, b, c, d = (
            holder[quads[q, 0]],
            holder[quads[q, 1]],
            holder[quads[q, 2]],
            holder[quads[q, 3]],
        )
        if a >= 0 and b >= 0 and c >= 0 and d >= 0:
            energy += BASE * abs(wanted[q]) - wanted[q] * handedness_of(table, a, b, c, d) / FULL
    return energy


@kernel
def exchange(labels: Indices, holder: Indices, terms: Array, costs: Single, a: int, j: int) -> None:
    """Let point a take label j (−1: none) and its holder a's label; keep ``terms`` true."""
    i = labels[a]
    b = holder[j] if j >= 0 else -1
    n, m = costs.shape[0], costs.shape[1]
    for k in range(n):
        for t in range(m):
            change = 0.0
            if j >= 0:
                change += costs[k, t, a, j]
            if i >= 0:
                change -= costs[k, t, a, i]
            if b >= 0:
                change -= costs[k, t, b, j]
                if i >= 0:
                    change += costs[k, t, b, i]
            terms[k, t] += change
    labels[a] = j
    if i >= 0:
        holder[i] = b
    if j >= 0:
        holder[j] = a
    if b >= 0:
        labels[b] = i


@kernel
def room_to_agree(
    holder: Indices,
    quads: Indices,
    wanted: Array,
    table: Signs,
    of_label: Indices,
    n_of_label: Indices,
    room_of: Array,
) -> None:
    """Fill how much better the quadruples of each label could agree at most, (n_labels,)."""
    for i in range(holder.shape[0]):
        only = of_label[i, : n_of_label[i]]
        room = handed_energy(holder, quads, wanted, table, only)
        for q in only:
            room += (1 - BASE) * abs(wanted[q])
        room_of[i] = room


@kernel
def descend(
    labels: Indices,
    holder: Indices,
    costs: Single,
    quads: Indices,
    wanted: Array,
    table: Signs,
    of_label: Indices,
    n_of_label: Indices,
    points: Indices,
    targets: Indices,
    nullable: bool,
) -> int:
    """Exchange labels as long as that lowers the energy, the steepest exchange first.

    Parameters
    ----------
    labels, holder
        Changed in place.
    of_label, n_of_label : (n_labels, n), (n_labels,)
        Quadruples that hold each label.
    points, targets
        Which points may change, and to which labels; holders of targets must be among the points.
    nullable
        Whether a point may lose its label.

    Returns
    -------
    How many exchanges were made.
    """
    terms = linear_terms(labels, costs)
    room_of = np.zeros(holder.shape[0])
    most = 40 * len(points)
    for count in range(most):
        room_to_agree(holder, quads, wanted, table, of_label, n_of_label, room_of)
        best, best_a, best_j = -1e-6, -1, -1
        for a in points:
            i = labels[a]
            for x in range(-1 if nullable and i >= 0 else 0, len(targets)):
                j = targets[x] if x >= 0 else -1
                if j == i:
                    continue
                b = holder[j] if j >= 0 else -1
                if b >= 0 and i >= 0 and b < a:
                    continue  # the same exchange, seen from the other side
                gain = exchange_gain(
                    labels, holder, terms, costs, quads, wanted, table, of_label, n_of_label,
                    room_of, a, j, best,
                )  # fmt: skip
                if gain < best:
                    best, best_a, best_j = gain, a, j
        if best_a < 0:
            return count
        exchange(labels, holder, terms, costs, best_a, best_j)
    return most


@kernel
def least_changes(
    labels: Indices,
    holder: Indices,
    costs: Single,
    quads: Indices,
    wanted: Array,
    table: Signs,
    of_label: Indices,
    n_of_label: Indices,
    into_free: float,
    least: Array,
    rival: Indices,
) -> None:
    """Fill how much the energy rises at least when a point loses its label to another, (n_points,).

    ``rival`` is the label that would take its place; a rise into a label that nobody bears counts
    ``into_free`` times.
    """
    n, m = costs.shape[0], costs.shape[1]
    terms = linear_terms(labels, costs)
    room_of = np.zeros(m)
    for a in range(n):
        i = labels[a]
        for j in range(m):
            if j == i:
                continue
            b = holder[j]
            if i < 0 and b < 0:
                continue
            rise = exchange_gain(
                labels, holder, terms, costs, quads, wanted, table, of_label, n_of_label, room_of,
                a, j, np.inf,
            )  # fmt: skip
            if b < 0:
                rise *= into_free
            if rise < least[a]:
                least[a], rival[a] = rise, j
            if b >= 0 and rise < least[b]:
                least[b], rival[b] = rise, i


@kernel
def block_energies(
    labels: Indices,
    moves: NDArray[np.int64],
    costs: Single,
    quads: Indices,
    wanted: Array,
    table: Signs,
    every: Indices,
    energies: Array,
) -> None:
    """Fill the energy after one block move, or two in turn, (n_moves, n_moves).

    Parameters
    ----------
    moves : (n_moves, n_labels)
        Permutations of the labels. The diagonal of ``energies`` is for one move alone; above it,
        two in turn; below it nothing changes.
    """
    n_moves, m = moves.shape
    n = labels.shape[0]
    tried = labels.copy()
    holder = np.full(m, -1, dtype=np.int64)
    for x in range(n_moves):
        for y in range(x, n_moves):
            holder[:] = -1
            for k in range(n):
                i = labels[k]
                if i >= 0:
                    i = moves[x, i]
                    if y > x:
                        i = moves[y, i]
                    holder[i] = k
                tried[k] = i
            energies[x, y] = pair_energy(tried, costs) + handed_energy(
                holder, quads, wanted, table, every
            )


@kernel
def move_energies(
    labels: Indices,
    moves: Indices,
    costs: Single,
    quads: Indices,
    wanted: Array,
    table: Signs,
    every: Indices,
    energies: Array,
) -> None:
    """Fill the energy after each block move by itself, (n_moves,)."""
    n_moves, m = moves.shape
    tried = labels.copy()
    holder = np.full(m, -1, dtype=np.int64)
    for x in range(n_moves):
        holder[:] = -1
        for k in range(labels.shape[0]):
            i = labels[k]
            if i >= 0:
                i = moves[x, i]
                holder[i] = k
            tried[k] = i
        energies[x] = pair_energy(tried, costs) + handed_energy(holder, quads, wanted, table, every)


@kernel
def anneal(
    labels: Indices,
    holder: Indices,
    costs: Single,
    quads: Indices,
    wanted: Array,
    table: Signs,
    of_label: Indices,
    n_of_label: Indices,
    draws: Array,
    hot: float,
    cold: float,
) -> None:
    """Exchange labels at random, the less willingly upward the later (simulated annealing).

    Parameters
    ----------
    labels, holder
        Changed in place; where the walk ends.
    draws : (n_steps, 3)
        Uniform random numbers, 0…1.
    hot, cold
        Temperatures at the start and the end, in units of energy.
    """
    n, m = costs.shape[0], costs.shape[1]
    terms = linear_terms(labels, costs)
    room_of = np.zeros(m)
    n_steps = draws.shape[0]
    cooling = (cold / hot) ** (1.0 / n_steps)
    heat = hot
    for step in range(n_steps):
        heat *= cooling
        if step % n == 0:
            room_to_agree(holder, quads, wanted, table, of_label, n_of_label, room_of)
        a = int(draws[step, 0] * n)
        j = int(draws[step, 1] * m)
        if labels[a] == j:
            continue
        bound = -heat * np.log(max(draws[step, 2], 1e-300))
        gain = exchange_gain(
            labels, holder, terms, costs, quads, wanted, table, of_label, n_of_label, room_of,
            a, j, bound,
        )  # fmt: skip
        if gain < bound:
            exchange(labels, holder, terms, costs, a, j)
