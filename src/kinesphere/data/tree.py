"""Ways through a tree that is given by each limb's parent."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray


def way_to_root(parents: Sequence[int] | NDArray[np.intp], limb: int) -> list[int]:
    """Return a limb and all it hangs from, the root last."""
    way = [int(limb)]
    while parents[way[-1]] >= 0:
        way.append(int(parents[way[-1]]))
    return way


def way_between(
    parents: Sequence[int] | NDArray[np.intp], above: int, below: int
) -> tuple[int, ...] | None:
    """Return the limbs strictly between two, from the upper one down; None if none leads there."""
    way = way_to_root(parents, below)
    return tuple(way[1 : way.index(above)][::-1]) if above in way else None


def below(parents: Sequence[int] | NDArray[np.intp], limb: int) -> list[int]:
    """Return a limb and every one that hangs from it, parents first."""
    inside = {int(limb)}
    found = [int(limb)]
    for i in range(limb + 1, len(parents)):
        if int(parents[i]) in inside:
            inside.add(i)
            found.append(i)
    return found
