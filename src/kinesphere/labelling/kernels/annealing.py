"""Random exchanges that grow less willing to go upward."""

import numpy as np

from kinesphere.data import Array
from kinesphere.kernels.jit import kernel
from kinesphere.labelling.kernels.costs import linear_terms
from kinesphere.labelling.kernels.exchanges import exchange
from kinesphere.labelling.kernels.handed import BASE, one_quadruple
from kinesphere.labelling.kernels.types import Indices, Signs, Single


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
    points: Indices,
    targets: Indices,
    draws: Array,
    hot: float,
    cold: float,
) -> None:
    """Exchange labels at random, the less willingly upward the later (simulated annealing).

    Parameters
    ----------
    labels, holder
        Changed in place; where the walk ends.
    points, targets
        Which points may change, and to which labels; holders of targets must be among the points.
    draws : (n_steps, 3)
        Uniform random numbers, 0…1.
    hot, cold
        Temperatures at the start and the end, in units of energy.
    """
    terms = linear_terms(labels, costs)
    energies = np.empty(quads.shape[0])  # of each quadruple, as labels are
    room_of = np.zeros(holder.shape[0])  # how much better those of a label could agree at most
    for q in range(quads.shape[0]):
        energies[q] = one_quadruple(holder, quads, wanted, table, q)
        for x in range(4):
            room_of[quads[q, x]] += energies[q] + (1 - BASE) * abs(wanted[q])
    n_steps = draws.shape[0]
    cooling = (cold / hot) ** (1.0 / n_steps)
    heat = hot
    for step in range(n_steps):
        heat *= cooling
        a = points[int(draws[step, 0] * len(points))]
        j = targets[int(draws[step, 1] * len(targets))]
        i, b = labels[a], holder[j]
        if i == j:
            continue
        bound = -heat * np.log(max(draws[step, 2], 1e-300))
        change, room = terms[a, j], room_of[j]
        if i >= 0:
            change -= terms[a, i]
            room += room_of[i]
        if b >= 0:
            change -= terms[b, j]
            if i >= 0:
                change += terms[b, i] + costs[a, i, b, j] + costs[a, j, b, i]
        if change - room >= bound:
            continue
        if i >= 0:
            holder[i] = b
            for x in range(n_of_label[i]):
                q = of_label[i, x]
                if quads[q, 0] != j and quads[q, 1] != j and quads[q, 2] != j and quads[q, 3] != j:
                    change += one_quadruple(holder, quads, wanted, table, q) - energies[q]
        holder[j] = a
        for x in range(n_of_label[j]):
            q = of_label[j, x]
            change += one_quadruple(holder, quads, wanted, table, q) - energies[q]
        if i >= 0:
            holder[i] = a
        holder[j] = b
        if not change < bound:
            continue
        exchange(labels, holder, terms, costs, a, j)
        for label in (i, j):
            if label < 0:
                continue
            for x in range(n_of_label[label]):
                q = of_label[label, x]
                now = one_quadruple(holder, quads, wanted, table, q)
                if now != energies[q]:
                    for y in range(4):
                        room_of[quads[q, y]] += now - energies[q]
                    energies[q] = now
