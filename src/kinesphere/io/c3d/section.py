"""The parameter section between bytes and groups. Never trusts a length it reads."""

from dataclasses import replace
from math import prod

from kinesphere.errors import UnreadableFile
from kinesphere.io.c3d.header import BLOCK
from kinesphere.io.c3d.parameters import (
    BYTE,
    CHAR,
    FLOAT,
    WORD,
    Group,
    Parameter,
    Section,
)
from kinesphere.io.c3d.processor import INTEL, Processor

PARAMETER_KEY = b"\x01\x50"
_NAMES = "latin-1"
"""Names are ASCII; whatever bytes a description holds go back as they came."""
_MOST_GROUPS = 127
_LARGEST_RECORD = 65535
"""Bytes: the way to the next record has 16 bits."""


def section_from_bytes(content: bytes, processor: Processor) -> Section:
    """Parse the records of a parameter section, its four leading bytes included.

    The chain of records ends where a distance or a name's length is zero; every distance leads
    forward, so the walk is bounded by the length of ``content``.

    Raises
    ------
    UnreadableFile
        If a record reaches beyond the section or says something impossible.
    """
    groups: dict[int, Group] = {}
    orphans: dict[int, list[Parameter]] = {}
    at = 4
    while at + 2 <= len(content):
        name_length = int.from_bytes(content[at : at + 1], signed=True)
        number = int.from_bytes(content[at + 1 : at + 2], signed=True)
        if name_length == 0 or number == 0:
            break
        if number < -_MOST_GROUPS:
            raise UnreadableFile(f"a group has the number {-number}; at most {_MOST_GROUPS} can be")
        locked, start = name_length < 0, at + 2
        record = _Record(content, start, f"record at byte {at} of the parameter section")
        name = record.take(abs(name_length)).decode(_NAMES).strip(" \0")
        jump_from = record.at
        distance = int(processor.words(record.take(2))[0]) % 65536
        if number < 0:
            description = record.take_counted().decode(_NAMES)
            parameters = tuple(orphans.pop(-number, []))
            if -number in groups:  # said twice: what was gathered so far belongs together
                parameters = groups[-number].parameters
            groups[-number] = Group(-number, name, description, locked, parameters)
        else:
            parameter = replace(_parameter(name, record, processor), locked=locked)
            if number in groups:
                group = groups[number]
                groups[number] = replace(group, parameters=(*group.parameters, parameter))
            else:
                orphans.setdefault(number, []).append(parameter)
        if distance == 0:
            break
        at = jump_from + distance
    for number, left in orphans.items():
        groups[number] = Group(number, f"GROUP_{number}", parameters=tuple(left))
    return Section(tuple(groups.values()))


def bytes_from_section(section: Section) -> bytes:
    """Return the section as an INTEL processor writes it, padded to whole blocks."""
    records = []
    for group in section.groups:
        records.append(_bytes_of_group(group))
        records.extend(_bytes_of_parameter(p, group.number) for p in group.parameters)
    last = b"\0\0"  # no name: the chain ends
    body = b"".join(records) + last
    blocks = -(-(4 + len(body)) // BLOCK)
    head = PARAMETER_KEY + bytes((min(blocks, 255), INTEL.code))
    return (head + body).ljust(blocks * BLOCK, b"\0")


class _Record:
    """A window that moves forward through one record and notices its end."""

    def __init__(self, content: bytes, at: int, what: str) -> None:
        self.content, self.at, self.what = content, at, what

    def take(self, length: int) -> bytes:
        piece = self.content[self.at : self.at + length]
        if len(piece) < length:
            raise UnreadableFile(
                f"the parameter section ends inside the {self.what}: "
                f"{length} bytes announced, {len(piece)} there"
            )
        self.at += length
        return piece

    def take_counted(self) -> bytes:
        # some writers leave the description out where the section ends
        length = self.take(1) if self.at < len(self.content) else b"\0"
        return self.take(length[0])


def _parameter(name: str, record: _Record, processor: Processor) -> Parameter:
    record.what = f"parameter {name!r}"
    kind = int.from_bytes(record.take(1), signed=True)
    if kind not in (CHAR, BYTE, WORD, FLOAT):
        raise UnreadableFile(f"parameter {name!r} is of kind {kind}; -1, 1, 2 and 4 are possible")
    dims = tuple(record.take(record.take(1)[0]))
    data = record.take(prod(dims) * abs(kind))
    if kind == WORD:
        data = processor.words(data).astype("<i2").tobytes()
    elif kind == FLOAT:
        data = processor.floats(data).astype("<f4").tobytes()
    description = record.take_counted().decode(_NAMES)
    if len(data) + len(dims) + len(description) + 5 > _LARGEST_RECORD:
        raise UnreadableFile(f"parameter {name!r} announces {len(data)} bytes, more than a record")
    return Parameter(name, kind, dims, data, description)


def _bytes_of_group(group: Group) -> bytes:
    return _bytes_of_record(group.name, group.locked, -group.number, b"", group.description)


def _bytes_of_parameter(p: Parameter, number: int) -> bytes:
    content = p.kind.to_bytes(1, signed=True) + bytes((len(p.dims), *p.dims)) + p.data
    return _bytes_of_record(p.name, p.locked, number, content, p.description)


def _bytes_of_record(
    name: str, locked: bool, number: int, content: bytes, description: str
) -> bytes:
    title, words = name.encode(_NAMES), description.encode(_NAMES)
    tail = content + bytes((len(words),)) + words
    length = -len(title) if locked else len(title)
    return (
        length.to_bytes(1, signed=True)
        + number.to_bytes(1, signed=True)
        + title
        + (len(tail) + 2).to_bytes(2, "little")
        + tail
    )
