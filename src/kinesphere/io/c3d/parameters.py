"""The parameter section in memory: groups of named arrays, in the order of the file."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from math import prod
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinesphere.errors import BadRecording

CHAR, BYTE, WORD, FLOAT = -1, 1, 2, 4
"""Kinds of parameter; but for the sign, how many bytes one element takes."""
LARGEST = 30_000
"""Bytes in one text parameter of ours: records are chained by a signed 16-bit distance."""
MOST = 255
"""Largest extent of one dimension."""


@dataclass(frozen=True)
class Parameter:
    """One named array; the first dimension runs fastest, as in Fortran."""

    name: str
    kind: int
    dims: tuple[int, ...]
    data: bytes
    """As an INTEL processor writes it, whatever the file was."""
    description: str = ""
    locked: bool = False

    @property
    def numbers(self) -> NDArray[Any]:
        """(n,) float64 in the order of the file; empty for text."""
        if self.kind == CHAR:
            return np.empty(0)
        dtype = {BYTE: "u1", WORD: "<i2", FLOAT: "<f4"}[self.kind]
        with np.errstate(invalid="ignore"):  # a damaged float may be a signalling NaN
            return np.frombuffer(self.data, dtype).astype(np.float64)

    @property
    def texts(self) -> tuple[str, ...]:
        """Strings without their padding; empty for numbers."""
        if self.kind != CHAR:
            return ()
        width = self.dims[0] if self.dims else 1
        count = len(self.data) // width if width else 0
        rows = (self.data[i * width : (i + 1) * width] for i in range(count))
        return tuple(text_from_bytes(row).strip(" \0\t\r\n") for row in rows)


@dataclass(frozen=True)
class Group:
    """Parameters that belong together."""

    number: int
    name: str
    description: str = ""
    locked: bool = False
    parameters: tuple[Parameter, ...] = ()


@dataclass(frozen=True)
class Section:
    """All groups of a file. Names are found whatever their case."""

    groups: tuple[Group, ...] = ()

    def group(self, name: str) -> Group | None:
        """Return the first group of that name."""
        return next((g for g in self.groups if g.name.upper() == name.upper()), None)

    def find(self, group: str, name: str) -> Parameter | None:
        """Return the parameter of that name in a group of that name; the last, if several."""
        found = [
            p
            for g in self.groups
            if g.name.upper() == group.upper()
            for p in g.parameters
            if p.name.upper() == name.upper()
        ]
        return found[-1] if found else None

    def numbers(self, group: str, name: str) -> NDArray[Any]:
        """Return a parameter's numbers, and those of its continuations (``OFFSET2``…)."""
        return np.concatenate([np.empty(0), *(p.numbers for p in self._parts(group, name))])

    def number(self, group: str, name: str) -> float | None:
        """Return a parameter's first number; None if there is none."""
        values = self.numbers(group, name)
        return float(values[0]) if len(values) else None

    def count(self, group: str, name: str) -> int | None:
        """Return a whole number, its 16 bits taken as unsigned; None if there is none."""
        parameter = self.find(group, name)
        value = self.number(group, name)
        if parameter is None or value is None or not np.isfinite(value):
            return None
        return int(value) % 65536 if parameter.kind == WORD else int(value)

    def texts(self, group: str, name: str) -> tuple[str, ...]:
        """Return a parameter's strings, and those of its continuations (``LABELS2``…)."""
        return tuple(text for p in self._parts(group, name) for text in p.texts)

    def text(self, group: str, name: str) -> str:
        """Return a parameter's first string, or an empty one."""
        return next(iter(self.texts(group, name)), "")

    def with_parameters(self, group: str, *parameters: Parameter) -> "Section":
        """Return the section with these in a group, in the place of those of the same name.

        What is kept of a parameter that was there before: its spelling, description and lock.
        """
        old = self.group(group)
        if old is None:
            taken = {g.number for g in self.groups}
            free = next((n for n in range(1, 128) if n not in taken), None)
            if free is None:
                raise BadRecording(f"its file has no room for another parameter group, {group}")
            return Section((*self.groups, Group(free, group, parameters=parameters)))
        content = list(old.parameters)
        for new in parameters:
            at = [i for i, p in enumerate(content) if p.name.upper() == new.name.upper()]
            if at:
                was = content[at[-1]]
                same_size = new.kind != CHAR and prod(new.dims) == prod(was.dims)
                content[at[-1]] = replace(
                    was, kind=new.kind, dims=was.dims if same_size else new.dims, data=new.data
                )
            else:
                content.append(new)
        changed = replace(old, parameters=tuple(content))
        return Section(tuple(changed if g is old else g for g in self.groups))

    def with_list(self, group: str, *parts: Parameter) -> "Section":
        """Return the section with a list in parts: ``LABELS`` and its continuations."""
        section = self
        for gone in tuple(self._parts(group, parts[0].name))[len(parts) :]:
            section = section.without(group, gone.name)
        return section.with_parameters(group, *parts)

    def with_texts(self, group: str, name: str, values: Sequence[str]) -> "Section":
        """Return the section with a list of strings, as wide as the one before at least."""
        width = max((p.dims[0] for p in self._parts(group, name) if p.dims), default=0)
        return self.with_list(group, *texts(name, values, width))

    def with_unique_names(self) -> "Section":
        """Return the section with the earlier ones of parameters of one name numbered."""
        return Section(tuple(replace(g, parameters=_numbered(g.parameters)) for g in self.groups))

    def without(self, group: str, name: str) -> "Section":
        """Return the section without that parameter."""
        return Section(
            tuple(
                replace(
                    g,
                    parameters=tuple(p for p in g.parameters if p.name.upper() != name.upper()),
                )
                if g.name.upper() == group.upper()
                else g
                for g in self.groups
            )
        )

    def _parts(self, group: str, name: str) -> Iterable[Parameter]:
        number = 0
        while (p := self.find(group, _part(name, number))) is not None:
            yield p
            number += 1


def text_from_bytes(content: bytes) -> str:
    """Return text that may be UTF-8 or, in older files, Latin-1."""
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError:
        return content.decode("latin-1")


def words(name: str, values: ArrayLike, *dims: int) -> Parameter:
    """Return a parameter of 16-bit words; values up to 65535 are written unsigned."""
    array = np.asarray(values, dtype=np.int64).ravel()
    data = (array % 65536).astype("<u2").tobytes()
    return Parameter(name, WORD, dims, data)


def floats(name: str, values: ArrayLike, *dims: int) -> Parameter:
    """Return a parameter of 32-bit floats; the first of ``dims`` runs fastest."""
    data = np.asarray(values, dtype="<f4").ravel().tobytes()
    if len(data) != 4 * prod(dims):
        raise ValueError(f"{name}: {len(data) // 4} values do not fill {dims}")
    return Parameter(name, FLOAT, dims, data)


def float_list(name: str, values: ArrayLike) -> tuple[Parameter, ...]:
    """Return rows of numbers, (n,) or (n, k), as a parameter and continuations (``SCALE2``…)."""
    rows = np.asarray(values, dtype=np.float64)
    parts = [rows[i : i + MOST] for i in range(0, len(rows), MOST)] or [rows]
    return tuple(
        floats(_part(name, i), part, *part.shape[1:], len(part)) for i, part in enumerate(parts)
    )


def word_list(name: str, values: ArrayLike) -> tuple[Parameter, ...]:
    """Return whole numbers, (n,), as a parameter and continuations (``OFFSET2``…)."""
    row = np.asarray(values)
    parts = [row[i : i + MOST] for i in range(0, len(row), MOST)] or [row]
    return tuple(words(_part(name, i), part, len(part)) for i, part in enumerate(parts))


def text(name: str, value: str) -> Parameter:
    """Return a parameter of one string."""
    data = value.encode()[:MOST]
    return Parameter(name, CHAR, (len(data),), data)


def texts(name: str, values: Sequence[str], width: int = 0) -> tuple[Parameter, ...]:
    """Return strings as a parameter and as many continuations (``LABELS2``…) as they need."""
    rows = [value.encode()[:MOST] for value in values]
    width = max([width, 1, *(len(row) for row in rows)])
    most = min(MOST, LARGEST // width)
    chunks = [rows[i : i + most] for i in range(0, len(rows), most)] or [[]]
    return tuple(
        Parameter(
            _part(name, i),
            CHAR,
            (width, len(chunk)),
            b"".join(row.ljust(width) for row in chunk),
        )
        for i, chunk in enumerate(chunks)
    )


def text_pairs(name: str, values: Sequence[str]) -> Parameter:
    """Return an even number of strings as pairs, the way POINT:TYPE_GROUPS holds them."""
    count = min(len(values) // 2, MOST)
    rows = [value.encode()[:MOST] for value in values[: 2 * count]]
    width = max([1, *(len(row) for row in rows)])
    return Parameter(name, CHAR, (width, 2, count), b"".join(row.ljust(width) for row in rows))


def _part(name: str, i: int) -> str:
    return name if i == 0 else f"{name}{i + 1}"


def _numbered(parameters: tuple[Parameter, ...]) -> tuple[Parameter, ...]:
    taken = {p.name.upper() for p in parameters}
    kept: list[Parameter] = []
    for i, p in enumerate(parameters):
        name, number = p.name, 1
        if any(p.name.upper() == later.name.upper() for later in parameters[i + 1 :]):
            while name.upper() in taken:
                name, number = f"{p.name}_{number}", number + 1
            taken.add(name.upper())
        kept.append(replace(p, name=name))
    return tuple(kept)
