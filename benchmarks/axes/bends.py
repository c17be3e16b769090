"""Section 6: axes of single bends of a knee, and how far apart their scatter puts two halves."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from benchmarks.axes.bars import number
from benchmarks.axes.generator import Array
from kinesphere.data import Motion, Parameters
from kinesphere.geometry.rotations import rotation_exp, rotation_log

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
    return scatter(bends(turns, np.rad2deg(whole.angles[:, j, 0])), motion.n_frames / 2)


def scatter(found: Sequence[tuple[int, bool, Array]], middle: float) -> dict[str, Any] | None:
    """Return scatter, hysteresis and trend of the axes of bends, deg.

    ``expected_deg`` is the rms angle between the mean axes of both halves that independent bends
    of this scatter lead to;
    ``without_first`` holds the same without the first bend and its return.
    """
    if len(found) < FEWEST:
        return None
    axes = np.rad2deg(np.array([axis for _, _, axis in found]))
    at = np.array([frame for frame, _, _ in found])
    bent = np.array([bending for _, bending, _ in found])
    early = at < middle
    if len(found) - 2 < FEWEST or min(early.sum(), (~early).sum(), bent.sum(), (~bent).sum()) < 2:
        return None
    row = _figures(axes, early) | {
        "n": len(found),
        "hysteresis_deg": float(np.linalg.norm(axes[bent].mean(axis=0) - axes[~bent].mean(axis=0))),
    }
    return row | {"without_first": _figures(axes[2:], early[2:])}


def _figures(axes: Array, early: Array) -> dict[str, float]:
    off = axes - axes.mean(axis=0)
    variance = float((off**2).sum() / (len(axes) - 1))
    count = early.sum(), (~early).sum()
    return {
        "scatter_deg": float(np.sqrt(variance)),
        "expected_deg": float(np.sqrt(variance * (1 / count[0] + 1 / count[1]))),
        "halves_deg": float(np.linalg.norm(axes[early].mean(axis=0) - axes[~early].mean(axis=0))),
    }


_BEFORE = """
What 1.5° between halves asks of a knee: the axis of every single bend and return, from {low:.0f} to
{high:.0f}°, scatters about the mean of them by the angle of the third column. Halves of so many
independent bends then differ by the *expected* angle (rms); beside it what the means of these very
bends do. *Hysteresis*: mean of the bends against mean of the returns. *Without the first*: the same
without the first bend and its return, in which the person lifts the thigh into place.

| knee | bends and returns | scatter, ° | expected, ° | halves, ° | hysteresis, ° | without the first: scatter, ° | expected, ° | halves, ° |
|---|---:|---:|---:|---:|---:|---:|---:|---:|"""  # noqa: E501
_AFTER = """
Bends are not told from returns, so there is no hysteresis to reckon with. Of an axis that is the
same in every bend two halves of such a scatter would still differ by the expected angle: by {all}
with all bends, by {rest} without the first one. Chance alone would meet 1.5° then, and the means of
the bends do ({means}). Where an axis misses it, it is by one bend, the first, in which
the thigh is being lifted: the estimator does not weigh it down.
"""


def page(rows: Mapping[str, Mapping[str, Any] | None]) -> str:
    """Return the table of knees, joint → `scatter`."""
    known = {joint: row for joint, row in rows.items() if row}
    if not known:
        return ""
    lines = [_BEFORE.format(low=LOW, high=HIGH)]
    for joint, row in known.items():
        rest = row["without_first"]
        figures = [row[k] for k in ("scatter_deg", "expected_deg", "halves_deg", "hysteresis_deg")]
        figures += [rest[k] for k in ("scatter_deg", "expected_deg", "halves_deg")]
        cells = [joint.replace("_", " "), str(row["n"]), *map(number, figures)]
        lines.append("| " + " | ".join(cells) + " |")
    told = {
        "all": [row["expected_deg"] for row in known.values()],
        "rest": [row["without_first"]["expected_deg"] for row in known.values()],
        "means": [row["without_first"]["halves_deg"] for row in known.values()],
    }
    spoken = {k: " and ".join(f"{degrees:.2f}°" for degrees in v) for k, v in told.items()}
    return "\n".join([*lines, _AFTER.format(**spoken)])
