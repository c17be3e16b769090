"""Where a limb begins, ends and points, in its own frame: the paper's main orientation.

The paper reads it off "the neighbouring joints" (section 3) and leaves open what it is for a limb
with one joint or with more than two.
"""

import numpy as np

from kinesphere.data import Array, Limb
from kinesphere.normalization.vectors import unit

_TOO_SHORT = 1e-6  # m; a direction between points closer than this is rounding error
_ROW = 1.5  # times longer than wide from which points lie in a row
_HEEL = 0.07  # of a foot's length behind its ankle; heels are at .24 to .5, ankle markers at 0


def main_direction(limb: Limb, begin: Array, carried: Array, *, foot: bool) -> Array:
    """Return the unit vector along a limb, proximal to distal; NaN where nothing tells.

    From joint to joint; along the principal direction of the joints where the limb carries several.
    At the end of a chain from the joint to the middle of the markers, which is surer than any one
    of them; a foot points along the row of its joint and markers, from heel to toes; without
    markers the skeleton's long axis counts.

    Parameters
    ----------
    limb
    begin : (3,) m
        The joint towards the parent; NaN for a root, which begins amid its markers.
    carried : (n, 3) m
        The joints towards its children.
    foot
        True for a foot.
    """
    begin = begin if np.isfinite(begin).all() else middle_of_markers(limb)
    if len(carried) == 1:
        return unit(carried[0] - begin, _TOO_SHORT)
    if len(carried) > 1:
        return _principal(np.vstack([begin, carried]), carried.mean(axis=0) - begin)
    markers = _known(limb.marker_positions)
    if not len(markers):
        return unit(limb.long_axis)
    points, outward = np.vstack([begin, markers]), markers.mean(axis=0) - begin
    in_a_row = foot and _elongation(_known(points)) > _ROW
    around_joint = not np.linalg.norm(outward) > 1e-3 * np.ptp(points, axis=0).max()
    return _principal(points, outward) if in_a_row or around_joint else unit(outward, _TOO_SHORT)


def far_end(limb: Limb, begin: Array, along: Array) -> Array:
    """Return the end of a chain, (3,) m: as far out as the limb is long or its markers reach."""
    if np.isfinite(limb.length):
        return np.asarray(begin + limb.length * along)
    reach = (limb.marker_positions - begin) @ along
    farthest = np.max(reach[np.isfinite(reach)], initial=0.0)
    return np.asarray(begin + farthest * along)


def lacks_heel(limb: Limb, begin: Array, along: Array) -> bool:
    """Return whether a foot has markers, none of them behind its ankle.

    Then its line runs from the ankle down to the toes, and not as the sole lies.

    Parameters
    ----------
    limb
    begin : (3,) m
        The ankle; unknown, it tells nothing.
    along : (3,)
        Unit vector along the foot.
    """
    ahead = (_known(limb.marker_positions) - begin) @ along
    if not len(ahead) or not np.isfinite(ahead).all():
        return False
    return bool(ahead.min() > -_HEEL * ahead.max())


def middle_of_markers(limb: Limb) -> Array:
    """Return the mean of a limb's markers, (3,) m; NaN without any."""
    known = _known(limb.marker_positions)
    return known.mean(axis=0) if len(known) else np.full(3, np.nan)


def _known(points: Array) -> Array:
    return points[np.isfinite(points).all(axis=1)]


def _elongation(points: Array) -> float:
    """Return how many times longer than wide the points spread."""
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return float(spread[0] / max(spread[1], 1e-12)) if len(spread) > 1 else np.inf


def _principal(points: Array, outward: Array) -> Array:
    """Return the direction in which the points spread most, on the side of ``outward``."""
    points = _known(points)
    if len(points) < 2:
        return np.full(3, np.nan)
    _, spread, axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    if spread[0] < _TOO_SHORT:
        return np.full(3, np.nan)
    side = np.sign(axes[0] @ np.nan_to_num(outward))
    return np.asarray(axes[0] * (side or 1.0))
