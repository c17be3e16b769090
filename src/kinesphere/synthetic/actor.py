"""An actor: one body drawn from a plan, with its own sizes, axes and rest orientations."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array, Joint, Limb, Skeleton
from kinesphere.errors import BadSetting
from kinesphere.geometry.rotations import rotation_between
from kinesphere.synthetic.axes import Range, draw_axes
from kinesphere.synthetic.bodies import HUMAN
from kinesphere.synthetic.plan import BodyPlan, LimbPlan, without_side

_SHARE_DEVIATION = 0.03  # of a limb's share of the size between people (Winter 2009, table 4.1)
_SIDE_DEVIATION = 0.005  # of a limb's length between left and right of one person
_STANCE_DEVIATION = np.deg2rad(2.0)  # of a limb's direction in the default position
_SIZE_LIMIT = 2.0  # standard deviations: no giants


@dataclass(frozen=True, eq=False)
class Actor:
    """A body without markers, in normalized frames."""

    plan: BodyPlan
    size: float
    """m; stature of a person."""
    skeleton: Skeleton
    """Axes and rest orientations included; limbs own no markers yet."""
    body_from_limb: Array
    """(n_limbs, 3, 3) limb frames in the default position, which is where all angles are zero."""
    limits: Array
    """(n_joints, 4, 2) rad, low and high of angle 1, 2, 3 and twist; NaN where there is no axis."""


def make_actor(
    rng: np.random.Generator,
    *,
    plan: BodyPlan = HUMAN,
    axes_deg: Range = (70.0, 110.0),
    cone_deg: Range = (80.0, 100.0),
) -> Actor:
    """Draw an actor.

    Parameters
    ----------
    rng
        Everything random comes from it.
    plan
        The kind of body.
    axes_deg
        Least and largest angle in deg between the two axes of a joint.
    cone_deg
        Least and largest angle in deg between a limb at rest and an axis it turns about; at 90 the
        limb sweeps a great circle, elsewhere a cone.

    Raises
    ------
    BadSetting
        If a range is empty or leaves 60–120 deg, where two axes and a limb always fit together.
    """
    for name, (low, high) in (("axes_deg", axes_deg), ("cone_deg", cone_deg)):
        if not 60 <= low <= high <= 120:
            raise BadSetting(f"{name} is {low}–{high}; it must be a range within 60–120 deg")
    mean, deviation = plan.size
    size = mean + deviation * float(np.clip(rng.normal(), -_SIZE_LIMIT, _SIZE_LIMIT))
    lengths = _draw_lengths(rng, plan, size)
    body_from_limb = _draw_stance(rng, plan)
    at = {limb.name: i for i, limb in enumerate(plan.limbs)}
    limbs = tuple(_limb(limb, length) for limb, length in zip(plan.limbs, lengths, strict=True))
    traits: dict[str, Array] = {}
    joints = []
    for i, limb in enumerate(plan.limbs[1:], start=1):
        parent = at[str(limb.parent)]
        rest = body_from_limb[parent].T @ body_from_limb[i]
        start = -limbs[parent].length / 2 * limbs[parent].long_axis
        if limb.at is None:
            centre = -start
        else:  # scaled like the parent, so that wide hips go with a long trunk
            centre = start + np.array(limb.at) * lengths[parent] / plan.limbs[parent].length
        axes = draw_axes(
            rng,
            limb,
            rest @ limbs[i].long_axis,
            parent_from_body=body_from_limb[parent].T,
            axes_deg=axes_deg,
            cone_deg=cone_deg,
            traits=traits,
        )
        joints.append(
            Joint(
                name=limb.joint,
                parent=str(limb.parent),
                child=limb.name,
                centre_in_parent=centre,
                centre_in_child=-limbs[i].length / 2 * limbs[i].long_axis,
                residual=0.0,
                range_of_motion=np.nan,
                covariance=np.zeros((3, 3)),
                observability="given",
                axes=axes,
                rest=rest,
                axes_source="given",
                axes_uncertainty=np.zeros(len(axes)),
            )
        )
    return Actor(plan, size, Skeleton(limbs, tuple(joints)), body_from_limb, _limits(plan))


def _draw_lengths(rng: np.random.Generator, plan: BodyPlan, size: float) -> list[float]:
    shares: dict[str, float] = {}
    lengths = []
    for limb in plan.limbs:
        kind = without_side(limb.name)
        if kind not in shares:
            shares[kind] = 1 + _SHARE_DEVIATION * float(np.clip(rng.normal(), -2, 2))
        side = 1 + _SIDE_DEVIATION * float(np.clip(rng.normal(), -2, 2))
        lengths.append(size * limb.length * shares[kind] * side)
    return lengths


def _draw_stance(rng: np.random.Generator, plan: BodyPlan) -> Array:
    """Draw where limbs point by default; frames by the least rotation (docs/conventions.md)."""
    frames = np.empty((len(plan.limbs), 3, 3))
    frames[0] = np.eye(3)
    for i, limb in enumerate(plan.limbs[1:], start=1):
        canonical = np.array(limb.canonical)
        points = np.array(limb.canonical if limb.stands is None else limb.stands)
        points = points + _STANCE_DEVIATION * np.clip(rng.normal(size=3), -2, 2)
        frames[i] = rotation_between(canonical, points / np.linalg.norm(points))
    return frames


def _limb(limb: LimbPlan, length: float) -> Limb:
    return Limb(
        name=limb.name,
        parent=limb.parent,
        markers=(),
        marker_positions=np.empty((0, 3)),
        length=length,
        long_axis=np.array(limb.canonical),
    )


def _limits(plan: BodyPlan) -> Array:
    limits = np.full((len(plan.limbs) - 1, 4, 2), np.nan)
    for j, limb in enumerate(plan.limbs[1:]):
        for k, movement in enumerate(limb.movements):
            limits[j, k] = np.deg2rad([movement.low, movement.high])
        limits[j, 3] = np.deg2rad(limb.twist)
    return limits
