"""How long work takes on the processor, whatever else the machine does meanwhile."""

import time
from collections.abc import Callable
from typing import TypeVar

import numpy as np

T = TypeVar("T")


def median_seconds(call: Callable[[], T], repeats: int) -> tuple[float, T]:
    """Return the median processor time of ``repeats`` calls in s, and the last one's result."""
    taken = []
    for _ in range(repeats):
        start = time.process_time()
        result = call()
        taken.append(time.process_time() - start)
    return float(np.median(taken)), result


class StageClock:
    """Told of stages as `kinesphere.solve` tells ``progress``; keeps the processor time of each."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._running: tuple[str, float] | None = None

    def __call__(self, stage: str, _done: int, _total: int) -> None:
        """Start a stage; the one before ends."""
        self.stop()
        self._running = stage, time.process_time()

    def stop(self) -> None:
        """End the last stage."""
        if self._running is not None:
            stage, start = self._running
            self.seconds[stage] = time.process_time() - start
        self._running = None
