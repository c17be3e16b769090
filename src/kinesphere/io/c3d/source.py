"""What a recording remembers of the C3D file it came from, so that nothing is lost in writing."""

from dataclasses import dataclass

from kinesphere.data import Analog, Event
from kinesphere.io.c3d.frames import Frames
from kinesphere.io.c3d.layout import Layout

KEY = "c3d"
"""Where ``Recording.details`` holds it."""


@dataclass(frozen=True, eq=False)
class Source:
    """The file, and what was made of it: what still agrees is written back as it was."""

    layout: Layout
    frames: Frames
    labels: tuple[str, ...]
    """Name given to each point, in the order of the file: unique, unlike the file's own."""
    is_marker: tuple[bool, ...]
    """Whether the point became a marker; else it is an output."""
    first_frame: int
    metres: float
    """How many metres the file's unit of length is."""
    events: tuple[Event, ...]
    analog: Analog | None
    is_padded: bool
    """Whether anything followed the last number: the c3d package takes what does for a frame of
    files that count from 0."""
    rotations: bytes
    """What follows the points and samples in files with segment rotations."""
