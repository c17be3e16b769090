"""How the command line speaks: tables on stdout, progress and errors on stderr, JSON alone."""

import json
import math
import sys
import time
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

from rich import box
from rich.console import Console
from rich.padding import Padding
from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn
from rich.table import Table
from rich.text import Text

_WIDTH = 120
"""Columns where stdout is no terminal: wide enough for every table."""
_MANY = 20
"""What has so many parts is counted (frames), what has fewer is not (stages)."""
_SOON = 3.0
"""s after which the rest can be judged."""


def stdout() -> Console:
    """Return the console for results."""
    width = None if sys.stdout.isatty() else _WIDTH
    return Console(file=sys.stdout, highlight=False, markup=False, width=width)


def stderr() -> Console:
    """Return the console for progress, warnings and errors."""
    return Console(file=sys.stderr, highlight=False, markup=False)


def plain(text: object) -> str:
    """Return text from a file without the characters that could steer a terminal."""
    return "".join(c if c.isprintable() else "�" for c in str(text))


def on_one_line(text: str) -> str:
    """Return a message as a single printable line."""
    return plain(" ".join(text.split()))


def print_json(found: Any) -> None:
    """Print what a machine reads: one JSON object; what is not known (NaN) is null."""
    text = json.dumps(_nan_as_null(found), indent=2, allow_nan=False, ensure_ascii=False)
    sys.stdout.write(text + "\n")


def _nan_as_null(found: Any) -> Any:
    if isinstance(found, Mapping):
        return {str(key): _nan_as_null(value) for key, value in found.items()}
    if isinstance(found, list | tuple):
        return [_nan_as_null(value) for value in found]
    return None if isinstance(found, float) and not math.isfinite(found) else found


def print_title(console: Console, title: str, aside: str = "") -> None:
    """Print the line above a table."""
    line = Text(plain(title), style="bold")
    if aside:
        line.append(f"  {plain(aside)}", style="not bold dim")
    console.print()
    console.print(line)


def print_pairs(console: Console, pairs: Iterable[tuple[str, str]]) -> None:
    """Print names and what was found, one pair a line."""
    table = Table(box=None, show_header=False, padding=(0, 2, 0, 0), pad_edge=False)
    table.add_column(style="dim", no_wrap=True)
    table.add_column(overflow="fold")
    for name, found in pairs:
        table.add_row(Text(plain(name)), Text(plain(found)))
    console.print(table)


def print_table(
    console: Console,
    header: Sequence[str],
    rows: Iterable[Sequence[str]],
    right: str = "",
    doubtful: Sequence[str] = (),
) -> None:
    """Print a table.

    Parameters
    ----------
    right
        An ``r`` at each column of numbers, e.g. ``"lrr"``.
    doubtful
        Words that should catch the eye.
    """
    table = Table(
        box=box.SIMPLE_HEAD,
        padding=(0, 2, 0, 0),
        pad_edge=False,
        header_style="dim",
        show_edge=False,
    )
    for i, name in enumerate(header):
        justify: Any = "right" if right[i : i + 1] == "r" else "left"
        style = "bold" if i == 0 else ""
        table.add_column(
            Text(name), justify=justify, overflow="fold", style=style, no_wrap=justify == "right"
        )
    for row in rows:
        cells = (plain(cell) for cell in row)
        table.add_row(*(Text(c, style="yellow" if c in doubtful else "") for c in cells))
    console.print(table)


def print_setting(
    console: Console, name: str, value: str, allowed: str, lines: Sequence[str]
) -> None:
    """Print a setting, what it may be, and below it what it does."""
    head = Text(f"{name} = ")
    head.append(value, style="bold cyan")
    head.append(f"   {allowed}", style="dim")
    console.print(head)
    for line in lines:
        console.print(Padding(Text(line, style="dim"), (0, 0, 0, 4), expand=False))


def print_warnings(console: Console, warnings: Sequence[str], names: Collection[str] = ()) -> None:
    """Print what a person should not miss, a line for each reason.

    Parameters
    ----------
    names
        Joints and limbs that may be put in few words.
    """
    from kinesphere.report.notices import notices

    for notice in notices(warnings, names):
        line = Text("! ", style="bold yellow")
        line.append(plain(notice.text), style="not bold yellow")
        console.print(line)
        for reason, joints in notice.reasons:
            line = Text(f"{plain(joints)}: ", style="")
            line.append(plain(reason), style="dim")
            console.print(Padding(line, (0, 0, 0, 4), expand=False))


class Advance:
    """Tells on stderr how far long work has come: a bar, or nothing but what must be said."""

    def __init__(self, bar: Progress | None = None) -> None:
        self.bar = bar
        self.task = None if bar is None else bar.add_task("reading", count="")
        self.begun = (0.0, 0)
        self.stage = ""

    def __call__(self, stage: str, done: int, total: int) -> None:
        """Show that so much of a stage is done."""
        if self.bar is None or self.task is None:
            return
        if stage != self.stage:
            self.stage, self.begun = stage, (time.monotonic(), done)
        self.bar.update(
            self.task,
            description=stage,
            completed=done,
            total=total,
            count=self._count(done, total),
        )

    def say(self, warning: str) -> None:
        """Print a warning at once."""
        line = Text("! ", style="bold yellow").append(plain(warning), style="not bold yellow")
        (self.bar.console if self.bar else stderr()).print(line, soft_wrap=True)

    def _count(self, done: int, total: int) -> str:
        """Return how many frames are done, and, once it can be told, how long the rest takes."""
        if total < _MANY:
            return ""
        since, before = self.begun
        passed = time.monotonic() - since
        if passed < _SOON or done <= before:
            return f"{done} of {total}"
        left = passed * (total - done) / (done - before)
        return (
            f"{done} of {total}, about {left:.0f} s left"
            if left < 100
            else (f"{done} of {total}, about {left / 60:.0f} min left")
        )


@contextmanager
def progress_bar(*, quiet: bool) -> Iterator[Advance]:
    """Yield what draws a bar on stderr while work goes on, ``(stage, done, total)``.

    Nothing is drawn when ``quiet``, or where stderr is no terminal.
    """
    console = stderr()
    if quiet or not console.is_terminal:
        yield Advance()
        return
    bar = Progress(
        SpinnerColumn(),
        TextColumn("{task.description}"),
        BarColumn(bar_width=30),
        TextColumn("{task.fields[count]}"),
        TimeElapsedColumn(),
        console=console,
        transient=True,
    )
    with bar:
        yield Advance(bar)
