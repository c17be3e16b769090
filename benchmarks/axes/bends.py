"""Section 6: axes of single bends of a knee, and how far apart their scatter puts two halves."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from benchmarks.axes.bars import number
from benchmarks.axes.generator import Array
from benchmarks.axes.means import MEANS
from benchmarks.axes.measures import line_angles
from benchmarks.axes.repeatability import KEEP
from kinesphere.data import Motion, Parameters
from kinesphere.geometry.rotations import rotation_exp, rotation_log
from kinesphere.parameterization import parameterize

LOW, HIGH = 20.0, 90.0  # deg between which every bend is looked at, so that all turn equally far
FEWEST = 4


def bends(turns: Array, degrees: Array) -> list[tuple[int, bool, Array]]:
    """Return the axis of each passage between ``LOW`` and ``HIGH``.

    Parameters
    ----------
    turns : (n, 3, 3)
        ``parent_from_child``.
    degrees : (n,)
        The joint's angle; NaN is left out.

    Returns
    -------
    list of (frame, whether it bends, axis)
        The frame in its middle; the axis of the one rotation between both angles, (3,), in the
        parent, of the sign it has in bending.
    """
    known = np.flatnonzero(np.isfinite(degrees) & np.isfinite(turns).all(axis=(1, 2)))
    found: list[tuple[int, bool, Array]] = []
    last: tuple[bool, int] | None = None
    for i, k in enumerate(known):
        if LOW <= degrees[k] <= HIGH:
            continue
        bent = bool(degrees[k] > HIGH)
        if last is not None and bent != last[0]:
            passage = known[last[1] : i + 1]
            low, high = (_at(turns[passage], degrees[passage], angle) for angle in (LOW, HIGH))
            axis = rotation_log(high @ low.T)
            found.append((int(passage[len(passage) // 2]), bent, axis / np.linalg.norm(axis)))
        last = bent, i
    return found


def _at(turns: Array, degrees: Array, angle: float) -> Array:
    """Return the pose where a passage first reaches an angle, between two frames."""
    k = int(np.flatnonzero((degrees[:-1] - angle) * (degrees[1:] - angle) <= 0)[0])
    share = (angle - degrees[k]) / (degrees[k + 1] - degrees[k])
    return np.asarray(turns[k] @ rotation_exp(share * rotation_log(turns[k].T @ turns[k + 1])))


def bend_row(motion: Motion, whole: Parameters, joint: str) -> dict[str, Any] | None:
    """Return what single bends tell of a hinge, None where there are too few."""
    j = whole.skeleton.joint_names.index(joint)
    told = whole.skeleton.joints[j]
    if told.n_axes != 1:
        return None
    at = motion.skeleton.limb_names.index
    parent, child = (motion.rotations[:, at(limb)] for limb in (told.parent, told.child))
    turns = np.swapaxes(parent, -1, -2) @ child
    found = bends(turns, np.rad2deg(whole.angles[:, j, 0]))
    row = scatter(found, motion.n_frames / 2)
    if row is not None:
        row["delivered_deg"] = _delivered(motion, j, 0)
        row["without_first"]["delivered_deg"] = _delivered(
            motion, j, (found[1][0] + found[2][0]) // 2
        )
    return row


def _delivered(motion: Motion, j: int, first: int) -> float:
    """Return the angle in deg between a joint's axes from two halves, the first begun later."""
    middle = motion.times[-1] / 2
    windows = (motion.times[first], middle), (middle, motion.times[-1])
    halves = [parameterize(motion, KEEP, calibration=window).skeleton for window in windows]
    a, b = (np.asarray(half.joints[j].axes)[-1] for half in halves)
    return float(line_angles(a, b))


def scatter(found: Sequence[tuple[int, bool, Array]], middle: float) -> dict[str, Any] | None:
    """Return scatter, hysteresis and trend of the axes of bends, deg.

    ``expected_deg`` is the rms angle between the mean axes of both halves that independent bends
    of this scatter lead to, ``means_deg`` what means of both halves do differ by, under the names
    of `benchmarks.axes.means`; ``without_first`` holds the same without the first bend and its
    return.
    """
    if len(found) < FEWEST:
        return None
    axes = np.array([axis for _, _, axis in found])
    at = np.array([frame for frame, _, _ in found])
    bent = np.array([bending for _, bending, _ in found])
    early = at < middle
    if len(found) - 2 < FEWEST or min(early.sum(), (~early).sum(), bent.sum(), (~bent).sum()) < 2:
        return None
    row = _figures(axes, early) | {
        "n": len(found),
        "hysteresis_deg": _apart(axes[bent].mean(axis=0), axes[~bent].mean(axis=0)),
    }
    return row | {"without_first": _figures(axes[2:], early[2:])}


def _figures(axes: Array, early: Array) -> dict[str, Any]:
    off = np.rad2deg(axes - axes.mean(axis=0))
    variance = float((off**2).sum() / (len(axes) - 1))
    halves = early, ~early
    count = [half.sum() for half in halves]
    return {
        "scatter_deg": float(np.sqrt(variance)),
        "expected_deg": float(np.sqrt(variance * (1 / count[0] + 1 / count[1]))),
        "means_deg": {
            name: _apart(*(mean(axes[k]) for k in halves)) for name, mean in MEANS.items()
        },
    }


def _apart(a: Array, b: Array) -> float:
    return float(np.rad2deg(np.linalg.norm(a - b)))


_BEFORE = """
What 1.5° between halves asks of a knee: the axis of every single bend and return, from {low:.0f} to
{high:.0f}°, scatters about the mean of them. Halves of so many independent bends then differ by the
*expected* angle (rms). Beside it what halves do differ by: the axis as delivered, and means over
these very bends, two of which resist outliers (section 2c). *Without the first*: the first half
begins after the first bend and its return, in which the person lifts the thigh into place.

| knee | bends and returns | scatter, ° | expected, ° | as delivered, ° | {means} |
|---|---:|---:|---:|---:|{rules}|"""
_AFTER = """
Bends are not told from returns ({hysteresis} apart), so there is no hysteresis to reckon with.
Halves of one axis about which bends scatter like this differ by {expected} (rms) by chance alone.
It is not the first bend by which the right knee misses 1.5°. Without it and its return halves of
the axis as delivered differ by {without} instead of {whole}; means that resist outliers do not
see it as one ({resisting}). Only means over what is left of these bends by hindsight differ by less
({plain}).
"""


def page(rows: Mapping[str, Mapping[str, Any] | None]) -> str:
    """Return the table of knees, joint → `bend_row`."""
    known = {joint: row for joint, row in rows.items() if row}
    if not known:
        return ""
    heads = " | ".join(f"{name}, °" for name in MEANS)
    rules = "|".join(["---:"] * len(MEANS))
    lines = [_BEFORE.format(low=LOW, high=HIGH, means=heads, rules=rules)]
    for joint, row in known.items():
        for bent, told in (("", row), (", without the first", row["without_first"])):
            figures = [told[k] for k in ("scatter_deg", "expected_deg", "delivered_deg")]
            figures += [told["means_deg"][name] for name in MEANS]
            count = row["n"] - 2 * bool(bent)
            cells = [joint.replace("_", " ") + bent, str(count), *map(number, figures)]
            lines.append("| " + " | ".join(cells) + " |")
    right = known.get("right_knee")
    if right is not None:
        _, resisting, median = (right["means_deg"][name] for name in MEANS)
        rest = right["without_first"]
        left = rest["means_deg"]
        told = {
            "hysteresis": " and ".join(f"{row['hysteresis_deg']:.1f}°" for row in known.values()),
            "without": f"{rest['delivered_deg']:.2f}°",
            "whole": f"{right['delivered_deg']:.2f}°",
            "resisting": f"{resisting:.2f}° and {median:.2f}°",
            "plain": " to ".join(f"{f(left.values()):.2f}°" for f in (min, max)),
            "expected": " and ".join(f"{row['expected_deg']:.1f}°" for row in known.values()),
        }
        lines.append(_AFTER.format(**told))
    return "\n".join(lines)
