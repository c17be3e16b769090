"""The cameras' streams side by side: one frame an instant."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np

from kinesphere.data import Camera, Frame, Image, Mask
from kinesphere.data.spans import frame_spans
from kinesphere.errors import UnreadableFile
from kinesphere.io.scene.image_folder import ImageFolder
from kinesphere.io.scene.streams import Stream

_HALF = 127
_BLANK = 8
"""Brightest less darkest value of an image that shows nothing; noise of a covered lens is less."""
_SPARSE = 4
"""Every so many pixels are looked at for that."""


@dataclass
class RecordedFootage:
    """Images and masks of every camera, decoded as they are asked for."""

    cameras: tuple[Camera, ...]
    streams: tuple[Stream, ...]
    masks: tuple[Stream | None, ...]
    image_offsets: tuple[int, ...]
    """Number of the image that shows frame 0."""
    mask_offsets: tuple[int, ...]
    references: tuple[Stream | None, ...]
    reference_offsets: tuple[int, ...]
    odd_sizes: dict[int, str] = field(default_factory=dict)
    """Camera → what was said of images that have another size than its first."""
    blank: dict[int, set[int]] = field(default_factory=dict)
    """Camera → frames whose image is of one colour."""

    @property
    def notes(self) -> tuple[str, ...]:
        """What went wrong while reading so far, a sentence each."""
        streams = (s for s in (*self.streams, *self.masks, *self.references) if s is not None)
        blank = (
            f"{self.cameras[c].name} shows one colour and nothing else in {self._called(at)}; it "
            "is blind there"
            for c, at in self.blank.items()
        )
        return (*self.odd_sizes.values(), *blank, *(note for s in streams for note in s.notes))

    def frames(self, start: int, stop: int, step: int = 1) -> Iterator[Frame]:
        """Yield frames ``start``, ``start + step``, … before ``stop``."""
        images, masks, references = (
            [
                None if s is None else s.images(start + o, stop + o)
                for s, o in zip(streams, offsets, strict=True)
            ]
            for streams, offsets in (
                (self.streams, self.image_offsets),
                (self.masks, self.mask_offsets),
                (self.references, self.reference_offsets),
            )
        )
        for index in range(start, stop):
            shown, shapes, compared = (
                [None if stream is None else next(stream) for stream in streams]
                for streams in (images, masks, references)
            )
            if (index - start) % step == 0:
                yield Frame(
                    index,
                    tuple(self._shown(c, i, index) for c, i in enumerate(shown)),
                    tuple(self._mask(c, i, index) for c, i in enumerate(shapes)),
                    tuple(self._mask(c, i, index) for c, i in enumerate(compared)),
                )

    def _called(self, frames: Iterable[int]) -> str:
        return frame_spans(frames, self.image_offsets[0] + 1)

    def _fitting(self, c: int, image: Image | None, index: int) -> Image | None:
        camera = self.cameras[c]
        if image is None or image.shape[:2] == (camera.height, camera.width):
            return image
        self.odd_sizes.setdefault(
            c,
            f"{camera.name}: from {self._called([index])} on images are {image.shape[1]} × "
            f"{image.shape[0]} pixels, not {camera.width} × {camera.height}; they are left out",
        )
        return None

    def _shown(self, c: int, image: Image | None, index: int) -> Image | None:
        """Return a camera's image; None for one that shows nothing, as when it was not yet lit."""
        fitting = self._fitting(c, image, index)
        if fitting is not None and np.ptp(fitting[::_SPARSE, ::_SPARSE]) < _BLANK:
            self.blank.setdefault(c, set()).add(index)
            return None
        return fitting

    def _mask(self, c: int, image: Image | None, index: int) -> Mask | None:
        fitting = self._fitting(c, image, index)
        if fitting is None:
            return None
        red, green, blue = (fitting[..., k] > _HALF for k in range(3))
        return np.asarray(red | green | blue)  # numpy's max over three channels takes ten times


def mask_offset(masks: Stream, images: Stream, offset: int, first_mask: int | None) -> int:
    """Return the place, among the masks, of the one that belongs to the scene's frame 0.

    Masks in a folder carry the numbers of the images they belong to: of image files the same
    number, of a video's frames the number counted from 0, unless there are as many masks as
    frames, or ``first_mask`` says which belongs to the first image.
    """
    if not isinstance(masks, ImageFolder):
        return offset
    if first_mask is None:
        if isinstance(images, ImageFolder) and images.n_frames > 1:
            first_mask = images.first_number
        elif len(masks.files) == images.n_frames:
            first_mask = masks.first_number
        else:
            first_mask = 0
    return offset + (first_mask - masks.first_number) // masks.step


def median_plate(stream: Stream, most: int = 25) -> Image:
    """Return the median of up to ``most`` images, evenly spread: the scene without what moves.

    Raises
    ------
    UnreadableFile
        If no image can be had.
    """
    every = max(1, stream.n_frames // most)
    kept = [
        image
        for i, image in enumerate(stream.images(0, stream.n_frames))
        if i % every == 0 and image is not None
    ]
    if not kept:
        raise UnreadableFile(f"{stream.path}: no image of the empty scene can be read")
    plate: Image = np.median(np.stack(kept), axis=0).astype(np.uint8)
    return plate
