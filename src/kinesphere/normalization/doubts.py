"""Is the best frame a default position at all? Reasons to doubt it, in words."""

from kinesphere.normalization.settings import NormalizationSettings

_TOLERATED = 2.0  # times the deviation that costs 1
_FLAT = 0.7  # times the plane distance that costs 1; who stands stays below half of that
LYING = 60.0
"""deg of tilt from which a trunk lies rather than leans."""
_UPSIDE_DOWN = 120.0  # deg
_BODIES = (0.01, 10.0)  # m, spans of which lengths are told in mm; others are in a wrong unit
_SLIM = 0.6  # short over long side of the rectangle around the joints of somebody who stands


def doubts(
    terms: dict[str, float], settings: NormalizationSettings, span: float
) -> tuple[str, ...]:
    """Return why a frame is no good default position; nothing where it is.

    Parameters
    ----------
    terms
        Name with unit → what was measured in that frame, as the costs report it.
    settings
    span
        Of the body, m.
    """
    arms = "hang" if settings.template == "standing" else "stretch out level"
    plane = settings.plane_distance * span * 1e3
    speed = settings.speed * span * 1e3
    reasons = []
    tilt = terms.get("trunk_tilt_deg", 0.0)
    if tilt > _UPSIDE_DOWN:
        reasons.append(f"the body is upside down (trunk {tilt:.0f} deg from upright)")
    elif tilt > LYING:
        reasons.append(f"the body lies (trunk {tilt:.0f} deg from upright)")
    elif tilt > _TOLERATED * settings.trunk_tilt:
        reasons.append(f"the trunk leans by {tilt:.0f} deg")
    if (angle := terms.get("arm_angle_deg", 0.0)) > _TOLERATED * settings.arm_angle:
        reasons.append(f"the arms do not {arms} (off by {angle:.0f} deg)")
    if (angle := terms.get("thigh_angle_deg", 0.0)) > _TOLERATED * settings.thigh_angle:
        reasons.append(f"a thigh is {angle:.0f} deg off the vertical, as when seated")
    if (angle := terms.get("knee_flexion_deg", 0.0)) > _TOLERATED * settings.knee_flexion:
        reasons.append(f"a knee is bent by {angle:.0f} deg")
    if (distance := terms.get("plane_distance_mm", 0.0)) > _FLAT * plane:
        reasons.append(f"the joints are {_length(distance, span)} off their plane")
    if (found := terms.get("speed_mm_per_s", 0.0)) > _TOLERATED * speed:
        reasons.append(f"the body moves at {_length(found, span)}/s")
    slim = settings.template == "standing" and tilt <= LYING
    if slim and (ratio := terms.get("rectangle_ratio", 0.0)) > _SLIM:
        reasons.append(f"the body is {ratio:.2f} times as wide as tall")
    return tuple(reasons)


def _length(millimetres: float, span: float) -> str:
    """Return a length for a person, in shares of the body where it is of no body's size."""
    low, high = _BODIES
    if low <= span <= high:
        return f"{millimetres:.0f} mm"
    return f"{millimetres / span * 1e-3:.2g} body spans"
