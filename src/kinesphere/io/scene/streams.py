"""One camera's images in their order: a folder of files, or a video decoded frame by frame."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from kinesphere.data import Image
from kinesphere.errors import UnreadableFile
from kinesphere.io.images import SUFFIXES, read_image
from kinesphere.io.video import pyav

_LARGEST_HOLE = 1000
"""Files that count farther apart than this are numbered by something else than frames."""


class Stream(Protocol):
    """A camera's own images, numbered from 0."""

    @property
    def path(self) -> Path:
        """Where it was opened."""
        ...

    @property
    def n_frames(self) -> int:
        """How many images there should be."""
        ...

    @property
    def rate(self) -> float | None:
        """Hz; None where nothing says."""
        ...

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the first image."""
        ...

    @property
    def notes(self) -> list[str]:
        """What was wrong with it, a sentence each; grows while it is read."""
        ...

    def images(self, start: int, stop: int) -> Iterator[Image | None]:
        """Yield images ``start`` to before ``stop``; None for one that cannot be had."""
        ...


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
    notes: list[str] = field(default_factory=list)
    step: int = 1
    """How far numbers of successive images are apart."""

    def images(self, start: int, stop: int) -> Iterator[Image | None]:
        """Yield images ``start`` to before ``stop``; None for one that cannot be had."""
        for i in range(start, stop):
            if i not in self.files:
                yield None
                continue
            try:
                yield read_image(self.files[i])
            except UnreadableFile as error:
                note(self.notes, str(error))
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
    notes: list[str] = []
    if step is not None:
        pass  # what is not there was not meant to be
    elif n_frames > len(files) + _LARGEST_HOLE:
        first, n_frames, files = 0, len(found), dict(enumerate(files[k] for k in sorted(files)))
    elif n_frames > len(files):
        note(notes, f"{path}: {n_frames - len(files)} of {n_frames} images are missing in between")
    image = read_image(files[0])
    return ImageFolder(
        path, files, first, (image.shape[1], image.shape[0]), n_frames, notes=notes, step=every
    )


def _number(path: Path) -> int | None:
    digits = re.findall(r"\d+", path.stem)
    return int(digits[-1]) if digits and len(digits[-1]) < 16 else None


@dataclass
class Video:
    """A video file; frames are numbered by the order of their times, not as they are decoded."""

    path: Path
    times: dict[int, int]
    """Time stamp → number of the frame."""
    rate: float | None
    size: tuple[int, int]
    notes: list[str] = field(default_factory=list)

    @property
    def n_frames(self) -> int:
        """Frames the file promises."""
        return len(self.times)

    def images(self, start: int, stop: int) -> Iterator[Image | None]:
        """Yield images ``start`` to before ``stop``; None for one that cannot be decoded."""
        due, lost = start, 0
        for index, image in self._decoded():
            if index >= stop:
                break
            while due < index:
                lost += 1
                due += 1
                yield None
            if index == due:
                yield image()
                due += 1
        lost += max(0, stop - due)
        if lost:
            note(self.notes, f"{self.path}: {lost} frames cannot be decoded; the file is damaged")
        for _ in range(due, stop):
            yield None

    def _decoded(self) -> Iterator[tuple[int, Any]]:
        av = pyav()
        with av.open(str(self.path)) as container:
            stream = container.streams.video[0]
            stream.thread_type = "AUTO"
            packets = container.demux(stream)
            while True:
                try:
                    packet = next(packets)
                    frames = packet.decode()
                except StopIteration:
                    return
                except av.FFmpegError:
                    continue
                for frame in frames:
                    if (index := self.times.get(_stamp(frame) or 0)) is not None:
                        yield index, lambda frame=frame: _upright(frame)


def open_video(path: Path) -> Video:
    """Return a video's frames, counted without decoding them.

    Raises
    ------
    UnreadableFile
        If the file is missing, empty, no video, or its first frame cannot be decoded.
    """
    av = pyav()
    if not path.is_file():
        what = "is no file" if path.exists() else "there is no such file"
        raise UnreadableFile(f"{path}: {what}")
    if path.stat().st_size == 0:
        raise UnreadableFile(f"{path} is empty")
    stamps: list[int] = []
    try:
        with av.open(str(path)) as container:
            if not container.streams.video:
                raise UnreadableFile(f"{path} holds no video stream")
            stream = container.streams.video[0]
            rate: Fraction | None = stream.average_rate or stream.guessed_rate
            try:
                for packet in container.demux(stream):
                    stamp = _stamp(packet)
                    if stamp is not None and packet.size and not packet.is_discard:
                        stamps.append(stamp)
            except av.FFmpegError:
                pass  # cut off: what came before counts
    except av.FFmpegError as error:
        raise UnreadableFile(f"{path} is no video that can be read ({error.strerror})") from None
    if not stamps:
        raise UnreadableFile(f"{path} holds no frame")
    times = {stamp: i for i, stamp in enumerate(sorted(set(stamps)))}
    video = Video(path, times, None if rate is None else float(rate), (0, 0))
    first = next(iter(video.images(0, min(video.n_frames, 1))))
    if first is None:
        raise UnreadableFile(f"{path}: its first frame cannot be decoded; the video is damaged")
    video.size = (first.shape[1], first.shape[0])
    return video


def _stamp(timed: Any) -> int | None:
    """Return the presentation time of a packet or frame; old containers know decoding times."""
    stamp: int | None = timed.dts if timed.pts is None else timed.pts
    return stamp


def _upright(frame: Any) -> Image:
    """Return a decoded frame's pixels, turned as the file says they should be shown."""
    image: Image = frame.to_ndarray(format="rgb24")
    turns = round(getattr(frame, "rotation", 0) / 90) % 4
    return np.ascontiguousarray(np.rot90(image, turns)) if turns else image


def open_stream(path: Path, step: int | None = None) -> ImageFolder | Video:
    """Return the images at a path: a folder, a pattern with ``*`` or ``?``, an image or a video.

    Parameters
    ----------
    step
        As in `open_folder`.
    """
    if path.is_dir() or any(c in path.name for c in "*?["):
        return open_folder(path, step)
    if path.suffix.lower() in SUFFIXES:
        image = read_image(path)
        return ImageFolder(path, {0: path}, 0, (image.shape[1], image.shape[0]), 1)
    return open_video(path)


def note(notes: list[str], sentence: str) -> None:
    """Add a sentence that is not there yet."""
    if sentence not in notes:
        notes.append(sentence)
