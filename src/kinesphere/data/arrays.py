"""How containers hold arrays: float64, C-ordered, checked once, read-only ever after."""

from collections.abc import Iterable
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Codes = NDArray[np.uint8]

_A = TypeVar("_A", bound=NDArray[Any])


def given_away(array: _A) -> _A:
    """Return an array nobody writes to any more: containers take it without a copy."""
    array.flags.writeable = False
    return array.view()  # whose base is the array, even where a kernel's result owns no memory


def frozen(values: ArrayLike, *shape: int | None, name: str) -> Array:
    """Return ``values`` as a read-only float64 array, checked against ``shape``.

    Parameters
    ----------
    values : array_like
        Copied, unless nobody can write to it any more.
    *shape
        Expected length of each axis; None where any length will do.
    name
        What the array is called in an error.

    Raises
    ------
    ValueError
        If the number of axes or a fixed length differs, or a value is infinite.
    """
    array = np.asarray(values, dtype=np.float64)
    _check_shape(array.shape, shape, name)
    if np.isinf(array).any():
        where = tuple(int(i) for i in np.argwhere(np.isinf(array))[0])
        raise ValueError(f"{name} is infinite at {where}; only NaN may stand for 'not seen'")
    return _read_only(array)


def frozen_codes(values: ArrayLike, *shape: int | None, name: str) -> Codes:
    """Return ``values`` as a read-only uint8 array, checked against ``shape``."""
    array = np.asarray(values, dtype=np.uint8)
    _check_shape(array.shape, shape, name)
    return _read_only(array)


def frozen_mask(values: ArrayLike, *shape: int | None, name: str) -> Mask:
    """Return ``values`` as a read-only boolean array, checked against ``shape``."""
    array = np.asarray(values, dtype=np.bool_)
    _check_shape(array.shape, shape, name)
    return _read_only(array)


def _check_shape(found: tuple[int, ...], wanted: Iterable[int | None], name: str) -> None:
    wanted = tuple(wanted)
    fits = len(found) == len(wanted) and all(
        w is None or f == w for f, w in zip(found, wanted, strict=True)
    )
    if not fits:
        shown = ", ".join("any" if w is None else str(w) for w in wanted)
        raise ValueError(f"{name} must have shape ({shown}), got {found}")


def _read_only(array: _A) -> _A:
    owner = array if array.base is None else array.base
    safe = isinstance(owner, np.ndarray) and not owner.flags.writeable
    if not (safe and array.flags.c_contiguous and not array.flags.writeable):
        array = array.copy(order="C")
        array.flags.writeable = False
    return array
