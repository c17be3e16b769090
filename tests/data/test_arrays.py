"""Containers take what nobody writes to any more, and copy the rest."""

from collections.abc import Callable

import numpy as np
import pytest

from kinesphere.data.arrays import Array, frozen, given_away
from kinesphere.kernels.jit import kernel


@kernel
def _ones(n: int) -> Array:  # pragma: no cover - compiled
    return np.ones(n)


@pytest.mark.parametrize("made", [np.ones, _ones], ids=["numpy", "kernel"])
def test_what_is_given_away_is_not_copied(made: Callable[[int], Array]) -> None:
    # memory of a kernel's result belongs to no array, which once cost a copy of every pose
    array = made(5)
    assert np.shares_memory(frozen(given_away(array), 5, name="x"), array)


@pytest.mark.parametrize("part", [slice(None), slice(1, 4)], ids=["whole", "part"])
def test_what_somebody_can_still_write_to_is_copied(part: slice) -> None:
    array = np.ones(5)
    taken = frozen(array[part], None, name="x")
    array[:] = 2.0
    assert np.array_equal(taken, np.ones(len(taken)))


def test_a_read_only_view_of_what_can_be_written_to_is_copied() -> None:
    array = np.ones(5)
    view = array[:]
    view.flags.writeable = False
    taken = frozen(view, None, name="x")
    array[:] = 2.0
    assert np.array_equal(taken, np.ones(5))


def test_what_was_given_away_cannot_be_written_to() -> None:
    array = np.ones(5)
    given_away(array)
    with pytest.raises(ValueError, match="read-only"):
        array[0] = 2.0
