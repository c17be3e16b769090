"""A BVH file into a Motion: every joint a limb, its rest pose the pose of rest."""

from pathlib import Path

import numpy as np

from kinesphere.data import Array, Motion, Skeleton, Step
from kinesphere.geometry.rotations import rotation_about
from kinesphere.io.bones import Bone, skeleton_of_bones, unit_of_figure
from kinesphere.io.bvh import BVH_FROM_BODY
from kinesphere.io.bvh_hierarchy import BvhNode
from kinesphere.io.bvh_text import BvhText, parse_bvh
from kinesphere.io.rig_motion import motion_of_bones


def read_bvh(path: str | Path, unit: str | None = None) -> Motion:
    """Read a BVH file.

    Every joint becomes a limb that hangs where the file has it; all limb frames stand parallel in
    the file's rest pose, taken as facing +z with y up. A world whose figures stand along z is
    turned so that y is up, aloud.

    Parameters
    ----------
    unit
        Of lengths, which BVH cannot name; None to guess it by the size of the figure, aloud.

    Raises
    ------
    UnreadableFile
        Naming the line, what was found and what would be right.
    BadSetting
        If the unit is unknown.
    """
    path = Path(path)
    text = parse_bvh(path)
    bones = bones_of(text.nodes)
    metres, doubts = unit_of_figure(bones, unit, "BVH")
    rotations, places, warnings = bvh_poses(text)
    return motion_of_bones(
        bones,
        rotations,
        places,
        metres,
        text.rate,
        BVH_FROM_BODY,
        Step(
            "read",
            {"format": "bvh", "file": path.name},
            {"n_frames": len(rotations), "n_joints": len(bones), "rate_hz": text.rate},
            (*text.warnings, *doubts, *warnings),
        ),
    )


def read_bvh_skeleton(path: str | Path, unit: str | None = None) -> Skeleton:
    """Read the hierarchy of a BVH file alone, which may hold no motion."""
    text = parse_bvh(path, motion_needed=False)
    bones = bones_of(text.nodes)
    metres, _ = unit_of_figure(bones, unit, "BVH")
    return skeleton_of_bones(bones, metres, BVH_FROM_BODY)


def bones_of(nodes: list[BvhNode]) -> list[Bone]:
    """Return the joints of a hierarchy as bones in the file's unit and axes."""
    return [
        Bone(n.name, n.parent, np.array(n.offset), None if n.end is None else np.array(n.end))
        for n in nodes
    ]


def bvh_poses(text: BvhText) -> tuple[Array, Array, tuple[str, ...]]:
    """Return how joints turn, where they are, and what is doubtful.

    Rotations multiply in the order of their channels. Positions stand in place of the offset; where
    a file's inner joints have positions that are zero while their offsets are not, they are added.

    Returns
    -------
    rotations, places : (n_frames, n, 3, 3), (n_frames, n, 3)
        In the file's axes and unit.
    warnings
    """
    nodes, n = text.nodes, len(text.values)
    columns = np.cumsum([0, *(len(node.channels) for node in nodes)])
    rotations = np.empty((n, len(nodes), 3, 3))
    places = np.empty((n, len(nodes), 3))
    added = positions_are_added(text)
    for i, node in enumerate(nodes):
        place = np.tile(np.array(node.offset), (n, 1))
        turn = np.broadcast_to(np.eye(3), (n, 3, 3))
        for channel, values in zip(
            node.channels, text.values[:, columns[i] : columns[i + 1]].T, strict=True
        ):
            k = "XYZ".index(channel[0])
            if channel.endswith("position"):
                place[:, k] = values + (node.offset[k] if added and i else 0.0)
            else:
                turn = turn @ rotation_about(np.eye(3)[k], np.radians(values))
        if (p := node.parent) >= 0:
            place = places[:, p] + (rotations[:, p] @ place[..., None])[..., 0]
            turn = rotations[:, p] @ turn
        rotations[:, i], places[:, i] = turn, place
    said = "positions of inner joints are taken as added to their offsets, being nearly zero"
    return rotations, places, (said,) if added else ()


def positions_are_added(text: BvhText) -> bool:
    """Return whether positions of inner joints are nearly zero where their offsets are not."""
    columns = np.cumsum([0, *(len(node.channels) for node in text.nodes)])
    instead = besides = 0.0
    for i, node in enumerate(text.nodes[1:], start=1):
        for k, channel in enumerate(node.channels):
            if channel.endswith("position"):
                offset = node.offset["XYZ".index(channel[0])]
                values = text.values[:, int(columns[i]) + k]
                instead += float(np.nanmean(np.abs(values - offset)))
                besides += float(np.nanmean(np.abs(values)))
    return besides < 0.5 * instead
