"""What is doubtful about a comparison, in words."""

import numpy as np

from kinesphere.comparison.alignment import WorldAlignment
from kinesphere.comparison.result import JointComparison, ParameterComparison
from kinesphere.comparison.sides import Side, relative, unknown_twists
from kinesphere.data import Array
from kinesphere.data.isb import GIMBAL_MARGIN_DEG, isb_joint, joint_angles

_TILTED = np.deg2rad(5.0)  # between two verticals
_UNLIKE = 0.5
"""Median correlation of the clinical angles, or of the bends, below which a warning is loud."""

_STILL = np.deg2rad(5.0)
"""Range, 5 to 95 %, below which a joint keeps still."""


def warnings_of(
    a: Side,
    b: Side,
    world: WorldAlignment | None,
    parameters: list[ParameterComparison],
    names: list[str],
    joints: list[JointComparison],
) -> tuple[str, ...]:
    """Return what a person should not miss, each a sentence.

    Parameters
    ----------
    names
        Joints that both have; ``joints`` are those that could be compared.
    """
    said = []
    # joints that keep still differ by noise alone, which correlates with nothing
    bends = [p for p in parameters if p.kind == "bend" and _moves(p.first)]
    alike = [p.after.correlation for p in bends if np.isfinite(p.after.correlation)]
    if alike and float(np.median(alike)) < _UNLIKE:
        said.append(
            f"the joints do not bend alike (median correlation {np.median(alike):.2f}): these do "
            "not look like two records of one motion at this offset"
        )
    if world is None:
        said.append("the joint centres do not tell how the worlds lie: taken to be the same")
    elif world.tilt > _TILTED:
        said.append(
            f"the verticals of the two worlds differ by {np.rad2deg(world.tilt):.1f}°, which is "
            "taken out: is up the same on both sides?"
        )
    told = [joint.name for joint in joints]
    said += _twistless(a, b, told)
    for name in told:
        mine, theirs = a.skeleton.joint(name), b.skeleton.joint(name)
        if mine.parent != theirs.parent:
            said.append(
                f"{name} hangs from {mine.parent} here and from {theirs.parent} there: "
                "their difference is in its angles"
            )
    if unseen := [name for name in names if name not in told]:
        said.append(f"never seen on both sides at once, hence left out: {', '.join(unseen)}")
    near = [name for name in told if _near_gimbal(a, name)]
    if near:
        said.append(
            f"near the singular pose of its clinical sequence in more than a tenth of the frames, "
            f"which are left out of its first and third angle: {', '.join(near)}"
        )
    return tuple(said)


def _twistless(a: Side, b: Side, joints: list[str]) -> list[str]:
    """Return which limbs of the joints that are compared have a twist that nothing tells."""
    blind = []
    for side in (a, b):
        both = (side.skeleton.joint(name) for name in joints)
        of = {limb for joint in both for limb in (joint.parent, joint.child)}
        blind.append([limb for limb in unknown_twists(side) if limb in of])
    if blind[0] == blind[1]:
        sides = [("both sides", blind[0])]
    else:
        sides = [("the first side", blind[0]), ("the second side", blind[1])]
    return [
        f"nothing tells the twist of {', '.join(limbs)} on {where}: rotations of such a limb and "
        "of what hangs from it say little"
        for where, limbs in sides
        if limbs
    ]


def _moves(angle: Array) -> bool:
    known = angle[np.isfinite(angle)]
    return bool(len(known) and np.ptp(np.percentile(known, [5, 95])) > _STILL)


def _near_gimbal(side: Side, name: str) -> bool:
    """Return whether a joint is ill-conditioned in more than a tenth of the frames."""
    joint = side.skeleton.joint(name)
    read = isb_joint(joint)
    if read is None:
        return False
    _, margins = joint_angles(relative(side, joint.parent, joint.child), read)
    known = margins[np.isfinite(margins)]
    return bool(len(known) and (known < np.deg2rad(GIMBAL_MARGIN_DEG)).mean() > 0.1)
