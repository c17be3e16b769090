"""One camera's video, decoded frame by frame."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np

from kinesphere.data import Image
from kinesphere.errors import UnreadableFile
from kinesphere.io.video import pyav


@dataclass
class Video:
    """A video file; frames are numbered by the order of their times, not as they are decoded."""

    path: Path
    times: dict[int, int]
    """Time stamp → number of the frame."""
    rate: float | None
    size: tuple[int, int]
    damaged: set[int] = field(default_factory=set)
    """Frames that could not be decoded; grows while frames are read."""

    @property
    def notes(self) -> list[str]:
        """What was wrong with it, a sentence each."""
        if not self.damaged:
            return []
        few = sorted(self.damaged)
        which = f"frame {few[0]}" if len(few) == 1 else f"between {few[0]} and {few[-1]}"
        return [
            f"{self.path}: {len(few)} of {self.n_frames} frames cannot be decoded ({which}); the "
            "file is damaged, and this camera is blind there"
        ]

    @property
    def n_frames(self) -> int:
        """Frames the file promises."""
        return len(self.times)

    def images(self, start: int, stop: int) -> Iterator[Image | None]:
        """Yield images ``start`` to before ``stop``; None for one that cannot be decoded."""
        due = start
        for index, image in self._decoded(start):
            if index >= stop:
                break
            while due < index:
                self.damaged.add(due)
                due += 1
                yield None
            if index == due:
                yield image()
                due += 1
        for missing in range(due, stop):
            self.damaged.add(missing)
            yield None

    def _decoded(self, start: int) -> Iterator[tuple[int, Callable[[], Image]]]:
        """Yield frames with their numbers, ``start`` among them and some before it."""
        av = pyav()
        with av.open(str(self.path)) as container:
            stream = container.streams.video[0]
            stream.thread_type = "AUTO"
            found = self._frames(container, stream)
            if start > 0 and (stamp := self._stamps.get(start)) is not None:
                try:
                    container.seek(stamp, stream=stream, backward=True)
                    first = next(found, None)
                    if first is not None and first[0] <= start:
                        yield first
                        yield from found
                        return
                except av.FFmpegError:
                    pass
                container.seek(0)  # a file that cannot be sought is read from its beginning
                found = self._frames(container, stream)
            yield from found

    def _frames(self, container: Any, stream: Any) -> Iterator[tuple[int, Callable[[], Image]]]:
        packets = container.demux(stream)
        while True:
            try:
                frames = next(packets).decode()
            except StopIteration:
                return
            except pyav().FFmpegError:
                continue
            for frame in frames:
                if (index := self.times.get(_stamp(frame) or 0)) is not None:
                    yield index, partial(_upright, frame)

    @cached_property
    def _stamps(self) -> dict[int, int]:
        return {number: stamp for stamp, number in self.times.items()}


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
