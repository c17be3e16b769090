"""One camera's images as numbered files."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from kinesphere.data import Image
from kinesphere.errors import UnreadableFile
from kinesphere.io.images import SUFFIXES, read_image

_LARGEST_HOLE = 1000
"""Files that count farther apart than this are numbered by something else than frames."""


@dataclass
class ImageFolder:
    """Numbered image files; a number that is not there is an instant without image."""

    path: Path
    files: dict[int, Path]
    """Instant → file."""
    first_number: int
    size: tuple[int, int]
    n_frames: int
    rate: float | None = None
    step: int = 1
    """How far numbers of successive images are apart."""
    hole: str = ""
    """What is said of numbers that are missing."""
    damaged: dict[int, str] = field(default_factory=dict)
    """Instant → what was wrong with its file; grows while files are read."""

    @property
    def notes(self) -> list[str]:
        """What was wrong with it, a sentence each."""
        said = [self.hole] if self.hole else []
        if self.damaged:
            first = self.damaged[min(self.damaged)]
            more = len(self.damaged) - 1
            said.append(first + (f" (and {more} more of this camera)" if more else ""))
        return said

    def images(self, start: int, stop: int) -> Iterator[Image | None]:
        """Yield images ``start`` to before ``stop``; None for one that cannot be had."""
        for i in range(start, stop):
            if i not in self.files:
                yield None
                continue
            try:
                yield read_image(self.files[i])
            except UnreadableFile as error:
                self.damaged[i] = str(error)
                yield None


def open_folder(path: Path, step: int | None = None) -> ImageFolder:
    """Return the images of a folder, or those a pattern like ``shots/cam1_*.png`` names.

    In the order of the last number in their names; without numbers, by name.

    Parameters
    ----------
    step
        How far numbers of successive images are apart, where that is known and many may be
        missing; otherwise the numbers tell.

    Raises
    ------
    UnreadableFile
        If there is none, or the first cannot be read.
    """
    if path.is_dir():
        found = [f for f in path.iterdir() if f.suffix.lower() in SUFFIXES and f.is_file()]
    else:
        found = [f for f in path.parent.glob(path.name) if f.is_file()]
    if not found:
        raise UnreadableFile(f"{path} holds no images ({', '.join(SUFFIXES)})")
    numbers = {f: _number(f) for f in found}
    told = [n for n in numbers.values() if n is not None]
    if len(told) == len(found) and len(set(told)) == len(found):
        first = min(told)
        every = step or int(np.gcd.reduce([n - first for n in told])) or 1
        files = {(numbers[f] - first) // every: f for f in found}  # type: ignore[operator]
    else:
        first, every, files = 0, 1, dict(enumerate(sorted(found)))
    n_frames = max(files) + 1
    hole = ""
    if step is not None:
        pass  # what is not there was not meant to be
    elif n_frames > len(files) + _LARGEST_HOLE:
        first, n_frames, files = 0, len(found), dict(enumerate(files[k] for k in sorted(files)))
    elif n_frames > len(files):
        hole = f"{path}: {n_frames - len(files)} of {n_frames} images are missing in between"
    image = read_image(files[0])
    return ImageFolder(
        path, files, first, (image.shape[1], image.shape[0]), n_frames, step=every, hole=hole
    )


def _number(path: Path) -> int | None:
    digits = re.findall(r"\d+", path.stem)
    return int(digits[-1]) if digits and len(digits[-1]) < 16 else None
