"""Whole blocks of labels exchanged at once."""

import numpy as np

from kinesphere.data import Array
from kinesphere.kernels.jit import kernel
from kinesphere.labelling.kernels.costs import pair_energy
from kinesphere.labelling.kernels.handed import handed_energy
from kinesphere.labelling.kernels.types import Indices, Signs, Single


@kernel
def _moved(labels: Indices, move: Indices, tried: Indices, holder: Indices) -> None:
    """Fill the labels after a move, and who bears them then."""
    holder[:] = -1
    for k in range(labels.shape[0]):
        i = labels[k]
        if i >= 0:
            i = move[i]
            holder[i] = k
        tried[k] = i


@kernel
def block_energies(
    labels: Indices,
    moves: Indices,
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
    tried = labels.copy()
    holder = np.full(m, -1, dtype=np.int64)
    both = np.empty(m, dtype=np.int64)
    for x in range(n_moves):
        for y in range(x, n_moves):
            for i in range(m):
                both[i] = moves[y, moves[x, i]] if y > x else moves[x, i]
            _moved(labels, both, tried, holder)
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
        _moved(labels, moves[x], tried, holder)
        energies[x] = pair_energy(tried, costs) + handed_energy(holder, quads, wanted, table, every)
