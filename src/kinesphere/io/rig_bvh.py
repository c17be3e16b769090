"""A motion into the hierarchy of a BVH file: its joints, channels and unit, to the letter."""

from pathlib import Path

import numpy as np

from kinesphere.data import Array, Motion
from kinesphere.data.figure import find_figure, rest_from_body, rest_places
from kinesphere.errors import BadModel
from kinesphere.geometry.euler import continuous_angles, euler_angles
from kinesphere.io.atomic import replacing
from kinesphere.io.bones import unit_of_figure
from kinesphere.io.bvh import BVH_FROM_BODY
from kinesphere.io.bvh_hierarchy import BvhNode
from kinesphere.io.bvh_motion import bones_of, positions_are_added
from kinesphere.io.bvh_text import parse_bvh
from kinesphere.io.holding import held
from kinesphere.io.tables import format_rows


def write_bvh_rig(motion: Motion, rig: Path, path: Path) -> tuple[str, ...]:
    """Write a motion with a rig's hierarchy as it stands and its channels in their order.

    Returns what the channels have no place for. A joint with one or two rotation channels turns
    by these alone.
    """
    text = parse_bvh(rig, motion_needed=False)
    bones = bones_of(text.nodes)
    if tuple(node.name for node in text.nodes) != motion.skeleton.limb_names:
        raise BadModel(f"the motion is not on the skeleton of {rig}")
    metres, _ = unit_of_figure(bones, None, "BVH")
    turn = _file_from_world(motion)
    world = turn @ held(_flat(motion), np.zeros((len(bones), 12))).reshape(-1, len(bones), 3, 4)
    turns, places = world[..., :3] @ BVH_FROM_BODY.T, world[..., 3] / metres
    added = len(text.values) > 0 and positions_are_added(text)
    columns: list[Array] = []
    lost: list[str] = []
    for i, node in enumerate(text.nodes):
        above = turns[:, node.parent] if node.parent >= 0 else np.eye(3)
        local = np.swapaxes(np.broadcast_to(above, turns[:, i].shape), -1, -2) @ turns[:, i]
        place = places[:, i]
        if node.parent >= 0:
            offset = places[:, i] - places[:, node.parent]
            place = (np.swapaxes(above, -1, -2) @ offset[..., None])[..., 0]
            place = place - (np.array(node.offset) if added else 0.0)
        elif sum(c.endswith("position") for c in node.channels) < 3:
            lost.append(f"{node.name} has no three positions: the figure stays where it is")
        angles, whole = _angles(local, node)
        if not whole:
            lost.append(f"{node.name} turns about {_order(node).upper() or 'nothing'} alone")
        for channel in node.channels:
            k = "XYZ".index(channel[0])
            values = place[:, k] if channel.endswith("position") else angles[channel[0].lower()]
            columns.append(values[:, None])
    head = f"{text.hierarchy}MOTION\nFrames: {motion.n_frames}\n"
    head += f"Frame Time: {1 / motion.rate:.10f}\n"
    rows = format_rows(columns, ["%.6f"] * len(columns), " ")
    with replacing(path) as temporary:
        temporary.write_text(head + rows, encoding="utf-8", newline="\n")
    return tuple(lost)


def _flat(motion: Motion) -> Array:
    return np.concatenate([motion.rotations, motion.origins[..., None]], axis=3).reshape(
        motion.n_frames, len(motion.skeleton.limbs), 12
    )


def _file_from_world(motion: Motion) -> Array:
    """Return the turn into the world of a file whose figure does not stand along y, (3, 3)."""
    try:
        figure = find_figure(motion.skeleton)
    except BadModel:
        return np.eye(3)
    body = BVH_FROM_BODY @ rest_from_body(figure, rest_places(motion.skeleton))
    return np.eye(3) if body[1, 1] > 0.5 else np.asarray(body @ BVH_FROM_BODY.T)


def _order(node: BvhNode) -> str:
    return "".join(c[0].lower() for c in node.channels if c.endswith("rotation"))


def _angles(local: Array, node: BvhNode) -> tuple[dict[str, Array], bool]:
    """Return letter → degrees, and whether the channels can hold the whole rotation."""
    order = _order(node)
    if len(set(order)) < len(order):
        raise BadModel(f"{node.name} turns twice about {order}; three different axes are right")
    full = order + "".join(letter for letter in "zyx" if letter not in order)
    angles = np.degrees(continuous_angles(euler_angles(local, full)))
    if len(order) < 3:  # nearest to rest, as nothing follows that could make up for it
        angles = np.degrees(euler_angles(local, full))
    spare = np.abs(angles[:, len(order) :])
    whole = bool(spare.max(initial=0.0) < 1e-6)
    return dict(zip(full, angles.T, strict=True)), whole
