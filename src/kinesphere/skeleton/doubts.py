"""What is doubtful of a measured skeleton: limbs that are no bodies, centres nothing tells."""

from collections.abc import Container, Iterable, Mapping, Sequence

import numpy as np

from kinesphere.data import Array, Joint
from kinesphere.geometry.in_words import in_millimetres
from kinesphere.skeleton.landmarks import BETWEEN, STEADY
from kinesphere.skeleton.measured import MeasuredJoint

POOR = 0.03
"""m, rms residual from which on markers are no body: soft tissue leaves 22 mm at most."""
ELSEWHERE = {
    BETWEEN: "put midway between the markers of both limbs",
    STEADY: "put amid the markers that are steady in both limbs",
}
"""Where a centre is that no landmark of a model tells, by its source."""


def poor_fits(limbs: Sequence[str], residuals: Array, share: float) -> tuple[str, ...]:
    """Return the warning that names the limbs whose markers do not move as one body."""
    poor = []
    for limb, column in zip(limbs, residuals.T, strict=True):
        known = column[np.isfinite(column)]
        if len(known) and (rms := float(np.sqrt(np.mean(known**2)))) > POOR * share:
            poor.append(f"{limb} ({in_millimetres(rms)})")
    if not poor:
        return ()
    return (
        f"markers do not move as one body on {', '.join(poor)}: "
        "they may be mislabelled, swapped, or on another limb",
    )


def open_centres(
    joints: Iterable[Joint], measured: Mapping[str, MeasuredJoint], far: Container[str]
) -> tuple[str, ...]:
    """Return the warnings that name the joints whose centres the motion does not tell.

    Parameters
    ----------
    measured
        Child limb → its joint and where that was expected, as `expected_centre` says it.
    far
        Child limbs of joints that have a warning of their own.
    """
    places: dict[str, list[str]] = {}
    drawn: list[str] = []
    for joint in joints:
        if joint.observability != "undetermined" or joint.child in far:
            continue
        one = measured[joint.child]
        if one.drawn_away:
            drawn.append(f"{joint.name} ({in_millimetres(one.off)})")
        else:
            place = ELSEWHERE.get(one.source, "where the model's landmarks expect it")
            places.setdefault(place, []).append(joint.name)
    told = [
        f"the motion does not tell the centre of {', '.join(names)}; it is {place}"
        for place, names in places.items()
    ]
    if drawn:
        told.append(
            "the motion hardly tells these centres, yet draws them away from where they are "
            f"expected: {', '.join(drawn)}"
        )
    return tuple(told)
