"""Where the numbers of a file lie: settled, and checked against its size, before any is read."""

from dataclasses import dataclass

import numpy as np

from kinesphere.errors import UnreadableFile
from kinesphere.io.c3d.header import BLOCK, LARGEST_WORD, Header, header_from_bytes
from kinesphere.io.c3d.parameters import Section
from kinesphere.io.c3d.processor import PROCESSORS, Processor
from kinesphere.io.c3d.section import section_from_bytes

MAGIC = 80
_FASTEST = 1e6
"""Hz; no frame rate is beyond it."""


@dataclass(frozen=True)
class Layout:
    """Everything needed to find a number in the data section."""

    processor: Processor
    header: Header
    section: Section
    start: int
    """Byte the data section starts at."""
    is_float: bool
    scale: float
    """Length (in the file's unit) or residual that 1 stands for in an integer file."""
    n_frames: int
    n_points: int
    n_channels: int
    samples_per_frame: int
    rate: float
    """Hz."""
    warnings: tuple[str, ...]

    @property
    def words_per_frame(self) -> int:
        """Numbers in one frame: four a point, then the analog samples."""
        return 4 * self.n_points + self.n_channels * self.samples_per_frame

    @property
    def end(self) -> int:
        """Byte after the last number."""
        return self.start + self.n_frames * self.words_per_frame * (4 if self.is_float else 2)


def layout_of(content: bytes, size: int | None = None) -> Layout:
    """Read the header and the parameters of a file and check what they promise.

    Parameters
    ----------
    content
        The file, or so much of its beginning that the parameters are in it.
    size
        Bytes in the whole file; those of ``content`` if not given.

    Raises
    ------
    UnreadableFile
        Naming what the file says that cannot be, or how much of it is missing.
    """
    warnings: list[str] = []
    size = len(content) if size is None else size
    processor, start = _find_section(content)
    header = header_from_bytes(content[:BLOCK], processor)
    section = section_from_bytes(content[start : _section_end(content, start, header)], processor)
    if section.group("POINT") is None:
        raise UnreadableFile("there is no parameter group POINT, which every C3D file needs")
    rate = _rate(header, section, warnings)
    n_points = _agreed(
        "points", header.n_points, "POINT:USED", section.count("POINT", "USED"), warnings
    )
    per_frame, n_channels = _analog(header, section, warnings)
    is_float, scale = _scale(header, section, warnings)
    data_start = _data_start(size, start, header, section, warnings)
    words_per_frame = 4 * n_points + per_frame * n_channels
    n_frames = _n_frames(header, section)
    if n_frames < 1:
        raise UnreadableFile(
            f"the file holds no frames (first is {header.first_frame}, last {header.last_frame})"
        )
    if words_per_frame == 0:
        raise UnreadableFile("the file holds neither points nor analog channels")
    frame_bytes = words_per_frame * (4 if is_float else 2)
    present = max(0, size - data_start) // frame_bytes
    if n_frames > present:
        raise UnreadableFile(
            f"the data section is cut short: {n_frames} frames of {n_points} points declared, "
            f"{present} present"
        )
    return Layout(
        processor, header, section, data_start, is_float, scale, n_frames, n_points,
        n_channels, per_frame, rate, tuple(warnings),
    )  # fmt: skip


def _find_section(content: bytes) -> tuple[Processor, int]:
    if len(content) < BLOCK:
        raise UnreadableFile(f"the header is cut short: {len(content)} of {BLOCK} bytes present")
    if content[1] != MAGIC:
        raise UnreadableFile(f"no C3D file: its second byte is {content[1]} instead of {MAGIC}")
    start = (content[0] - 1) * BLOCK
    if start < BLOCK or start + 4 > len(content):
        raise UnreadableFile(
            f"the parameter section should start at block {content[0]}; "
            f"the file has {len(content) / BLOCK:.1f} blocks"
        )
    code = content[start + 3]
    if code not in PROCESSORS:
        known = ", ".join(f"{p.code} ({p.name})" for p in PROCESSORS.values())
        raise UnreadableFile(f"the processor code is {code}; known are {known}")
    return PROCESSORS[code], start


def _section_end(content: bytes, start: int, header: Header) -> int:
    # the count of blocks has one byte and is often wrong; the data cannot start before the end
    counted = start + max(content[start + 2], 1) * BLOCK
    data = (header.data_block - 1) * BLOCK
    return min(max(counted, data if data > start else 0), len(content))


def _rate(header: Header, section: Section, warnings: list[str]) -> float:
    said = section.number("POINT", "RATE")
    for rate in (said, header.rate):
        if rate is not None and 0 < rate <= _FASTEST:
            if rate != said:
                warnings.append(f"POINT:RATE is {said}; the header's {rate:g} Hz is taken")
            return rate
    raise UnreadableFile(
        f"the frame rate is {said} Hz (POINT:RATE) or {header.rate} Hz (header); "
        "it must be positive"
    )


def _agreed(what: str, in_header: int, name: str, said: int | None, warnings: list[str]) -> int:
    if said is None or said == in_header or (said < 0):
        return in_header
    warnings.append(f"the header speaks of {in_header} {what}, {name} of {said}, which is taken")
    return said


def _analog(header: Header, section: Section, warnings: list[str]) -> tuple[int, int]:
    per_frame = header.samples_per_frame
    if header.n_analog == 0:
        return max(per_frame, 1), 0
    if per_frame == 0 or header.n_analog % per_frame:
        raise UnreadableFile(
            f"the header counts {header.n_analog} analog values a frame in {per_frame} samples; "
            "one must be a multiple of the other"
        )
    n_channels = header.n_analog // per_frame
    said = section.count("ANALOG", "USED")
    if said is not None and said != n_channels:
        warnings.append(
            f"the header speaks of {n_channels} analog channels, which is taken, "
            f"ANALOG:USED of {said}"
        )
    return per_frame, n_channels


def _scale(header: Header, section: Section, warnings: list[str]) -> tuple[bool, float]:
    said = section.number("POINT", "SCALE")
    scale = header.scale if said is None else said
    if not np.isfinite(scale) or scale == 0:
        raise UnreadableFile(f"POINT:SCALE is {scale}; it must be a number other than 0")
    if said is not None and (said < 0) != (header.scale < 0):
        warnings.append(
            f"the header's scale {header.scale:g} and POINT:SCALE {said:g} disagree about whether "
            "the data are integers; POINT:SCALE is taken"
        )
    return scale < 0, abs(scale)


def _data_start(
    size: int, section_start: int, header: Header, section: Section, warnings: list[str]
) -> int:
    said = section.count("POINT", "DATA_START")
    for block in (header.data_block, said):
        start = ((block or 0) - 1) * BLOCK
        if section_start < start:
            if block != header.data_block:
                warnings.append(f"the header lets the data start at block {header.data_block}; "
                                f"POINT:DATA_START {said} is taken")  # fmt: skip
            if start > size:
                break
            return start
    raise UnreadableFile(
        f"the data should start at block {header.data_block} (header) or {said} "
        f"(POINT:DATA_START); the file has {size / BLOCK:.1f} blocks"
    )


def _n_frames(header: Header, section: Section) -> int:
    """Return the number of frames, from wherever a long trial has found room for it.

    The header's last frame has 16 bits; past 65535 it stays there or starts again from 0.
    """
    short = header.last_frame - header.first_frame + 1
    first, last = (_long(section, name) for name in ("ACTUAL_START_FIELD", "ACTUAL_END_FIELD"))
    counts = [section.number("POINT", "LONG_FRAMES"), section.number("POINT", "FRAMES")]
    if first is not None and last is not None:
        counts.insert(0, float(last - first + 1))
    for count in counts:
        if count is None or not np.isfinite(count) or count + header.first_frame <= LARGEST_WORD:
            continue
        saturated = header.last_frame == LARGEST_WORD
        if saturated or (int(count) - short) % (LARGEST_WORD + 1) == 0:
            return int(count)
    return short


def _long(section: Section, name: str) -> int | None:
    """Return a frame number of TRIAL: two words, the low one first."""
    values = section.numbers("TRIAL", name)
    if not len(values) or not np.isfinite(values).all():
        return None
    if len(values) == 1:
        return int(values[0])
    return int(values[0]) % 65536 + 65536 * (int(values[1]) % 65536)


def first_frame_of(layout: Layout) -> int:
    """Return the number of the first stored frame."""
    first = _long(layout.section, "ACTUAL_START_FIELD")
    if first is not None and first > LARGEST_WORD and layout.header.first_frame == LARGEST_WORD:
        return first
    return layout.header.first_frame
