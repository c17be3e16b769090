"""Many exchanges: the steepest, the least costly, random ones."""

import numpy as np

from kinesphere.data import Array
from kinesphere.kernels.jit import kernel
from kinesphere.labelling.kernels.costs import linear_terms
from kinesphere.labelling.kernels.exchanges import exchange, exchange_gain
from kinesphere.labelling.kernels.handed import room_to_agree
from kinesphere.labelling.kernels.types import Indices, Signs, Single


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
