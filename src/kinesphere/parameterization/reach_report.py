"""What a person is told about limbs that their axes cannot take where they were seen."""

from collections.abc import Mapping

from kinesphere.data import Json
from kinesphere.parameterization.joint_fit import JointFit

LARGE_SHARE = 0.25
"""Of the frames: a hinge whose limb is out of its reach more often than that is no plain hinge."""


def reach_warnings(
    fits: Mapping[str, JointFit], findings: Mapping[str, Json], degrees: float
) -> tuple[str, ...]:
    """Return the warnings that name limbs often out of the reach of one axis, or of the body's.

    Parameters
    ----------
    fits, findings
        By joint name; findings hold what `result_findings` returns.
    degrees
        How far off counts as out of reach.
    """
    own: list[str] = []
    body: list[str] = []
    for name, fit in fits.items():
        found = findings[name]
        share = found.get("unreachable") if isinstance(found, Mapping) else None
        if not isinstance(share, float) or share <= LARGE_SHARE:
            continue
        if fit.source == "body":
            body.append(f"{name} ({share:.0%} of the frames)")
        elif fit.source == "movement" and len(fit.axes) == 1:
            own.append(f"{name} ({share:.0%} of the frames)")
    warnings = []
    if own:
        warnings.append(
            f"one axis leaves the limb more than {degrees:g}° out of its reach, by skin, by a "
            f"movement it does not have or by an axis that is off: {', '.join(own)}"
        )
    if body:
        warnings.append(
            f"the body frame's axes leave the limb more than {degrees:g}° out of their reach, so "
            f"its poses are not rebuilt where they were seen: {', '.join(body)}"
        )
    return tuple(warnings)
