"""Which stage runs, and how long each took."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeAlias

Progress: TypeAlias = Callable[[str, int, int], None]
"""Called with the stage about to run, its number from 0, and how many there are."""


class Clock:
    """Tells of stages and keeps how long each took, in s."""

    def __init__(self, progress: Progress | None, n_stages: int) -> None:
        self.progress = progress
        self.n_stages = n_stages
        self.seconds: dict[str, float] = {}

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Take the time of what happens inside."""
        if self.progress is not None:
            self.progress(name, len(self.seconds), self.n_stages)
        start = time.perf_counter()
        yield
        self.seconds[name] = time.perf_counter() - start
