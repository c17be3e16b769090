"""One camera's images in their order, whatever holds them."""

from collections.abc import Iterator
from pathlib import Path
from typing import Protocol

from kinesphere.data import Image
from kinesphere.io.images import SUFFIXES, read_image
from kinesphere.io.scene.image_folder import ImageFolder, open_folder
from kinesphere.io.scene.video_frames import Video, open_video


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
