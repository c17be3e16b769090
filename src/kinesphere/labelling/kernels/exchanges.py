"""One exchange of two labels: what it changes, and how it is made."""

from kinesphere.data import Array
from kinesphere.kernels.jit import kernel
from kinesphere.labelling.kernels.handed import handed_energy, handed_energy_without
from kinesphere.labelling.kernels.types import Indices, Signs, Single


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
        before += handed_energy_without(holder, quads, wanted, table, only, i)
    if i >= 0:
        holder[i] = b
    if j >= 0:
        holder[j] = a
    if i >= 0:
        only = of_label[i, : n_of_label[i]]
        after += handed_energy(holder, quads, wanted, table, only)
    if j >= 0:
        only = of_label[j, : n_of_label[j]]
        after += handed_energy_without(holder, quads, wanted, table, only, i)
    if i >= 0:
        holder[i] = a
    if j >= 0:
        holder[j] = b
    return change + after - before


@kernel
def exchange(labels: Indices, holder: Indices, terms: Array, costs: Single, a: int, j: int) -> None:
    """Let point a take label j (−1: none) and its holder a's label; keep ``terms`` true."""
    i = labels[a]
    b = holder[j] if j >= 0 else -1
    # costs[a, j, k, t] is costs[k, t, a, j], and the former are in one row
    if j >= 0:
        _add(terms, costs[a, j], 1.0)
    if i >= 0:
        _add(terms, costs[a, i], -1.0)
    if b >= 0:
        _add(terms, costs[b, j], -1.0)
        if i >= 0:
            _add(terms, costs[b, i], 1.0)
    labels[a] = j
    if i >= 0:
        holder[i] = b
    if j >= 0:
        holder[j] = a
    if b >= 0:
        labels[b] = i


@kernel
def _add(terms: Array, row: Single, sign: float) -> None:
    for k in range(terms.shape[0]):
        for t in range(terms.shape[1]):
            terms[k, t] += sign * row[k, t]
