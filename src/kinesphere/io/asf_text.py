"""The text of an ASF file, Acclaim's skeleton: bones with axes of their own.

Format: Acclaim's skeleton and motion files as J. Lander (1998), Working with Motion Capture File
Formats, Game Developer, January, describes them, and as CMU's database uses them.
"""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from kinesphere.data import Array
from kinesphere.errors import UnreadableFile
from kinesphere.geometry.rotations import rotation_about
from kinesphere.io.bones import Bone, unit_of_figure
from kinesphere.io.bvh_hierarchy import MOST_JOINTS
from kinesphere.io.text import read_text

ROOT = "root"
_CMU = 0.45
"""The length unit of CMU's files, in which an inch is so long (mocap.cs.cmu.edu, FAQ)."""
_FREEDOMS = ("tx", "ty", "tz", "rx", "ry", "rz", "l")


@dataclass
class AsfBone:
    """A bone of the file; the root is one without length."""

    name: str
    direction: Array
    """(3,) unit vector in the axes of the file, at rest."""
    length: float = 0.0
    axes: Array | None = None
    """(3, 3) the bone's own axes in the file's, at rest."""
    freedoms: tuple[str, ...] = ()
    """``rx``…, in the order of the numbers in a frame."""


class Asf(NamedTuple):
    """A skeleton file as it stands."""

    bones: list[AsfBone]
    """Root first, parents before children."""
    parents: list[int]
    radians: bool
    """Of angles in a motion that does not say it itself."""
    metres: float
    """How many metres the unit of lengths is."""
    position: Array
    """(3,) of the root, added to every frame's."""
    warnings: tuple[str, ...]

    def as_bones(self) -> list[Bone]:
        """Return the bones as hanging from each other, each reaching to its far end."""
        ends = [bone.direction * bone.length for bone in self.bones]
        return [
            Bone(bone.name, parent, ends[parent] if parent >= 0 else np.zeros(3), end)
            for bone, parent, end in zip(self.bones, self.parents, ends, strict=True)
        ]


def parse_asf(path: Path) -> Asf:
    """Parse a skeleton file; raises UnreadableFile naming the line."""
    sections = _sections(path)
    units = dict(words[:2] for _, words in sections.get("units", []) if len(words) >= 2)
    radians = units.get("angle", "deg").lower().startswith("rad")
    root, position = _root(sections.get("root", []), path, radians)
    bones = {ROOT: root}
    for bone in _bones(sections.get("bonedata", []), path, radians):
        if bone.name in bones:
            raise UnreadableFile(f"{path}: bone {bone.name} is there twice")
        if len(bones) == MOST_JOINTS:
            raise UnreadableFile(f"{path} holds more than {MOST_JOINTS} bones")
        bones[bone.name] = bone
    ordered, parents = _tree(bones, sections.get("hierarchy", []), path)
    asf = Asf(ordered, parents, radians, np.nan, position, ())
    scale = _number(units.get("length", "1"), f"{path}: units, length")
    if scale == _CMU:
        return asf._replace(metres=0.0254 / _CMU)
    metres, doubts = unit_of_figure(asf.as_bones(), None, "ASF")
    return asf._replace(metres=metres, warnings=doubts)


def rotation_in_order(angles: Array, order: str) -> Array:
    """Return rotations about fixed axes one after the other, (n, k) rad and k letters of ``xyz``.

    The first letter turns first, as Acclaim has it: ``xyz`` is ``Rz · Ry · Rx``.
    """
    turned = np.broadcast_to(np.eye(3), (len(angles), 3, 3))
    for letter, values in zip(order, angles.T, strict=True):
        turned = rotation_about(np.eye(3)["xyz".index(letter)], values) @ turned
    return turned


_Lines = list[tuple[int, list[str]]]


def _sections(path: Path) -> dict[str, _Lines]:
    """Return section → its lines, numbered, without comments."""
    sections: dict[str, _Lines] = {}
    inside: _Lines | None = None
    for number, line in enumerate(read_text(path).split("\n"), start=1):
        words = line.split("#", 1)[0].split()
        if not words:
            continue
        if words[0].startswith(":"):
            inside = sections.setdefault(words[0][1:].lower(), [])
        elif inside is None:
            raise UnreadableFile(f"{path}: line {number} holds {line.strip()!r:.40} before any :")
        else:
            inside.append((number, words))
    if missing := [name for name in ("root", "bonedata", "hierarchy") if name not in sections]:
        raise UnreadableFile(f"{path} has no section :{missing[0]}; an ASF skeleton has")
    return sections


def _root(lines: _Lines, path: Path, radians: bool) -> tuple[AsfBone, Array]:
    order: tuple[str, ...] = _FREEDOMS[:6]
    axis, position, orientation = "xyz", np.zeros(3), np.zeros(3)
    for number, words in lines:
        where = f"{path}: line {number}"
        match words[0].lower():
            case "order":
                order = _freedoms(words[1:], where)
            case "axis":
                axis = _order(words[1:], where)
            case "position":
                position = _vector(words[1:], where)
            case "orientation":
                orientation = _vector(words[1:], where)
    turned = rotation_in_order(_angles(orientation, radians)[None], axis)[0]
    return AsfBone(ROOT, np.array([0.0, 1.0, 0.0]), 0.0, turned, tuple(order)), position


def _bones(lines: _Lines, path: Path, radians: bool) -> list[AsfBone]:
    bones: list[AsfBone] = []
    told: dict[str, tuple[str, list[str]]] = {}
    for number, words in lines:
        key, where = words[0].lower(), f"{path}: line {number}"
        if key == "begin":
            told = {}
        elif key == "end":
            bones.append(_bone(told, where, radians))
        elif not key.startswith("("):  # further limits
            told[key] = (where, words[1:])
    return bones


def _bone(told: dict[str, tuple[str, list[str]]], where: str, radians: bool) -> AsfBone:
    if missing := [key for key in ("name", "direction", "length") if key not in told]:
        raise UnreadableFile(f"{where}: the bone that ends here has no {missing[0]}")
    name = " ".join(told["name"][1])
    direction = _vector(told["direction"][1], told["direction"][0])
    size = float(np.linalg.norm(direction))
    where, words = told["length"]
    length = _number(words[0] if words else "", where)
    if not length >= 0 or (length > 0 and size == 0):
        raise UnreadableFile(f"{where}: bone {name} is {length:g} long along {direction}")
    axes = np.eye(3)
    if "axis" in told:
        where, words = told["axis"]
        angles = _angles(_vector(words[:3], where), radians)
        axes = rotation_in_order(angles[None], _order(words[3:] or ["XYZ"], where))[0]
    freedoms = _freedoms(told["dof"][1], told["dof"][0]) if "dof" in told else ()
    return AsfBone(name, direction / (size or 1.0), length, axes, freedoms)


def _tree(bones: dict[str, AsfBone], lines: _Lines, path: Path) -> tuple[list[AsfBone], list[int]]:
    at = {ROOT: 0}
    parents = [-1]
    for number, words in lines:
        if words[0].lower() in ("begin", "end"):
            continue
        parent, *children = words
        where = f"{path}: line {number}"
        if parent not in at:
            raise UnreadableFile(f"{where}: {parent!r:.40} hangs from nothing named before")
        for child in children:
            if child not in bones:
                raise UnreadableFile(f"{where}: there is no bone {child!r:.40}")
            if child in at:
                raise UnreadableFile(f"{where}: {child} hangs from two bones")
            at[child] = len(at)
            parents.append(at[parent])
    if loose := [name for name in bones if name not in at]:
        raise UnreadableFile(f"{path}: the hierarchy leaves out {', '.join(loose[:5])}")
    return [bones[name] for name in at], parents


def _angles(vector: Array, radians: bool) -> Array:
    return vector if radians else np.radians(vector)


def _freedoms(words: list[str], where: str) -> tuple[str, ...]:
    freedoms = tuple(word.lower() for word in words)
    if set(freedoms) - set(_FREEDOMS) or len(set(freedoms)) < len(freedoms):
        raise UnreadableFile(f"{where} holds {' '.join(words)!r:.40}; rx, ry, rz… are right")
    return freedoms


def _order(words: list[str], where: str) -> str:
    order = "".join(words).lower()
    if sorted(order) != ["x", "y", "z"]:
        raise UnreadableFile(f"{where} holds {' '.join(words)!r:.40} where XYZ was expected")
    return order


def _vector(words: list[str], where: str) -> Array:
    # CMU writes (0.0 1.0 0.0) here and there
    plain = re.sub(r"[(),]", " ", " ".join(words)).split()
    if len(plain) != 3:
        raise UnreadableFile(f"{where} holds {' '.join(words)!r:.40}; three numbers are right")
    return np.array([_number(word, where) for word in plain])


def _number(word: str, where: str) -> float:
    try:
        value = float(word)
    except ValueError:
        value = np.nan
    if not np.isfinite(value):
        raise UnreadableFile(f"{where} holds {word!r:.40} where a number was expected")
    return value
