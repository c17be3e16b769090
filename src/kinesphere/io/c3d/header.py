"""The header: the first 512 bytes."""

from dataclasses import dataclass

import numpy as np

from kinesphere.io.c3d.parameters import text_from_bytes
from kinesphere.io.c3d.processor import INTEL, Processor

BLOCK = 512
"""Bytes; everything in a C3D file starts on a block."""
LARGEST_WORD = 65535
_FOUR_CHARACTERS = 12345
"""Word 150 holds this where event labels have four characters instead of two."""
_EVENTS, _TIMES, _FLAGS, _LABELS = 300, 304, 376, 396
"""Where the number of events, their times, flags and labels start."""
_MOST_EVENTS = 18


@dataclass(frozen=True)
class Header:
    """What the header says; words are unsigned."""

    n_points: int
    n_analog: int
    """Analog values per frame, all channels together."""
    first_frame: int
    last_frame: int
    scale: float
    data_block: int
    """Block of the data section, counted from 1."""
    samples_per_frame: int
    """Analog samples per frame of each channel."""
    rate: float
    """Hz."""
    events: tuple[tuple[float, str], ...] = ()
    """(time in s, label) of events stored the old way."""
    raw: bytes = b"\0" * BLOCK
    """As found, for whatever has no name here."""


def header_from_bytes(raw: bytes, processor: Processor) -> Header:
    """Parse the first block of a file."""
    w = [int(word) % (LARGEST_WORD + 1) for word in processor.words(raw)]
    scale = float(processor.floats(raw[12:16])[0])
    rate = float(processor.floats(raw[20:24])[0])
    n_events = min(w[_EVENTS // 2], _MOST_EVENTS) if w[149] == _FOUR_CHARACTERS else 0
    times = processor.floats(raw[_TIMES : _TIMES + 4 * _MOST_EVENTS])
    labels = [raw[_LABELS + 4 * i : _LABELS + 4 * i + 4] for i in range(n_events)]
    events = tuple(
        (float(time), text_from_bytes(label).strip(" \0"))
        for time, label in zip(times, labels, strict=False)
    )
    # w[i] is word i + 1 of the format's description
    return Header(
        w[1], w[2], w[3], w[4], scale, w[8], w[9], rate, events, _as_intel(raw, processor)
    )


def bytes_from_header(header: Header) -> bytes:
    """Return the block as an INTEL processor writes it; events as they are in ``raw``."""
    words = np.frombuffer(header.raw, "<u2").copy()
    for at, value in (
        (1, header.n_points),
        (2, header.n_analog),
        (3, header.first_frame),
        (4, header.last_frame),
        (8, header.data_block),
        (9, header.samples_per_frame),
    ):
        words[at] = min(value, LARGEST_WORD)
    content = bytearray(words.tobytes())
    content[0:2] = b"\x02\x50"
    content[12:16] = np.float32(header.scale).tobytes()
    content[20:24] = np.float32(header.rate).tobytes()
    return bytes(content)


def without_events(raw: bytes) -> bytes:
    """Return a header's block with no events in it."""
    content = bytearray(raw)
    content[_EVENTS : _EVENTS + 2] = b"\0\0"
    content[_TIMES : _LABELS + 4 * _MOST_EVENTS] = bytes(_LABELS + 4 * _MOST_EVENTS - _TIMES)
    return bytes(content)


def _as_intel(raw: bytes, processor: Processor) -> bytes:
    if processor is INTEL:
        return raw
    content = bytearray(processor.words(raw).astype("<i2").tobytes())
    times = slice(_TIMES, _TIMES + 4 * _MOST_EVENTS)
    content[times] = processor.floats(raw[times]).astype("<f4").tobytes()
    content[_FLAGS:_LABELS] = raw[_FLAGS:_LABELS]
    labels = slice(_LABELS, _LABELS + 4 * _MOST_EVENTS)
    content[labels] = raw[labels]
    return bytes(content)
