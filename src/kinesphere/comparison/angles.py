"""The angles of a joint that are compared: clinical, about its own axes, and how far it is bent."""

from dataclasses import dataclass

import numpy as np

from kinesphere.comparison.measures import agreement
from kinesphere.comparison.result import ParameterComparison
from kinesphere.comparison.sides import Side, wrapped
from kinesphere.data import Array, Joint, Limb
from kinesphere.data.isb import GIMBAL_MARGIN_DEG, IsbJoint, joint_angles
from kinesphere.parameterization import AngleSettings, TwistSettings
from kinesphere.parameterization.angles import solve_angles


@dataclass(frozen=True, eq=False)
class JointPoses:
    """``parent_from_child`` of one joint, (n, 3, 3), on both sides."""

    first: Array
    second: Array
    """In the second side's own frames."""
    aligned: Array
    """The second side in the first's frames."""


def clinical(
    poses: JointPoses, first: IsbJoint, second: IsbJoint | None
) -> list[ParameterComparison]:
    """Compare the angles after the ISB; before alignment each side is read in its own way."""
    a, b = (_clear_of_gimbal(r, first) for r in (poses.first, poses.aligned))
    own = None if second is None else _clear_of_gimbal(poses.second, second)
    return [
        compared(first.name, name, "clinical", a[:, k], b[:, k], None if own is None else own[:, k])
        for k, name in enumerate(first.angle_names)
    ]


def _clear_of_gimbal(rotations: Array, joint: IsbJoint) -> Array:
    """Return clinical angles, (n, 3), NaN where they are ill-conditioned, the middle one never."""
    angles, margins = joint_angles(rotations, joint)
    with np.errstate(invalid="ignore"):
        near = margins < np.deg2rad(GIMBAL_MARGIN_DEG)
    outer = [k for k, (_, at, _) in enumerate(joint.convention.angles) if at != 1]
    angles[np.ix_(near, outer)] = np.nan
    return angles


def bend(
    poses: JointPoses, parents: tuple[Limb, Limb], children: tuple[Limb, Limb], name: str
) -> ParameterComparison:
    """Compare the angle between the long axes of two limbs, which is 0 where they are in line.

    Parameters
    ----------
    parents, children
        The limbs of the joint, of the first and of the second side.
    """
    first = _between(poses.first, parents[0], children[0])
    aligned = _between(poses.aligned, parents[0], children[0])
    second = _between(poses.second, parents[1], children[1])
    return compared(name, "bend", "bend", first, aligned, second)


def own_axes(
    poses: JointPoses, joint: Joint, child: Limb, before: Array | None
) -> list[ParameterComparison]:
    """Compare the angles about the first side's movement axes, and the twist.

    Where the limb lies so close to the plane of two axes that its angles are ill-conditioned, they
    are left out.

    Parameters
    ----------
    before : (n, 4) rad, optional
        The second side's own angles and twist about its own axes.
    """
    if joint.axes is None or joint.rest is None:
        return []
    known = np.ones(len(poses.first), dtype=bool)
    found, settings = [], AngleSettings()
    for rotations in (poses.first, poses.aligned):
        solved = solve_angles(
            rotations,
            joint.axes,
            joint.rest,
            child.long_axis,
            known,
            settings,
            TwistSettings(),
        )
        angles = np.column_stack([solved.angles, solved.twists])
        with np.errstate(invalid="ignore"):
            angles[solved.sines < np.sin(np.deg2rad(settings.singular))] = np.nan
        found.append(angles)
    a, b = found
    names = [*(f"axis{k + 1}" for k in range(joint.n_axes)), "twist"]
    columns = [*range(joint.n_axes), 3]
    if joint.n_axes == 3:  # three axes take the twist
        names, columns = names[:3], columns[:3]
    return [
        compared(
            joint.name, name, "own", a[:, k], b[:, k], None if before is None else before[:, k]
        )
        for name, k in zip(names, columns, strict=True)
    ]


def own_before(second: Side, joint: Joint) -> Array | None:
    """Return the second side's own angles and twist of a joint, (n, 4) rad.

    None where it has no parameters, or another number of axes: there is nothing to set side by
    side then.
    """
    parameters = second.parameters
    if parameters is None or joint.name not in parameters.skeleton.joint_names:
        return None
    j = parameters.skeleton.joint_names.index(joint.name)
    if parameters.skeleton.joints[j].n_axes != joint.n_axes:
        return None
    return np.column_stack([parameters.angles[:, j], parameters.twists[:, j]])


def compared(
    joint: str, name: str, kind: str, first: Array, aligned: Array, second: Array | None
) -> ParameterComparison:
    """Return two series of one angle side by side, (n,) rad each, unwrapped alike."""
    a = _unwrapped(first)
    b = a + _half_open(aligned - first)
    own = None if second is None else a + _half_open(second - first)
    return ParameterComparison(
        joint=joint,
        name=name,
        kind=kind,
        first=a,
        second=own,
        aligned=b,
        before=None if own is None else agreement(a, own),
        after=agreement(a, b),
    )


def _half_open(differences: Array) -> Array:
    # a half turn is as far one way as the other; both ways round it must be of one size
    return np.asarray(-wrapped(-differences))


def _unwrapped(angles: Array) -> Array:
    known = np.isfinite(angles)
    whole = np.array(angles)
    whole[known] = np.unwrap(angles[known])
    return whole


def _between(rotations: Array, parent: Limb, child: Limb) -> Array:
    along = rotations @ child.long_axis
    sine = np.linalg.norm(np.cross(parent.long_axis, along), axis=1)
    return np.asarray(np.arctan2(sine, along @ parent.long_axis))
