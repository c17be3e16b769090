"""How far quadruples of labels turn the way the layout's do."""

from kinesphere.data import Array
from kinesphere.geometry.handedness import FULL, handedness_of
from kinesphere.kernels.jit import kernel
from kinesphere.labelling.kernels.types import Indices, Signs, Single

BASE = 0.5
"""Agreement of a quadruple that earns nothing: less is a cost, more a reward. With 0 labels that
have many stable quadruples attract points of their neighbours that are missing, with 1 labels that
have few of them do; both measure worse where markers are missing."""


@kernel
def one_quadruple(holder: Indices, quads: Indices, wanted: Array, table: Signs, q: int) -> float:
    """Return the energy of one quadruple; 0 where a label has no point."""
    a, b = holder[quads[q, 0]], holder[quads[q, 1]]
    c, d = holder[quads[q, 2]], holder[quads[q, 3]]
    if a < 0 or b < 0 or c < 0 or d < 0:
        return 0.0
    turned = wanted[q] * handedness_of(table, a, b, c, d) / FULL
    return float(BASE * abs(wanted[q]) - turned)


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
        energy += one_quadruple(holder, quads, wanted, table, q)
    return energy


@kernel
def handed_energy_without(
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
        energy += one_quadruple(holder, quads, wanted, table, q)
    return energy


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
def point_energies(
    labels: Indices,
    holder: Indices,
    costs: Single,
    quads: Indices,
    wanted: Array,
    table: Signs,
    energies: Array,
) -> None:
    """Fill what each point takes part in, (n_points,): its pairs and its quadruples."""
    n = labels.shape[0]
    for k in range(n):
        energies[k] = 0.0
        for p in range(n):
            if labels[k] >= 0 and labels[p] >= 0:
                energies[k] += costs[k, labels[k], p, labels[p]]
    for q in range(quads.shape[0]):
        energy = one_quadruple(holder, quads, wanted, table, q)
        if energy != 0:
            for x in range(4):
                energies[holder[quads[q, x]]] += energy
