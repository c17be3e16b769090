"""The viewer: a take on a stage, a panel beside it, and the time that passes."""

import asyncio
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kinesphere.data.edits import Edit
from kinesphere.viewer.clock import Clock
from kinesphere.viewer.panel import Panel
from kinesphere.viewer.posing import Posing
from kinesphere.viewer.stage import Shown, Stage
from kinesphere.viewer.take import Take
from kinesphere.viewer.wiring import on_change, on_press

if TYPE_CHECKING:
    import viser

SCREEN_RATE = 60.0
"""Hz; pages draw no faster."""
_PANEL_RATE = 8.0  # Hz at which the panel follows while the scene plays


class Viewer:
    """Everything runs in the server's event loop, one thing after another."""

    def __init__(
        self,
        server: "viser.ViserServer",
        take: Take,
        edits_file: Path,
        edits: Sequence[Edit] = (),
        *,
        dark: bool = False,
    ) -> None:
        recording = take.recording
        self.take = take
        self.first, self.rate = recording.first_frame, recording.rate
        self.clock = Clock(recording.n_frames, self.rate)
        self.shown = 0
        """Frames shown so far while playing."""
        self.stage = Stage(
            server, take.skeleton, recording.labels, take.middle(), take.floor(),
            surface=None if take.solution is None else take.solution.surface, dark=dark,
        )  # fmt: skip
        self.panel = Panel(
            server,
            (self.first, recording.n_frames, self.rate),
            None if take.poses is None else take.skeleton,
            take.notes,
            self.stage.kinds,
        )
        self.posing = None
        if take.poses is not None:
            self.posing = Posing(
                server, self.panel, self.stage, take.poses, self, edits_file, edits
            )
        self._connect(server)
        self.draw()
        self._task = asyncio.run_coroutine_threadsafe(self._run(), server.get_event_loop())

    @property
    def frame(self) -> int:
        """The frame on view, counted from 0."""
        return self.clock.at(time.monotonic())

    @property
    def playing(self) -> bool:
        """Whether time passes."""
        return self.clock.playing

    @property
    def unsaved(self) -> tuple[Edit, ...]:
        """Edits that no file holds."""
        return () if self.posing is None else self.posing.unsaved

    def stop(self) -> None:
        """Stop playing for good."""
        self._task.cancel()

    def play(self, on: bool | None = None) -> None:
        """Start or stop; the other of the two by default."""
        now = time.monotonic()
        on = not self.clock.playing if on is None else on
        self.clock = self.clock.started(now) if on else self.clock.stopped(now)
        self.panel.play.label = "Pause" if on else "Play"
        self._settle()
        self.draw()

    def seek(self, frame: int) -> None:
        """Go to a frame, counted from 0."""
        self.clock = self.clock.sought(frame, time.monotonic())
        self._settle()
        self.draw()

    def draw(self) -> None:
        """Show the frame on view, and all that the panel says about it."""
        frame = self.frame
        self.stage.show(self.take.at(frame))
        self._tell_frame(frame, None)
        if self.posing is not None:
            self.posing.tell(frame)

    def _settle(self) -> None:
        if self.posing is not None:
            self.posing.settle()

    async def _run(self) -> None:
        before, told, counted, since = -1, 0.0, 0, time.monotonic()
        due = since
        pace: float | None = None
        while True:
            # as often as pages draw, whatever showing a frame took
            due = max(due + 1 / SCREEN_RATE, time.monotonic())
            await asyncio.sleep(due - time.monotonic())
            now = time.monotonic()
            if now - since >= 1.0:
                pace = (self.shown - counted) / (now - since)
                counted, since = self.shown, now
            if not self.clock.playing:
                before, pace = -1, None
                continue
            frame = self.clock.at(now)
            if frame == before:
                continue
            before = frame
            self.stage.show(self._ahead(frame))
            self.shown += 1
            if now - told > 1 / _PANEL_RATE:
                told = now
                self._tell_frame(frame, pace)

    def _ahead(self, frame: int) -> Shown:
        if self.take.poses is not None:
            self.take.poses.prepare(frame)
        return self.take.at(frame)

    def _tell_frame(self, frame: int, pace: float | None) -> None:
        self.panel.frame.value = self.first + frame
        self.panel.tell_frame(self.first + frame, self.rate, self.first, pace)

    def _connect(self, server: "viser.ViserServer") -> None:
        panel = self.panel
        on_change(panel.frame, lambda value: self.seek(int(value) - self.first))
        on_change(panel.speed, self._set_speed)
        on_press(panel.play, self.play)
        for name, box in panel.kinds.items():
            on_change(box, self._shower(name))
        labels = self.take.recording.labels
        self.stage.on_marker(lambda i: panel.tell_marker(labels[i]))
        gui = server.gui
        on_press(gui.add_command("Play or pause", hotkey="space"), self.play)
        on_press(
            gui.add_command("Next frame", hotkey="arrowright"), lambda: self.seek(self.frame + 1)
        )
        on_press(
            gui.add_command("Frame before", hotkey="arrowleft"), lambda: self.seek(self.frame - 1)
        )

    def _shower(self, name: str) -> Callable[[Any], None]:
        return lambda on: self.stage.set_visible(name, on, self.take.at(self.frame))

    def _set_speed(self, text: str) -> None:
        self.clock = self.clock.at_speed(float(text), time.monotonic())
