"""The skeleton as an OpenSim 4 model: a body per limb, a custom joint per joint, the markers.

It is a kinematic model. Masses and inertias are nominal, as nothing in a recording tells them;
scale or replace them before any dynamics.
"""

from pathlib import Path
from xml.etree.ElementTree import Element, ElementTree, SubElement, indent

import numpy as np

from kinesphere.data import Array, Limb, Skeleton
from kinesphere.data.conventions import CONVENTIONS, WRITTEN_BY
from kinesphere.geometry.euler import euler_angles
from kinesphere.io.atomic import replacing
from kinesphere.io.opensim_joints import (
    COORDINATES,
    Turn,
    joint_turns,
    opensim_name,
    root_coordinates,
)

NOMINAL_MASS = 1.0
"""kg of every limb."""
NOMINAL_INERTIA = 0.01
"""kg m² of every limb about every axis."""
SLIGHT = 1e-6
"""kg and kg m² of a body without extent between two joints of one joint."""
_THICK = 0.2
"""Share of its length that the ellipsoid shown for a limb is thick."""
_UNKNOWN_LENGTH = 0.1
"""m, shown where a limb's length is unknown."""


def write_osim(skeleton: Skeleton, path: str | Path) -> None:
    """Write an OpenSim 4 model.

    Bodies carry the names of the limbs, coordinates those of ``joint_coordinates``; ``write_mot``
    writes the motion that belongs to it.

    Raises
    ------
    BadModel
        If a joint has no axes yet.
    """
    document = Element("OpenSimDocument", Version="40000")
    model = SubElement(document, "Model", name="kinesphere")
    said = (WRITTEN_BY + "; masses and inertias are nominal.", *CONVENTIONS.values(), COORDINATES)
    _text(model, "credits", " ".join(said))
    _text(model, "length_units", "meters")
    _text(model, "force_units", "N")
    _text(model, "gravity", "0 -9.80665 0")
    bodies = SubElement(SubElement(model, "BodySet", name="bodyset"), "objects")
    joints = SubElement(SubElement(model, "JointSet", name="jointset"), "objects")
    for limb in skeleton.limbs:
        _add_body(bodies, limb)
    _add_root(joints, skeleton)
    for j in range(len(skeleton.joints)):
        _add_joint(joints, bodies, skeleton, j)
    markers = SubElement(SubElement(model, "MarkerSet", name="markerset"), "objects")
    for limb in skeleton.limbs:
        for label, position in zip(limb.markers, limb.marker_positions, strict=True):
            marker = SubElement(markers, "Marker", name=opensim_name(label))
            _text(marker, "socket_parent_frame", f"/bodyset/{opensim_name(limb.name)}")
            _text(marker, "location", _numbers(position))
            _text(marker, "fixed", "true")
    indent(document, "\t")
    with replacing(path) as temporary, temporary.open("wb") as file:
        ElementTree(document).write(file, encoding="UTF-8", xml_declaration=True)
        file.write(b"\n")


def _add_body(bodies: Element, limb: Limb) -> None:
    body = _body(bodies, opensim_name(limb.name), NOMINAL_MASS, NOMINAL_INERTIA)
    shown = SubElement(
        SubElement(body, "attached_geometry"), "Ellipsoid", name=f"{opensim_name(limb.name)}_shape"
    )
    _text(shown, "socket_frame", "..")
    length = limb.length if limb.length > 0 else _UNKNOWN_LENGTH
    along = np.abs(limb.long_axis)
    _text(shown, "radii", _numbers(length / 2 * (along + _THICK * (1 - along))))


def _body(bodies: Element, name: str, mass: float, inertia: float) -> Element:
    body = SubElement(bodies, "Body", name=name)
    _text(body, "mass", repr(mass))
    _text(body, "mass_center", "0 0 0")
    _text(body, "inertia", f"{inertia!r} {inertia!r} {inertia!r} 0 0 0")
    return body


def _add_root(joints: Element, skeleton: Skeleton) -> None:
    root = opensim_name(skeleton.limbs[0].name)
    joint = SubElement(joints, "FreeJoint", name=f"ground_{root}")
    still = (np.zeros(3), np.zeros(3))
    _add_frames(joint, "/ground", still, f"/bodyset/{root}", still)
    coordinates = SubElement(joint, "coordinates")
    for name in root_coordinates(skeleton):
        _add_coordinate(coordinates, name)


def _add_joint(joints: Element, bodies: Element, skeleton: Skeleton, index: int) -> None:
    joint = skeleton.joints[index]
    groups = joint_turns(skeleton, index)
    parent, name = f"/bodyset/{opensim_name(joint.parent)}", opensim_name(joint.name)
    place = joint.centre_in_parent
    for g, group in enumerate(groups):
        last = g == len(groups) - 1
        body = opensim_name(joint.child) if last else f"{name}_between_{g + 1}"
        if last:
            rest = np.asarray(joint.rest)
            child_end = (joint.centre_in_child, euler_angles(rest.T, "xyz"))
        else:
            _body(bodies, body, SLIGHT, SLIGHT)
            child_end = (np.zeros(3), np.zeros(3))
        part = SubElement(joints, "CustomJoint", name=name if last else f"{name}_{g + 1}")
        _add_frames(part, parent, (place, np.zeros(3)), f"/bodyset/{body}", child_end)
        coordinates = SubElement(part, "coordinates")
        for turn in group:
            if turn.coordinate:
                _add_coordinate(coordinates, turn.coordinate)
        _add_transform(part, group)
        parent, place = f"/bodyset/{body}", np.zeros(3)


def _add_frames(
    joint: Element,
    parent: str,
    at_parent: tuple[Array, Array],
    child: str,
    at_child: tuple[Array, Array],
) -> None:
    _text(joint, "socket_parent_frame", "parent_offset")
    _text(joint, "socket_child_frame", "child_offset")
    frames = SubElement(joint, "frames")
    for name, socket, (place, turned) in (
        ("parent_offset", parent, at_parent),
        ("child_offset", child, at_child),
    ):
        frame = SubElement(frames, "PhysicalOffsetFrame", name=name)
        _text(frame, "socket_parent", socket)
        _text(frame, "translation", _numbers(place))
        _text(frame, "orientation", _numbers(turned))


def _add_coordinate(coordinates: Element, name: str) -> None:
    coordinate = SubElement(coordinates, "Coordinate", name=name)
    _text(coordinate, "default_value", "0")
    _text(coordinate, "clamped", "false")
    _text(coordinate, "locked", "false")


def _add_transform(joint: Element, group: list[Turn]) -> None:
    transform = SubElement(joint, "SpatialTransform")
    for k, turn in enumerate(group, start=1):
        axis = SubElement(transform, "TransformAxis", name=f"rotation{k}")
        _text(axis, "coordinates", turn.coordinate)
        _text(axis, "axis", _numbers(turn.axis))
        if turn.coordinate:
            line = SubElement(axis, "LinearFunction", name="function")
            _text(line, "coefficients", "1 0")
        else:
            _text(SubElement(axis, "Constant", name="function"), "value", "0")
    for k, direction in enumerate(np.eye(3), start=1):
        axis = SubElement(transform, "TransformAxis", name=f"translation{k}")
        _text(axis, "coordinates", "")
        _text(axis, "axis", _numbers(direction))
        _text(SubElement(axis, "Constant", name="function"), "value", "0")


def _text(parent: Element, tag: str, content: str) -> None:
    SubElement(parent, tag).text = content


def _numbers(vector: Array) -> str:
    return " ".join(repr(float(value)) for value in vector)
