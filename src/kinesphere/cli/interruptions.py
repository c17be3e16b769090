"""What Ctrl-C ends: the work at hand, or only what may be left out once much has been found."""

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType


class Interruptions:
    """Ctrl-C, and a request to terminate as a cluster sends it; both do the same.

    At first they end the work at hand at once. From `finish_first` on the first one is only taken
    down, so that what took long is not lost; a second one ends the work.
    """

    def __init__(self, say: Callable[[str], None]) -> None:
        self.asked = False
        """Whether somebody asked to stop, and was told to wait."""
        self._say = say

    def at_once(self) -> None:
        """From now on stop wherever the work is."""
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.default_int_handler)

    def finish_first(self) -> None:
        """From now on let the work come to its end, unless somebody insists."""
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._told)

    def _told(self, _number: int, _frame: FrameType | None) -> None:
        self.asked = True
        self.at_once()
        self._say("interrupted: what was tracked is being written first; again to give it up")


@contextmanager
def interruptions(say: Callable[[str], None]) -> Iterator[Interruptions]:
    """Handle interruptions inside, and as before afterwards; ``say`` tells people."""
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    found = Interruptions(say)
    found.at_once()
    try:
        yield found
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
