"""Bones as animation files have them, and what they are in metres.

A bone turns about the place where it hangs from its parent. Its limb frame is chosen such that in
the rest pose all limb frames stand parallel to the body's (x front, y up, z right), as those of a
normalized skeleton do: whatever knows rest poses need not ask which file they came from.
"""

from typing import NamedTuple

import numpy as np

from kinesphere.data import Array, Joint, Limb, Skeleton
from kinesphere.errors import BadSetting
from kinesphere.io.units import metres_from_unit

TALL = 1.65
"""m, what the figures of files span in their rest pose, more or less."""
_GUESSES = {"m": 0.0, "cm": 0.0, "mm": 0.0, "in": 0.5, "1/0.45 in": 0.8}
"""Unit → how much it must fit better than metres do, as a logarithm; the last is CMU's."""
_ODD = {"1/0.45 in": 0.0254 / 0.45}
_LEAST = 1e-9
"""m, a bone shorter than this has no direction."""


class Bone(NamedTuple):
    """A joint of a file and what hangs from it rigidly, in the file's unit and axes."""

    name: str
    parent: int
    """−1 for the root."""
    offset: Array
    """(3,) from the parent's place, in the rest pose."""
    end: Array | None
    """(3,) from its own place to its far end, where the file says so."""


def unit_of_figure(
    bones: list[Bone], unit: str | None, format_name: str
) -> tuple[float, tuple[str, ...]]:
    """Return how many metres a file's unit is, and what is doubtful about it.

    Raises
    ------
    BadSetting
        If ``unit`` is unknown.
    """
    if unit is not None:
        if (metres := metres_from_unit(unit)) is None:
            raise BadSetting(f"unit {unit!r} is unknown; cm, m and in are some that are known")
        return metres, ()
    places = np.zeros((len(bones), 3))
    ends = []
    for i, bone in enumerate(bones):
        places[i] = (bone.offset + places[bone.parent]) if bone.parent >= 0 else 0.0
        ends.append(places[i] + (0.0 if bone.end is None else bone.end))
    span = float(np.ptp(np.vstack([places, *ends]), axis=0).max())
    if not span > 0:
        return 0.01, (f"{format_name} names no unit and the figure has no size; cm is taken",)
    size = {name: _ODD.get(name) or metres_from_unit(name) or np.nan for name in _GUESSES}
    guess = min(_GUESSES, key=lambda name: abs(np.log(span * size[name] / TALL)) + _GUESSES[name])
    return size[guess], (
        f"{format_name} names no unit of length; {guess} is guessed, as the figure then spans "
        f"{span * size[guess]:.2f} m",
    )


def skeleton_of_bones(bones: list[Bone], metres: float, file_from_body: Array) -> Skeleton:
    """Return bones as limbs, each with its frame where it hangs from its parent.

    Parameters
    ----------
    metres
        How many metres the bones' unit is.
    file_from_body : (3, 3)
        How the rest pose stands in the file's axes.
    """
    into_limb = metres * file_from_body  # a row times this is in body axes and metres
    limbs, joints = [], []
    children: list[list[int]] = [[] for _ in bones]
    for i, bone in enumerate(bones):
        if bone.parent >= 0:
            children[bone.parent].append(i)
    for i, bone in enumerate(bones):
        end = bone.end
        if end is None and children[i]:
            end = bones[max(children[i], key=lambda c: float(np.linalg.norm(bones[c].offset)))][2]
        way = np.zeros(3) if end is None else end @ into_limb
        length = float(np.linalg.norm(way))
        known = length > _LEAST
        parent = bones[bone.parent].name if bone.parent >= 0 else None
        limbs.append(
            Limb(
                name=bone.name,
                parent=parent,
                markers=(),
                marker_positions=np.empty((0, 3)),
                length=length if known else np.nan,
                long_axis=way / length if known else np.array([0.0, 1.0, 0.0]),
            )
        )
        if parent is not None:
            joints.append(
                Joint(
                    name=bone.name,
                    parent=parent,
                    child=bone.name,
                    centre_in_parent=bone.offset @ into_limb,
                    centre_in_child=np.zeros(3),
                    residual=np.nan,
                    range_of_motion=np.nan,
                    covariance=np.full((3, 3), np.nan),
                    observability="given",
                )
            )
    return Skeleton(tuple(limbs), tuple(joints))
