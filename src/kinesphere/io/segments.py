"""Which marker sits on which limb, from an OpenSim marker set or model, JSON or TOML."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from kinesphere.errors import UnreadableFile
from kinesphere.io.json_files import read_json
from kinesphere.io.text import read_text
from kinesphere.io.xml_files import read_xml

LIMB_OF_BODY = {
    "humerus": "upper_arm",
    "radius": "forearm",
    "ulna": "forearm",
    "hand": "hand",
    "femur": "thigh",
    "tibia": "shank",
    "fibula": "shank",
    "calcn": "foot",
    "talus": "foot",
    "toes": "foot",
    "foot": "foot",
}
"""OpenSim's body, without its side → limb, without its side."""
MIDDLE_OF_BODY = {"torso": "trunk", "thorax": "trunk", "pelvis": "pelvis", "head": "head"}
_SIDES = {"_l": "left_", "_r": "right_"}


def read_segments(path: str | Path) -> dict[str, tuple[str, ...]]:
    """Read which markers move with which limb.

    An OpenSim ``MarkerSet`` or whole model (``.osim``): a marker belongs to the body it is fixed
    to; OpenSim's usual bodies get the names of the conventions (``femur_r`` → ``right_thigh``),
    others keep theirs. JSON or TOML: an object (or its ``segments``) of limb → list of labels.

    Returns
    -------
    dict
        Limb → labels, both in the order of the file.

    Raises
    ------
    UnreadableFile
        If the file is damaged or none of these, or a marker sits on two limbs.
    """
    path = Path(path)
    start = read_text(path).lstrip()
    if start.startswith("<"):
        found = _from_opensim(path)
    elif start.startswith("{"):
        found = _from_mapping(read_json(path), path)
    else:
        found = _from_mapping(_read_toml(path), path)
    owners: dict[str, str] = {}
    for limb, labels in found.items():
        for label in labels:
            if label in owners:
                where = limb if owners[label] == limb else f"{owners[label]} and {limb}"
                raise UnreadableFile(f"{path}: marker {label} is there twice, on {where}")
            owners[label] = limb
    return found


def limb_of_body(body: str) -> str:
    """Return the limb that an OpenSim body is part of; unknown bodies keep their name."""
    if body in MIDDLE_OF_BODY:
        return MIDDLE_OF_BODY[body]
    stem, side = body[:-2], _SIDES.get(body[-2:])
    return side + LIMB_OF_BODY[stem] if side and stem in LIMB_OF_BODY else body


def _from_opensim(path: Path) -> dict[str, tuple[str, ...]]:
    found: dict[str, tuple[str, ...]] = {}
    for marker in read_xml(path).iter("Marker"):
        # OpenSim 4 has a path in a socket; OpenSim 3 had the name of the body
        parent = marker.findtext("socket_parent_frame") or marker.findtext("body") or ""
        body = parent.strip().rpartition("/")[2]
        label = marker.get("name", "").strip()
        if not label or not body:
            raise UnreadableFile(
                f"{path}: marker {label!r} has no {'body' if label else 'name'}; "
                f"socket_parent_frame should name one"
            )
        limb = limb_of_body(body)
        found[limb] = (*found.get(limb, ()), label)
    if not found:
        raise UnreadableFile(f"{path} holds no Marker; an OpenSim MarkerSet or model was expected")
    return found


def _read_toml(path: Path) -> Any:
    try:
        return tomllib.loads(read_text(path))
    except tomllib.TOMLDecodeError as error:
        raise UnreadableFile(f"{path} is neither OpenSim XML nor JSON nor TOML ({error})") from None


def _from_mapping(content: Any, path: Path) -> dict[str, tuple[str, ...]]:
    if isinstance(content, Mapping) and isinstance(content.get("segments"), Mapping):
        content = content["segments"]
    if not isinstance(content, Mapping) or not content:
        raise UnreadableFile(f"{path}: an object of limb → list of labels was expected")
    found: dict[str, tuple[str, ...]] = {}
    for limb, labels in content.items():
        good = isinstance(labels, list) and labels and all(isinstance(x, str) for x in labels)
        if not good:
            raise UnreadableFile(
                f"{path}: {limb} holds {str(labels)[:40]!r}; a list of labels was expected"
            )
        found[limb] = tuple(labels)
    return found
