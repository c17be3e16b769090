"""How kernels are compiled: once, cached beside the package, NaN kept honest (no fastmath).

They let other threads run meanwhile: a live stream goes on while a body is recognised.
"""

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

_F = TypeVar("_F", bound=Callable[..., Any])


def kernel(function: _F) -> _F:
    """Compile a function of arrays and numbers; ``NUMBA_DISABLE_JIT=1`` leaves it plain Python.

    Where neither the package's folder nor the user's cache can be written to, each run compiles
    anew.
    """
    try:
        return cast(_F, numba.njit(cache=True, nogil=True, error_model="numpy")(function))
    except RuntimeError:  # numba: "no locator available"
        return cast(_F, numba.njit(nogil=True, error_model="numpy")(function))
