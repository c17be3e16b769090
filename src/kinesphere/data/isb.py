"""Clinical joint angles of a motion, beside those about the person's own axes."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from kinesphere.data.arrays import Array, Mask, frozen
from kinesphere.data.isb_conventions import (
    CONVENTIONS,
    ROOT_CONVENTION,
    ROOTS,
    Convention,
    without_side,
)
from kinesphere.data.motion import Motion
from kinesphere.data.skeleton import Joint, Skeleton
from kinesphere.geometry.euler import euler_angles, swing_angles
from kinesphere.geometry.rotations import rotation_about

GIMBAL_MARGIN_DEG = 10.0
"""deg; closer to the singular pose, an error of orientation grows more than 5.8 times in an angle:
1 / sin 10°."""
LARGEST_TURN_DEG = 60.0
"""deg; a flexion axis farther from the body's lateral axis than this is believed to be none."""
_MIRROR = np.diag([1.0, 1.0, -1.0])
_UP = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True, eq=False)
class IsbJoint:
    """How the angles of one joint, or of the root in the laboratory, are read."""

    name: str
    convention: Convention
    turn: float
    """rad by which z is turned forward from the body's lateral axis, about the long axis."""
    turn_from: str
    """``body``, ``movement axis`` or ``palms to the thighs``."""

    @property
    def angle_names(self) -> tuple[str, ...]:
        """Clinical names: ``flexion``, ``adduction``, ``internal_rotation``."""
        return tuple(name for name, _, _ in self.convention.angles)


@dataclass(frozen=True, eq=False)
class IsbAngles:
    """Clinical angles over time; left and right have the same sign for mirrored movements."""

    joints: tuple[IsbJoint, ...]
    """The root first, where it has a name."""
    angles: Array
    """(n_frames, n_joints, 3) rad in (−π, π], in the order of ``angle_names``; NaN where unseen."""
    margins: Array
    """(n_frames, n_joints) rad to the nearest singular pose of the sequence."""
    rate: float
    """Hz."""
    first_frame: int = 1

    def __post_init__(self) -> None:
        n = len(self.joints)
        put = object.__setattr__
        put(self, "angles", frozen(self.angles, None, n, 3, name="ISB angles"))
        put(self, "margins", frozen(self.margins, len(self.angles), n, name="margins"))

    @property
    def n_frames(self) -> int:
        """Number of frames."""
        return len(self.angles)

    @property
    def times(self) -> Array:
        """(n_frames,) s since the first stored frame."""
        return np.arange(self.n_frames) / self.rate

    @property
    def gimbal(self) -> Mask:
        """(n_frames, n_joints) True closer to the singular pose than GIMBAL_MARGIN_DEG."""
        with np.errstate(invalid="ignore"):
            return np.asarray(self.margins < np.deg2rad(GIMBAL_MARGIN_DEG))

    @cached_property
    def names(self) -> tuple[str, ...]:
        """``left_knee.flexion`` of every angle, joint by joint."""
        return tuple(
            f"{joint.name}.{angle}" for joint in self.joints for angle in joint.angle_names
        )

    def angle(self, name: str) -> Array:
        """Return one angle by its name, (n_frames,) rad; KeyError if there is none."""
        at = {known: i for i, known in enumerate(self.names)}[name]
        return self.angles[:, at // 3, at % 3]


def isb_angles(motion: Motion, skeleton: Skeleton | None = None) -> IsbAngles:
    """Return the clinical angles of every joint whose name says what it is.

    Sequences and signs are those of the ISB (`isb_conventions.CONVENTIONS`); the left side is
    mirrored first, so that equal movements have equal signs. Zero is where the limbs lie in line
    with the body, and their twist as in the default position. Frames are the normalized ones, not
    those of bony landmarks: docs/conventions.md says how they differ.

    Parameters
    ----------
    motion
        With normalized limb frames.
    skeleton
        The same with movement axes, if any: knee and elbow take the direction of z from the
        flexion axis that was measured there, which keeps flexion out of the other two angles.

    Returns
    -------
    IsbAngles
        Without any joint where the skeleton has no names.
    """
    skeleton = motion.skeleton if skeleton is None else skeleton
    joints, values, margins = [], [], []
    if (root := motion.skeleton.limb_names[0]) in ROOTS:
        joints.append(IsbJoint(root, ROOT_CONVENTION, 0.0, "body"))
        found = joint_angles(motion.rotations[:, 0], joints[0])
        values.append(found[0])
        margins.append(found[1])
    relative = motion.relative_rotations()
    for j, joint in enumerate(motion.skeleton.joints):
        if (read := isb_joint(skeleton.joint(joint.name))) is not None:
            joints.append(read)
            found = joint_angles(relative[:, j], read)
            values.append(found[0])
            margins.append(found[1])
    n = motion.n_frames
    return IsbAngles(
        joints=tuple(joints),
        angles=np.stack(values, axis=1) if values else np.empty((n, 0, 3)),
        margins=np.stack(margins, axis=1) if margins else np.empty((n, 0)),
        rate=motion.rate,
        first_frame=motion.first_frame,
    )


def isb_joint(joint: Joint) -> IsbJoint | None:
    """Return how a joint's clinical angles are read; None where its name does not say."""
    convention = CONVENTIONS.get(without_side(joint.name))
    if convention is None:
        return None
    turn, source = np.deg2rad(convention.palm_turn_deg), "body"
    if convention.palm_turn_deg:
        source = "palms to the thighs"
    if convention.hinged and joint.axes is not None and joint.axes_source not in (None, "body"):
        measured = _turn_of(joint.axes, left=joint.name.startswith("left_"))
        if abs(measured) <= np.deg2rad(LARGEST_TURN_DEG):
            turn, source = measured, "movement axis"
    return IsbJoint(joint.name, convention, float(turn), source)


def joint_angles(parent_from_child: Array, joint: IsbJoint) -> tuple[Array, Array]:
    """Return clinical angles, (n, 3) rad, and how far the singular pose is, (n,) rad.

    Parameters
    ----------
    parent_from_child : (n, 3, 3)
        Of normalized frames, of either side; ``world_from_root`` for the root.
    """
    r = parent_from_child
    if joint.name.startswith("left_"):
        r = _MIRROR @ r @ _MIRROR
    if joint.turn:
        turn = rotation_about(_UP, np.array(joint.turn))
        r = turn.T @ r @ turn
    sequence = joint.convention.sequence
    if sequence == "YXY":
        raw = swing_angles(r)
        margin = np.minimum(-raw[..., 1], np.pi + raw[..., 1])
    else:
        raw = euler_angles(r, sequence.lower())
        margin = np.pi / 2 - np.abs(raw[..., 1])
    order = [at for _, at, _ in joint.convention.angles]
    signs = np.array([sign for _, _, sign in joint.convention.angles])
    angles = raw[..., order] * signs
    return np.where(angles == -np.pi, np.pi, angles), margin


def _turn_of(axes: Array, *, left: bool) -> float:
    """Return the angle in rad from z to the flexion axis, seen along the limb, forward positive."""
    axis = axes[np.abs(axes[:, 2]).argmax()]
    axis = axis * np.sign(axis[2]) if axis[2] else axis
    forward = -axis[0] if left else axis[0]  # an axis is mirrored as −S a
    return float(np.arctan2(forward, axis[2]))
