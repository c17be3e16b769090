"""Calls from the server: all in its event loop, so that nothing happens at the same time."""

from collections.abc import Callable
from typing import Any, Protocol


class Time(Protocol):
    """What posing needs of the viewer around it."""

    @property
    def frame(self) -> int:
        """The frame on view, counted from 0."""

    @property
    def playing(self) -> bool:
        """Whether time passes."""

    def draw(self) -> None:
        """Show the frame on view."""


def on_change(handle: Any, call: Callable[[Any], object]) -> None:
    """Call with the value a person gave a control; not when the program itself sets it."""

    async def changed(event: Any) -> None:
        if event.client is not None:
            call(handle.value)

    handle.on_update(changed)


def on_press(handle: Any, call: Callable[[], object]) -> None:
    """Call when a button is pressed, or the key of a command."""

    async def pressed(_: Any) -> None:
        call()

    (handle.on_click if hasattr(handle, "on_click") else handle.on_trigger)(pressed)
