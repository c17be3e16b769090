"""BVH, the motion format of animation: a hierarchy in its rest pose, then local angles a frame.

The rest pose stands, arms hanging, and faces +z, y up, as characters do in animation programs.
Every joint frame of the file is then the limb's normalized frame turned by one and the same
``bvh_from_body``, and a local rotation of the file is ``parent_from_child`` seen in those axes.
Format: M. Meredith, S. Maddock (2001), Motion Capture File Formats Explained, section 3.1.
"""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Literal, NamedTuple, TypeAlias

import numpy as np

from kinesphere.data import Array, Limb, Motion, Skeleton
from kinesphere.errors import BadSetting
from kinesphere.geometry.euler import continuous_angles, euler_angles
from kinesphere.geometry.rotations import rotation_about
from kinesphere.io.atomic import replacing
from kinesphere.io.bvh_names import NAMINGS, renamed
from kinesphere.io.bvh_settings import ORDERS
from kinesphere.io.holding import held
from kinesphere.io.tables import format_rows
from kinesphere.io.units import metres_from_unit

RestPose: TypeAlias = Literal["standing", "t-pose"]

BVH_FROM_BODY = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
"""Body axes are x front, y up, z right; the file's rest pose has z front, y up, x left."""
_STUB = 0.05
"""m, length of a limb whose end nobody knows."""
_THIGHS = ("left_thigh", "right_thigh")
_ARM = re.compile(r"(left|right)_(upper_arm|forearm|hand)$")


class _Node(NamedTuple):
    """A limb as the file has it: it turns about the joint towards its parent."""

    pivot: Array
    """(3,) m in the limb frame: where the limb hangs; a point of choice for the root."""
    offset: Array
    """(3,) m from the parent's pivot in the rest pose, body axes."""
    end: Array
    """(3,) m from the pivot to the limb's far end in the rest pose, body axes."""


def write_bvh(
    motion: Motion,
    path: str | Path,
    unit: str = "cm",
    rest: RestPose = "standing",
    names: str = "kinesphere",
    channels: str = "smooth",
) -> None:
    """Write a motion with normalized limb frames as BVH.

    BVH has no gaps: an unseen limb keeps its last known local rotation (before the first, that
    one; never seen, the rest pose). BVH has no joints that come apart: limbs hang from the root by
    the skeleton's own measures. It holds no first frame number.

    Parameters
    ----------
    motion
        World with y up; its limb frames aligned with the body by ``normalization``.
    unit
        Of lengths; BVH cannot name it. Centimetres are the custom.
    rest
        ``"standing"`` with hanging arms, or ``"t-pose"`` with arms raised to the sides. Limbs of a
        motion that was read from BVH or AMC keep the rest pose of their file.
    names
        ``"kinesphere"``, ``"unity"`` or ``"motionbuilder"``: what limbs are called.
    channels
        ``"smooth"``, ``"zxy"`` or ``"zyx"``: the order of rotations, as `BvhSettings` has it.

    Raises
    ------
    BadSetting
        If unit, rest pose, names or channels are unknown.
    """
    metres = metres_from_unit(unit)
    if metres is None:
        raise BadSetting(f"unit {unit!r} is unknown; cm, m and mm are some that are known")
    for what, value, known in (
        ("rest", rest, ("standing", "t-pose")),
        ("names", names, tuple(NAMINGS)),
        ("channels", channels, tuple(ORDERS)),
    ):
        if value not in known:
            raise BadSetting(f"{what} is {value!r}; known are {', '.join(known)}")
    orders = ORDERS[channels]
    skeleton = motion.skeleton
    body_from_limb = np.stack([_rest_rotation(limb, rest) for limb in skeleton.limbs])
    nodes = _nodes(skeleton, body_from_limb)

    at_pivots = motion.rotations[:, 0] @ nodes[0].pivot + motion.origins[:, 0]
    root_place = held(at_pivots, np.zeros(3)) / metres
    turns = [
        np.degrees(continuous_angles(euler_angles(local, orders[min(i, 1)])))
        for i, local in enumerate(_local_rotations(motion, body_from_limb))
    ]
    columns = [root_place, *(turns[i] for i in _depth_first(skeleton))]

    called = renamed(skeleton.limb_names, names)  # type: ignore[arg-type]  # checked above
    places = [
        (name, node.offset @ BVH_FROM_BODY.T / metres, node.end @ BVH_FROM_BODY.T / metres)
        for name, node in zip(called, nodes, strict=True)
    ]
    head = [
        "HIERARCHY",
        *_hierarchy(skeleton, places, orders),
        "MOTION",
        f"Frames: {motion.n_frames}",
        f"Frame Time: {1 / motion.rate:.10f}",
    ]
    text = "\n".join(head) + "\n" + format_rows(columns, ["%.6f"] * len(columns), " ")
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


def _rest_rotation(limb: Limb, rest: RestPose) -> Array:
    """Return ``body_from_limb`` in the rest pose: normalized frames stand as they are."""
    arm = _ARM.match(limb.name)
    if rest == "standing" or not arm:
        return np.eye(3)
    side = 1.0 if arm[1] == "left" else -1.0  # about x, −y towards −z: to the left
    raised: Array = rotation_about(np.array([1.0, 0.0, 0.0]), np.array(side * np.pi / 2))
    return raised


def _nodes(skeleton: Skeleton, body_from_limb: Array) -> list[_Node]:
    root = skeleton.limbs[0]
    # told by the limbs, for a layout may call its joints what it likes
    hips = [j for j in skeleton.joints if j.child in _THIGHS and j.parent == root.name]
    middle = np.mean([j.centre_in_parent for j in hips], axis=0) if len(hips) == 2 else np.zeros(3)
    pivots = [middle, *(joint.centre_in_child for joint in skeleton.joints)]
    nodes = [_Node(middle, np.zeros(3), body_from_limb[0] @ _to_end(root, middle))]
    for i, joint in enumerate(skeleton.joints, start=1):
        parent = skeleton.parents[i]
        offset = body_from_limb[parent] @ (joint.centre_in_parent - pivots[parent])
        end = body_from_limb[i] @ _to_end(skeleton.limbs[i], pivots[i])
        nodes.append(_Node(pivots[i], offset, end))
    return nodes


def _to_end(limb: Limb, pivot: Array) -> Array:
    """Return the way along the long axis from the pivot to the end, (3,) m."""
    length = limb.length
    if not length > 0 and len(limb.markers):  # NaN, too: as far as its markers reach
        length = float(np.nanmax((limb.marker_positions - pivot) @ limb.long_axis, initial=0.0))
    return (length if length > 0 else _STUB) * limb.long_axis


def _local_rotations(motion: Motion, body_from_limb: Array) -> list[Array]:
    """Return each limb's rotation against its parent in the file's axes, (n_frames, 3, 3)."""
    file_from_limb = BVH_FROM_BODY @ body_from_limb
    rest = np.eye(3)
    turned = [held(motion.rotations[:, 0] @ file_from_limb[0].T, rest)]
    for i, relative in enumerate(np.moveaxis(motion.relative_rotations(), 1, 0), start=1):
        parent = motion.skeleton.parents[i]
        turned.append(held(file_from_limb[parent] @ relative @ file_from_limb[i].T, rest))
    return turned


def _depth_first(skeleton: Skeleton, limb: int = 0) -> list[int]:
    """Return the limbs in the order the hierarchy names them."""
    below = [_depth_first(skeleton, int(i)) for i in np.flatnonzero(skeleton.parents == limb)]
    return [limb, *(i for branch in below for i in branch)]


def _hierarchy(
    skeleton: Skeleton,
    places: Sequence[tuple[str, Array, Array]],
    orders: tuple[str, str],
    limb: int = 0,
) -> list[str]:
    name, offset, end = places[limb]
    name = re.sub(r"\s", "_", name)
    order = orders[min(limb, 1)]
    channels = [f"{letter.upper()}rotation" for letter in order]
    if not limb:
        channels = ["Xposition", "Yposition", "Zposition", *channels]
    inner = [f"OFFSET {_numbers(offset)}", f"CHANNELS {len(channels)} {' '.join(channels)}"]
    children = np.flatnonzero(skeleton.parents == limb)
    for child in children:
        inner += _hierarchy(skeleton, places, orders, int(child))
    if not len(children):
        inner += ["End Site", "{", f"\tOFFSET {_numbers(end)}", "}"]
    kind = "JOINT" if limb else "ROOT"
    return [f"{kind} {name}", "{", *("\t" + line for line in inner), "}"]


def _numbers(vector: Array) -> str:
    return " ".join(f"{value:.6f}" for value in np.round(vector, 6) + 0.0)  # no minus zero
