"""Which frames show the default position (Sar Dessai et al. 2006, section 3): two costs."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.planes import fit_planes, smallest_rectangles
from kinesphere.normalization.anatomy import without_side
from kinesphere.normalization.samples import UP, Samples
from kinesphere.normalization.settings import NormalizationSettings
from kinesphere.normalization.vectors import angle_between

JOINTS_OF_A_PLANE = 4
"""Any three joints lie in a plane, whatever the body does."""

_FARTHEST = 90.0  # deg beyond which no angle costs more: upside down is as bad as lying
_FAST = 4.0  # most that speed may cost: whoever never stands still is judged by posture
_T_RATIO = 0.85  # height over arm span between the outermost joints of a T-pose (wrists, ankles)


@dataclass(frozen=True, eq=False)
class PositionCost:
    """How far each sampled frame is from the default position."""

    cost: Array
    """(n,) smoothed; infinite where too little is seen."""
    terms: dict[str, Array]
    """Name with unit → (n,) what the cost was made of, for people."""
    margin: float
    """Frames whose cost exceeds the best by no more than this are as good as the best."""
    absolute: bool
    """True where a cost of 0 is a perfect default position, whatever the other frames are like."""


def posture_cost(
    samples: Samples, settings: NormalizationSettings, angles: dict[str, Array] | None = None
) -> PositionCost:
    """Cost of a posture on named limbs: each term is 1 where it leaves its tolerance.

    ``(trunk tilt/15°)² + (largest arm angle/30°)² + (largest thigh angle/30°)² + (largest knee
    flexion/20°)² + (plane distance/.085 span)² + (speed/.11 spans a second)²``. A limb that the
    skeleton lacks has no term; one that a frame does not show counts 1. On free motion this finds
    standing frames where the paper's cost takes overhead and kicking poses.

    Parameters
    ----------
    samples, settings
    angles
        What `posture_angles` returns, where that is known already.
    """
    angles = posture_angles(samples, settings.template) if angles is None else angles
    scales = {
        "trunk_tilt_deg": settings.trunk_tilt,
        "arm_angle_deg": settings.arm_angle,
        "thigh_angle_deg": settings.thigh_angle,
        "knee_flexion_deg": settings.knee_flexion,
    }
    span = samples.anatomy.span
    plane = plane_distances(samples)
    speed = samples.speeds
    cost = np.zeros(len(samples.frames))
    for name, angle in angles.items():
        cost += _term(np.minimum(angle, _FARTHEST), scales[name])
    cost += _term(plane / span, settings.plane_distance)
    cost += np.minimum(_term(speed / span, settings.speed), _FAST)
    terms = {**angles, "plane_distance_mm": 1e3 * plane, "speed_mm_per_s": 1e3 * speed}
    return PositionCost(_smooth(cost, samples, settings), terms, settings.posture_margin, True)


def paper_cost(samples: Samples, settings: NormalizationSettings) -> PositionCost:
    """Cost of the joints alone, by the paper's three measures; weights and signs are ours.

    ``z(mean squared distance to the best plane) + z(short/long side of the smallest rectangle in
    that plane) − z(mean distance to the centre of gravity)``, where z subtracts the median and
    divides by the median absolute deviation over frames. Flat, slim and stretched out is good.
    For the T-pose the middle term is ``z(|log(height/span ratio) − log(that of a T-pose)|)``.
    Only frames in which the median joint is slower than half the tolerated speed count, if any.
    """
    joints, span = samples.joints, samples.anatomy.span
    centres, axes, variances = fit_planes(joints)
    flat = np.einsum("fjk,fki->fji", joints - centres[:, None], axes[:, :, :2])
    short, long = smallest_rectangles(flat)[:2]
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = short / long
        shape = np.abs(np.log(ratio / _T_RATIO)) if settings.template == "t-pose" else ratio
    seen = np.isfinite(joints).all(axis=2)
    away = np.linalg.norm(joints - centres[:, None], axis=2)
    reach = np.where(seen, away, 0.0).sum(axis=1) / np.maximum(seen.sum(axis=1), 1)
    speed = samples.speeds
    cost = _z_score(variances[:, 2]) + _z_score(shape) - _z_score(reach)
    slow = ~(speed > settings.speed * span / 2)  # an unknown speed is no reason against a frame
    if slow.any():
        cost = np.where(slow, cost, np.inf)
    cost = np.where(seen.sum(axis=1) >= JOINTS_OF_A_PLANE, cost, np.inf)
    terms = {
        "plane_distance_mm": 1e3 * np.sqrt(variances[:, 2]),
        "rectangle_ratio": ratio,
        "reach_mm": 1e3 * reach,
        "speed_mm_per_s": 1e3 * speed,
    }
    return PositionCost(_smooth(cost, samples, settings), terms, settings.paper_margin, False)


def posture_angles(samples: Samples, template: str) -> dict[str, Array]:
    """Return what the posture cost looks at, name → (n,) deg; only what the skeleton has.

    Limbs of a body that lies or stands on its head are measured against its own vertical: it may
    take the default position all the same.
    """
    limbs = samples.anatomy.limbs
    along = {
        name: samples.directions[:, i]
        for name, i in limbs.items()
        if np.isfinite(samples.anatomy.directions[i]).all()
    }
    down = -samples.vertical
    arms = [a for n, a in along.items() if without_side(n) in ("upper_arm", "forearm")]
    thighs = [a for n, a in along.items() if without_side(n) == "thigh"]
    knees = [
        (along[f"{side}thigh"], along[f"{side}shank"])
        for side in ("left_", "right_")
        if f"{side}thigh" in along and f"{side}shank" in along
    ]
    found: dict[str, Array] = {}
    if np.isfinite(samples.trunk_lines).any():
        found["trunk_tilt_deg"] = _angle(samples.trunk_lines, UP)
    if arms:
        to_down = np.stack([_angle(a, down) for a in arms])
        off = np.abs(to_down - 90) if template == "t-pose" else to_down
        found["arm_angle_deg"] = _largest(off)
    if thighs:
        found["thigh_angle_deg"] = _largest(np.stack([_angle(a, down) for a in thighs]))
    if knees:
        found["knee_flexion_deg"] = _largest(np.stack([_angle(a, b) for a, b in knees]))
    return found


def plane_distances(samples: Samples) -> Array:
    """Return the rms distance of the joints to their best plane, (n,) m; 0 below four joints."""
    if samples.joints.shape[1] < JOINTS_OF_A_PLANE:
        return np.zeros(len(samples.frames))
    distance: Array = np.sqrt(fit_planes(samples.joints)[2][:, 2])
    return distance


def _angle(a: Array, b: Array) -> Array:
    return np.asarray(np.rad2deg(angle_between(a, b)))


def _largest(angles: Array) -> Array:
    """Return the largest known value of each column, (k, n) → (n,); NaN where none is known."""
    largest = np.max(np.nan_to_num(angles, nan=-np.inf), axis=0)
    return np.asarray(np.where(np.isfinite(largest), largest, np.nan))


def _term(values: Array, scale: float) -> Array:
    if not np.isfinite(values).any():
        return np.zeros(len(values))
    return np.asarray(np.nan_to_num((values / scale) ** 2, nan=1.0))


def _z_score(values: Array) -> Array:
    known = values[np.isfinite(values)]
    if not len(known):
        return np.zeros(len(values))
    middle = np.median(known)
    deviation = np.median(np.abs(known - middle))
    if deviation < 1e-9 * max(abs(middle), 1e-300):  # nothing varies: nothing to choose by
        return np.zeros(len(values))
    return np.asarray((values - middle) / deviation)


def _smooth(cost: Array, samples: Samples, settings: NormalizationSettings) -> Array:
    """Average over the window; frames that cannot be used stay so and count for nobody."""
    half = int(settings.smoothing * samples.rate / 2 + 1e-9)
    usable = np.isfinite(cost)
    kernel = np.ones(2 * half + 1)
    n = len(cost)
    if half == 0 or n == 0:
        return np.where(usable, cost, np.inf)
    total = np.convolve(np.where(usable, cost, 0.0), kernel)[half : half + n]
    count = np.convolve(usable.astype(float), kernel)[half : half + n]
    return np.asarray(np.where(usable, total / np.maximum(count, 1.0), np.inf))
