"""Movement axes that need be neither orthogonal nor perpendicular to the limb."""

from typing import TypeAlias

import numpy as np

from kinesphere.data import Array
from kinesphere.synthetic.plan import MIRROR, LimbPlan, side_of, without_side

Range: TypeAlias = tuple[float, float]

_TURN_DEG = 12.0  # an axis' largest turn about the limb from where anatomy would have it
_SIDES_DEG = 2.0  # standard deviation between the two sides of one person


def draw_axes(
    rng: np.random.Generator,
    limb: LimbPlan,
    direction: Array,
    *,
    parent_from_body: Array,
    axes_deg: Range,
    cone_deg: Range,
    traits: dict[str, Array],
) -> Array:
    """Draw the axes of a limb's joint, (n_axes, 3) in the parent frame, distal first.

    An axis is given by its angle to the limb at rest and its turn about the limb; the turn of the
    second follows from the angle between the two by the spherical law of cosines. Right sides
    mirror left ones, each trait a little off.

    Parameters
    ----------
    limb
        Its movements name the nominal axes.
    direction : (3,)
        The limb at rest, in the parent frame.
    parent_from_body : (3, 3)
        In the default position.
    axes_deg, cone_deg
        Allowed angles in deg between two axes, and between an axis and the limb.
    traits
        What was drawn so far, joint → values; the first side of a joint is added.
    """
    kind, right = without_side(limb.joint), side_of(limb.joint) == "right"
    low = np.array([axes_deg[0], cone_deg[0], cone_deg[0], -_TURN_DEG])
    high = np.array([axes_deg[1], cone_deg[1], cone_deg[1], _TURN_DEG])
    if kind in traits:
        drawn = np.clip(traits[kind] + _SIDES_DEG * rng.normal(size=4), low, high)
    else:
        drawn = traits[kind] = rng.uniform(low, high)
    between, cone_proximal, cone_distal, turn = np.deg2rad(drawn)
    nominal = np.array([movement.about for movement in limb.movements]) @ parent_from_body.T
    if right:  # place the axes as if the limb were a left one, then mirror them
        direction, nominal = MIRROR @ direction, -nominal @ MIRROR
    u = nominal[-1] - (nominal[-1] @ direction) * direction
    u /= np.linalg.norm(u)
    v = np.cross(direction, u)

    def axis(cone: float, turned: float) -> Array:
        across = np.cos(turned) * u + np.sin(turned) * v
        return np.asarray(np.cos(cone) * direction + np.sin(cone) * across)

    axes = [axis(cone_proximal, turn)]
    if len(nominal) == 2:
        cosine = np.cos(between) - np.cos(cone_proximal) * np.cos(cone_distal)
        apart = np.arccos(cosine / (np.sin(cone_proximal) * np.sin(cone_distal)))
        axes.insert(0, axis(cone_distal, turn + np.sign(nominal[0] @ v) * apart))
    placed = np.array(axes)
    return -placed @ MIRROR if right else placed
