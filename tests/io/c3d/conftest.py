"""A naive C3D writer, one number after the other, for files that no recording system would make."""

import struct
from dataclasses import dataclass, field

import pytest

BLOCK = 512
CODES = {"INTEL": 84, "DEC": 85, "MIPS": 86}


def dec_float(value):
    """Spell out a VAX F float: 0.1mmm… times 2 to the exponent less 128, high half first."""
    if value == 0:
        return b"\0\0\0\0"
    sign, exponent, mantissa = int(value < 0), 128, abs(value)
    while mantissa >= 1:
        mantissa, exponent = mantissa / 2, exponent + 1
    while mantissa < 0.5:
        mantissa, exponent = mantissa * 2, exponent - 1
    bits = round((mantissa - 0.5) * 2**24)
    high = sign << 15 | exponent << 7 | bits >> 16
    return struct.pack("<HH", high, bits & 0xFFFF)


@dataclass
class C3dFile:
    """What to put into a file; every default makes a small sound one."""

    points: list = field(default_factory=lambda: [[(1.0, 2.0, 3.0), (400.0, 500.0, 1600.0)]])
    """A list a frame of (x, y, z) or (x, y, z, fourth word)."""
    labels: list = field(default_factory=lambda: ["A", "B"])
    processor: str = "INTEL"
    scale: float = -0.5
    rate: float = 100.0
    first: int = 1
    last: int | None = None
    analog: list = field(default_factory=list)
    """A list a frame of (a tuple of channels) a sample."""
    unit: str = "mm"
    groups: dict = field(default_factory=dict)
    """Group → name → list of numbers, str or list of str; None takes a parameter away."""
    header: dict = field(default_factory=dict)
    """Word (counted from 1) → unsigned value, over what is right."""
    events: list = field(default_factory=list)
    """(time, label) in the header."""
    padded: bool = True

    def word(self, value):
        return struct.pack(">H" if self.processor == "MIPS" else "<H", int(value) & 0xFFFF)

    def real(self, value):
        if self.processor == "DEC":
            return dec_float(value)
        return struct.pack(">f" if self.processor == "MIPS" else "<f", value)

    def record(self, name, number, content):
        jump = self.word(2 + len(content) + 1)
        return bytes([len(name), number & 0xFF]) + name.encode() + jump + content + b"\0"

    def parameter(self, name, number, value):
        if isinstance(value, str):
            value = value.encode()
            content = bytes([0xFF, 1, len(value)]) + value
        elif value and isinstance(value[0], str):
            width = max(1, *(len(v) for v in value))
            text = "".join(v.ljust(width) for v in value)
            content = bytes([0xFF, 2, width, len(value)]) + text.encode()
        elif any(isinstance(v, float) for v in value):
            content = bytes([4, 1, len(value)]) + b"".join(map(self.real, value))
        else:
            content = bytes([2, 1, len(value)]) + b"".join(map(self.word, value))
        return self.record(name, number, content)

    def content(self):
        n_frames, n_points = len(self.points), len(self.points[0]) if self.points else 0
        per_frame = len(self.analog[0]) if self.analog else 0
        channels = len(self.analog[0][0]) if self.analog else 0
        last = self.first + n_frames - 1 if self.last is None else self.last
        groups = {
            "POINT": {
                "USED": [n_points],
                "FRAMES": [min(n_frames, 65535)],
                "SCALE": [float(self.scale)],
                "RATE": [float(self.rate)],
                "DATA_START": [0],
                "UNITS": self.unit,
            },
            "ANALOG": {"USED": [channels], "RATE": [float(self.rate * per_frame)]},
        }
        for i in range(0, len(self.labels), 255):
            name = "LABELS" if i == 0 else f"LABELS{i // 255 + 1}"
            groups["POINT"][name] = self.labels[i : i + 255]
        for group, parameters in self.groups.items():
            groups.setdefault(group, {}).update(parameters)

        def section(data_block):
            if groups["POINT"]["DATA_START"] is not None:
                groups["POINT"]["DATA_START"] = [data_block]
            body = b""
            for number, (group, parameters) in enumerate(groups.items(), 1):
                body += self.record(group, -number, b"")
                for name, value in parameters.items():
                    if value is not None:
                        body += self.parameter(name, number, value)
            blocks = -(-(len(body) + 6) // BLOCK)
            head = bytes([1, 80, min(blocks, 255), CODES[self.processor]])
            return (head + body).ljust(blocks * BLOCK, b"\0"), blocks

        data_block = 2 + section(0)[1]
        words = {
            2: n_points, 3: per_frame * channels, 4: self.first, 5: last, 9: data_block,
            10: per_frame, **self.header,
        }  # fmt: skip
        header = bytearray(BLOCK)
        header[:2] = b"\x02\x50"
        for at, value in words.items():
            header[2 * at - 2 : 2 * at] = self.word(value)
        header[12:16], header[20:24] = self.real(self.scale), self.real(self.rate)
        if self.events:
            header[298:300], header[300:302] = self.word(12345), self.word(len(self.events))
            for i, (time, label) in enumerate(self.events):
                header[304 + 4 * i : 308 + 4 * i] = self.real(time)
                header[376 + i] = i + 1  # whether to show it
                header[396 + 4 * i : 400 + 4 * i] = label.ljust(4).encode()
        number = self.real if self.scale < 0 else self.word
        numbers = []
        for frame, points in enumerate(self.points):
            for point in points:
                numbers += map(number, (*point, 0)[:4])
            for sample in self.analog[frame] if self.analog else ():
                numbers += map(number, sample)
        data = b"".join(numbers)
        if self.padded:
            data += bytes(-len(data) % BLOCK)
        return bytes(header) + section(data_block)[0] + data


@pytest.fixture
def c3d_file(tmp_path):
    """Return a function that makes a file with some things different, and its path."""

    def make(name="made.c3d", **different):
        path = tmp_path / name
        path.write_bytes(C3dFile(**different).content())
        return path

    return make
