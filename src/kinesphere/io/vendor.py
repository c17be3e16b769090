"""Points that are no markers: what a vendor's software computed and stored among them."""

import re
from collections.abc import Mapping, Sequence
from itertools import combinations

import numpy as np

from kinesphere.data import Array, OutputKind

_KIND_OF_TYPE: Mapping[str, OutputKind] = {
    "ANGLE": "angle",
    "FORCE": "force",
    "MOMENT": "moment",
    "POWER": "power",
    "SCALAR": "scalar",
}
_SUFFIXES: Mapping[str, OutputKind] = {
    "Angle": "angle",
    "Angles": "angle",
    "Force": "force",
    "GRF": "force",
    "Moment": "moment",
    "Power": "power",
    "Scalar": "scalar",
}
"""CamelCase endings of the names that Plug-in Gait and its kin give: ``LKneeAngles``."""
_ENDING = re.compile(rf"[A-Za-z0-9]({'|'.join(sorted(_SUFFIXES, key=len, reverse=True))})$")
_CENTRE_OF_MASS = re.compile(r"^Cent(re|er)OfMass", re.IGNORECASE)
_FRAME_ENDS = ("O", "A", "L", "P")
"""Plug-in Gait's segment frames: origin, and points along the anterior, left and third axis."""
_EQUAL = 0.01
"""Share by which the axes of a segment frame differ in length at one instant (measured: 0.0003)."""
_SQUARE = 0.15
"""Largest |cosine| between two of them (measured: 1e-6, the feet of one old file 0.09). Their
length itself varies, by up to 30 % over a trial: it is the bone's, measured in every frame."""


def kind_of_type(type_name: str) -> OutputKind:
    """Return the kind of a typed group: ``ANGLE`` of the pair ``ANGLES, ANGLE``."""
    name = type_name.strip().upper()
    return _KIND_OF_TYPE.get(name) or _KIND_OF_TYPE.get(name.removesuffix("S"), "other")


def output_kinds(
    labels: Sequence[str], points: Array, typed: Mapping[str, OutputKind]
) -> tuple[OutputKind | None, ...]:
    """Return what each point of a file is: a kind of output, or None for a marker.

    Parameters
    ----------
    labels
        Names of the points, subject prefixes (``Matt:PELO``) included.
    points : (n_frames, n_points, 3)
        In any unit; NaN where not seen.
    typed
        Kind of the points that the file itself puts in a typed group.
    """
    frames = _segment_frame_points(labels, points)
    return tuple(_kind(label, label in frames, typed) for label in labels)


def _kind(label: str, in_frame: bool, typed: Mapping[str, OutputKind]) -> OutputKind | None:
    bare = label.rpartition(":")[2]
    if _CENTRE_OF_MASS.match(bare):
        return "centre_of_mass"
    if label in typed:
        return typed[label]
    if in_frame:
        return "segment_frame"
    ending = _ENDING.search(bare)
    return _SUFFIXES[ending[1]] if ending else None


def _segment_frame_points(labels: Sequence[str], points: Array) -> set[str]:
    column = {label: i for i, label in enumerate(labels)}
    found: set[str] = set()
    for label in labels:
        names = [label[:-1] + end for end in _FRAME_ENDS]
        stem = label[:-1].rpartition(":")[2]
        if not label.endswith(_FRAME_ENDS[0]) or not stem or not all(n in column for n in names):
            continue
        if _is_cross(points[:, [column[name] for name in names]]):
            found.update(names)
    return found


def _is_cross(quadruple: Array) -> bool:
    """Tell a computed frame from four markers that happen to bear such names.

    A computed frame has three axes of one length, square to each other; markers on a limb do not.

    Parameters
    ----------
    quadruple : (n_frames, 4, 3)
        Origin and the ends of the axes. Where they are never all seen, the names decide.
    """
    seen = quadruple[np.isfinite(quadruple).all(axis=(1, 2))]
    if not len(seen):
        return True
    axes = seen[:, 1:] - seen[:, :1]
    lengths = np.linalg.norm(axes, axis=2)
    shortest = lengths.min(axis=1)
    if np.median(lengths.max(axis=1) - shortest) > _EQUAL * np.median(shortest):
        return False
    dots = [(axes[:, i] * axes[:, j]).sum(axis=1) for i, j in combinations(range(3), 2)]
    with np.errstate(invalid="ignore", divide="ignore"):
        cosines = np.abs(dots) / shortest**2
    return bool((np.median(cosines, axis=1) < _SQUARE).all())
