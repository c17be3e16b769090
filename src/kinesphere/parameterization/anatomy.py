"""What the name of a joint says: how many axes, which way they point, which way is positive."""

from collections.abc import Mapping

import numpy as np

from kinesphere.data import Array, Joint, Skeleton

SIDED = ("upper_arm", "forearm", "hand", "thigh", "shank", "foot")
LIMBS = frozenset({"pelvis", "trunk", "head"}) | {
    f"{side}_{kind}" for side in ("left", "right") for kind in SIDED
}
"""Limbs of a person, as docs/conventions.md names them."""

MIRROR = np.diag([1.0, 1.0, -1.0])  # left ↔ right in the body frame

# Axes of the body frame (x anterior, y superior, z to the right) about which a left or middle joint
# moves, flexion first; positive is flexion (dorsiflexion, bending forward), then abduction
# (turning out, bending to the right). ISB: Wu et al. 2002, doi:10.1016/S0021-9290(01)00222-6, and
# 2005, doi:10.1016/j.jbiomech.2004.05.042.
BODY_AXES: Mapping[str, tuple[tuple[float, float, float], ...]] = {
    "lumbar": ((0, 0, -1), (1, 0, 0), (0, 1, 0)),
    "neck": ((0, 0, -1), (1, 0, 0), (0, 1, 0)),
    "shoulder": ((0, 0, 1), (1, 0, 0), (0, 1, 0)),
    "elbow": ((0, 0, 1), (1, 0, 0), (0, 1, 0)),
    "wrist": ((0, 0, 1), (1, 0, 0), (0, 1, 0)),
    "hip": ((0, 0, 1), (1, 0, 0), (0, 1, 0)),
    "knee": ((0, 0, -1), (1, 0, 0), (0, 1, 0)),
    "ankle": ((0, 0, 1), (0, 1, 0), (1, 0, 0)),
}
N_AXES: Mapping[str, int] = {
    "lumbar": 2,
    "neck": 2,
    "shoulder": 2,
    "elbow": 1,
    "wrist": 2,
    "hip": 2,
    "knee": 1,
    "ankle": 2,
}

ROOM: Mapping[str, float] = dict.fromkeys(
    ("knee", "elbow", "ankle", "hip", "shoulder", "neck"), 1.5
)
"""How many times as uncertain as elsewhere an axis may be where the body's is farther off: 16° rms
at knees, 8 to 37° at elbows, 19 to 41° at ankles of real people; 12, 12 and 9° at hips, shoulders
and necks of synthetic ones; but 1 to 9° at the lumbar joint."""
UNNAMED_ROOM = 1.5  # the parent's axes know nothing of a joint that nobody named

# Shares of thigh and shank together, 0.49 of the stature (Winter 2009, table 4.1), with room for
# children, dwarfism and joints found some centimetres off.
LEG_SHARES: Mapping[str, tuple[float, float]] = {
    "thigh": (0.3, 0.7),
    "shank": (0.3, 0.7),
    "upper_arm": (0.2, 0.6),
    "forearm": (0.15, 0.6),
}


def human_plan(skeleton: Skeleton) -> bool:
    """Return whether limbs have the names and about the proportions of a person's.

    Only then does anatomy say where an axis can be: four-legged bodies have a neck too.
    """
    if not set(skeleton.limb_names) <= LIMBS:
        return False
    lengths = {limb.name: limb.length for limb in skeleton.limbs}
    for side in ("left", "right"):
        leg = lengths.get(f"{side}_thigh", np.nan) + lengths.get(f"{side}_shank", np.nan)
        for kind, (low, high) in LEG_SHARES.items():
            share = lengths.get(f"{side}_{kind}", np.nan) / leg
            if share < low or share > high:  # NaN, a limb that is not there, is no objection
                return False
    return True


def without_side(name: str) -> str:
    """Return ``hip`` for ``left_hip``; other names as they are."""
    return name.removeprefix("left_").removeprefix("right_")


def joint_kind(name: str) -> str | None:
    """Return ``knee`` for ``left_knee``; None for a joint nobody named."""
    kind = without_side(name)
    return kind if kind in BODY_AXES else None


def body_axes(name: str) -> Array | None:
    """Return the body frame's axes for a joint, flexion first, (3, 3); None if nobody named it.

    A right axis is ``−S a`` of the left, so equal angles are mirrored poses.
    """
    kind = joint_kind(name)
    if kind is None:
        return None
    axes = np.array(BODY_AXES[kind])
    return -axes @ MIRROR if name.startswith("right_") else axes


def declared_n_axes(name: str, counts: Mapping[str, int]) -> int | None:
    """Return the number of axes the user or the joint's name asks for; None to find out."""
    kind = joint_kind(name)
    if name in counts:
        return counts[name]
    if kind is None:
        return None
    return counts.get(kind, N_AXES[kind])


def n_told(joint: Joint) -> int:
    """Return how many of the axes that move a joint's limb were told by a movement.

    A second axis that was added to a hinge does not count, nor what a limb turns about itself.
    """
    if joint.axes is None or joint.axes_source == "body":
        return 0
    told = joint.n_axes - sum(joint.axes_assumed)
    return min(told, wanted_n_axes(joint.name))


def wanted_n_axes(name: str) -> int:
    """Return how many axes move the limb of a joint of that name; two where nobody named it."""
    return N_AXES.get(without_side(name), 2)


def room(name: str) -> float:
    """Return how many times as uncertain as elsewhere an axis of a joint of that name may be."""
    kind = joint_kind(name)
    return UNNAMED_ROOM if kind is None else ROOM.get(kind, 1.0)


def named_axes(axes: Array, name: str) -> tuple[Array, list[int]]:
    """Return axes in anatomical order and sign: each matched to the body axis it is nearest to.

    Parameters
    ----------
    axes : (n_axes, 3)
        Any order, any sign.
    name
        Of the joint.

    Returns
    -------
    axes : (n_axes, 3)
        Flexion first; as they were for a joint nobody named.
    order
        Index of each in what was given.
    """
    body = body_axes(name)
    if body is None:
        return axes, list(range(len(axes)))
    cosines = axes @ body[: len(axes)].T
    pairs = sorted(matches(cosines))
    signed = [axes[i] if cosines[i, j] >= 0 else -axes[i] for j, i in pairs]
    return np.array(signed).reshape(-1, 3), [i for _, i in pairs]


def nominal_axes(name: str, axes: Array) -> Array | None:
    """Return the body axis each axis is matched to, (n_axes, 3); None if nobody named the joint."""
    body = body_axes(name)
    if body is None:
        return None
    return body[
        [j for j, _ in sorted(matches(axes @ body[: len(axes)].T), key=lambda pair: pair[1])]
    ]


def substitute_axes(name: str, n_axes: int, direction: Array) -> Array:
    """Return axes of the body frame for a joint whose movement does not tell them.

    Parameters
    ----------
    name
        Of the joint.
    n_axes
        How many are wanted.
    direction : (3,)
        Where the limb points on average; a joint nobody named gets the axes of the parent frame
        that are farthest from it, for a rotation about the limb is twist.

    Returns
    -------
    (n_axes, 3)
        Flexion first.
    """
    body = body_axes(name)
    if body is None:
        order = np.argsort(np.abs(direction), kind="stable")
        body = np.eye(3)[order]
    return body[:n_axes]


def matches(cosines: Array) -> list[tuple[int, int]]:
    """Return (column, row) pairs of (n, m) cosines, closest first, each row, column once."""
    free = np.abs(cosines)
    pairs: list[tuple[int, int]] = []
    for _ in range(min(free.shape)):
        i, j = (int(at) for at in np.unravel_index(int(free.argmax()), free.shape))
        pairs.append((j, i))
        free[i, :] = free[:, j] = -1
    return pairs
