"""How much memory a call takes besides what it was given and what it returns."""

import tracemalloc
from collections.abc import Callable
from typing import Any


def extra_bytes(call: Callable[[], Any]) -> int:
    """Return the peak of what is allocated during a call, less what its result holds, in bytes."""
    tracemalloc.start()
    try:
        result = call()
        held, peak = tracemalloc.get_traced_memory()
        del result
    finally:
        tracemalloc.stop()
    return peak - held
