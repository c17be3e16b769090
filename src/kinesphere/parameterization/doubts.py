"""Why axes may not be those of main movements."""

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.confidence import AxesQuality
from kinesphere.parameterization.settings import AxesSettings

WORTH_TELLING = 1.0  # deg


def reasons_to_doubt(
    quality: AxesQuality, axes: Array, nominal: Array | None, positions: Array, s: AxesSettings
) -> list[str]:
    """Return why these are not the axes of main movements, each a clause; or nothing.

    Parameters
    ----------
    quality
        Of ``axes``.
    axes : (n_axes, 3)
    nominal : (n_axes, 3), optional
        Where anatomy has the axes, in the same order.
    positions : (n, 3)
        All of the calibration, at rest and moving.
    s
        The limits.
    """
    doubts: list[str] = []
    if (small := np.rad2deg(quality.ranges.min())) < s.smallest_range:
        doubts.append(
            f"the range of motion about an axis is {small:.0f}°, {s.smallest_range:.0f}° are needed"
        )
    if not np.isfinite(quality.halves).all():
        doubts.append("there is too little movement to compare two halves of it")
    elif np.rad2deg(quality.halves.max()) > 2 * s.largest_uncertainty:
        doubts.append(apart(quality.halves, quality.ranges))
    elif np.rad2deg(quality.uncertainty.max()) > s.largest_uncertainty:
        doubts.append(uncertain(quality))
    if len(axes) > 1 and quality.explained < s.smallest_explained:
        doubts.append(
            f"rotation about one axis at a time explains only {quality.explained:.0%} "
            "of the movement"
        )
    purity = float((quality.conditioning**2 / (1 + quality.conditioning**2)).min())
    if len(axes) > 1 and s.smallest_explained > 0 and not doubts and purity < s.purest:
        doubts.append(
            f"only {purity:.0%} of the movement about an axis is about it: the limb circles"
        )
    if len(axes) == 1:
        heights = np.arccos(np.clip(positions @ axes[0], -1, 1))
        spread = float(np.rad2deg(np.sqrt(((heights - np.median(heights)) ** 2).mean())))
        if spread > s.largest_spread:
            doubts.append(f"the limb leaves the cone about its only axis by {spread:.0f}° rms")
        elif (arc := np.rad2deg(quality.ranges.min())) * np.deg2rad(s.largest_uncertainty) < spread:
            # as far as it leaves the cone over the arc it moves, its axis may be turned
            doubts.append(
                f"the limb leaves the cone about its only axis by {spread:.1f}° rms, too much for "
                f"the {arc:.0f}° that it moves about it to tell the axis"
            )
    if nominal is not None:
        off = np.arccos(np.clip(np.abs((axes * nominal).sum(axis=1)), 0, 1))
        if (farthest := np.rad2deg(off.max())) > s.farthest:
            doubts.append(f"an axis is {farthest:.0f}° from where this joint can have one")
    for i in range(1, len(axes)):
        for j in range(i):
            angle = np.rad2deg(np.arccos(min(1.0, abs(float(axes[i] @ axes[j])))))
            if angle < s.smallest_angle:
                doubts.append(f"two axes are {angle:.0f}° apart, too close to be two")
    return doubts


def apart(halves: Array, ranges: Array) -> str:
    """Return how far axes from two halves differ, (n_axes,) rad, as a clause.

    Of several the arc that it covers, (n_axes,) rad, says which one it is, whatever its number.
    """
    worst = int(halves.argmax())
    told = f"axes from two halves of the data differ by {np.rad2deg(halves[worst]):.0f}°"
    which = f" about the one whose movement covers {np.rad2deg(ranges[worst]):.0f}°"
    return told + which if len(halves) > 1 else told


def uncertain(quality: AxesQuality, which: int | None = None) -> str:
    """Return how uncertain an axis, or the least certain, is, and what makes it so, as a clause."""
    worst = int(quality.uncertainty.argmax()) if which is None else which
    degrees = np.rad2deg([quality.uncertainty[worst], quality.ranges[worst], quality.halves[worst]])
    told = (
        "an axis is uncertain by {:.1f}°: its movement covers {:.0f}°, and two halves of it differ "
        "by {:.0f}°"
    ).format(*degrees)
    return told + _if_it_twists(quality.readings[worst]) + _if_coupled(quality.coupled[worst])


def uncertain_in_free_motion(uncertainty: float, reading: float, coupled: float) -> str:
    """Return how uncertain the axis of a hinge from all its movement is, rad, as a clause."""
    told = f"the axis of all movement is uncertain by {np.rad2deg(uncertainty):.1f}°"
    return told + _if_it_twists(reading) + _if_coupled(coupled)


def _if_it_twists(reading: float) -> str:
    """Return how far such twist puts an axis off, rad, to be put behind a clause."""
    off = np.rad2deg(reading)
    told = f"; if the limb twists with the angle, it is {off:.0f}° off"
    return told if off >= WORTH_TELLING else ""


def _if_coupled(off: float) -> str:
    """Return how far movement about other axes puts one off, rad, to be put behind a clause."""
    degrees = np.rad2deg(off)
    told = f"; movement about another that goes with it can put it {degrees:.0f}° off"
    return told if degrees >= WORTH_TELLING else ""
