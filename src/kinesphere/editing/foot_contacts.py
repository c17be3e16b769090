"""When heels and balls of the feet stand on something: slow, and as low as they ever are."""

from typing import NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter1d

from kinesphere.data import Array, Mask, Skeleton
from kinesphere.data.figure import SIDES
from kinesphere.editing.retarget_rest import RestPose
from kinesphere.editing.retarget_settings import RetargetSettings
from kinesphere.geometry.vectors import lengths

HEEL, BALL = 0, 1
HEEL_BACK = 0.3
"""Share of the way from ankle to ball that the heel lies behind the ankle (a foot's proportions:
Winter 2009, Biomechanics and Motor Control of Human Movement, table 4.1 and figure 4.1)."""
BALL_ALONG = 0.75
"""Share of the way from ankle to the foot's end at which the ball lies where no toes tell it."""
ANKLE_HEIGHT = 0.09
"""Height of the ankle by the length of hip to ankle, where nothing tells (ibid.)."""
FOOT = 0.2
"""m from ankle to ball by m from hip to ankle, where nothing tells (ibid.)."""
_LEG = 0.85
"""m from hip to ankle, of the person that speeds are given for."""
_SMOOTH = 0.02
"""s, the Gaussian that places are smoothed by before speeds are taken."""
_LOWEST = 5.0
"""Percent of frames that may be lower than the lowest level."""


class Ground(NamedTuple):
    """Where the floor is, and how high above it the ankle stands."""

    floor: float
    """m, world y."""
    ankle: float
    """m."""
    warnings: tuple[str, ...]


def find_ground(ankles: Array, leg: float) -> Ground:
    """Return the floor: world y = 0, unless ankles say otherwise.

    Parameters
    ----------
    ankles : (n_frames, n_feet, 3) m
    leg
        m from hip to ankle.
    """
    level = float(np.percentile(ankles[..., 1], _LOWEST))
    if 0.02 <= level / leg <= 0.25:
        return Ground(0.0, level, ())
    height = ANKLE_HEIGHT * leg
    return Ground(
        level - height,
        height,
        (
            f"the ankles' lowest level is {level:.2f} m: the floor is taken as "
            f"{level - height:.2f} m high, not 0",
        ),
    )


def soles(
    rest: RestPose,
    skeleton: Skeleton,
    rotations: Array,
    places: Array,
    ankle: float,
    otherwise: float,
) -> Array:
    """Return heels and balls of both feet over time, (n_frames, 2, 2, 3) m.

    Parameters
    ----------
    rest
        Whose figure has two feet.
    rotations : (n_frames, n_limbs, 3, 3)
        ``world_from_limb``.
    places : (n_frames, n_limbs, 3) m
        Where limbs hang.
    ankle
        m, how high it stands above the sole.
    otherwise
        m from ankle to ball, where the foot itself does not tell.
    """
    found = []
    for side in SIDES:
        foot = rest.figure.parts[f"{side}_foot"]
        turn = rotations[:, foot, None] @ rest.rest_from_body
        sole = _sole_at_rest(rest, side, ankle, foot_length(rest, skeleton, side) or otherwise)
        found.append(places[:, foot, None] + (turn @ sole[..., None])[..., 0])
    return np.stack(found, axis=1)


def _sole_at_rest(rest: RestPose, side: str, ankle: float, length: float) -> Array:
    """Return heel and ball from the ankle, body axes, (2, 3) m."""
    way = rest.directions.get(f"{side}_foot", np.array([1.0, 0.0, 0.0])) * [1.0, 0.0, 1.0]
    size = float(np.linalg.norm(way))
    forward = way / size if size > 1e-6 else np.array([1.0, 0.0, 0.0])
    down = np.array([0.0, -ankle, 0.0])
    return np.stack([down - HEEL_BACK * length * forward, down + length * forward])


def foot_length(rest: RestPose, skeleton: Skeleton, side: str) -> float:
    """Return how far in front of the ankle the ball is at rest, m; 0 where nothing tells."""
    parts = rest.figure.parts
    foot = parts[f"{side}_foot"]
    if f"{side}_toes" in parts:
        way = rest.places[parts[f"{side}_toes"]] - rest.places[foot]
    else:
        length = skeleton.limbs[foot].length
        way = BALL_ALONG * (length if length > 0 else 0.0) * skeleton.limbs[foot].long_axis
        if length > 0 and abs((rest.rest_from_body.T @ way)[1]) > 0.9 * float(np.linalg.norm(way)):
            return 0.0  # it ends below the ankle
    return float(np.linalg.norm((rest.rest_from_body.T @ way)[[0, 2]]))


def find_contacts(points: Array, rate: float, leg: float, settings: RetargetSettings) -> Mask:
    """Return when heel and ball of each foot stand, (n_frames, n_feet, 2).

    Parameters
    ----------
    points : (n_frames, n_feet, 2, 3) m
        Heels and balls, without gaps.
    leg
        m from hip to ankle.
    """
    n = len(points)
    if n < 2:
        return np.zeros(points.shape[:3], dtype=np.bool_)
    smooth = gaussian_filter1d(points, max(_SMOOTH * rate, 1e-6), axis=0, mode="nearest")
    speeds = lengths(np.gradient(smooth, axis=0)) * rate
    low = points[..., 1] - np.percentile(points[..., 1], _LOWEST, axis=0)
    standing = (speeds < settings.contact_speed * leg / _LEG) & (
        low < settings.contact_height / 1e3 * leg / _LEG
    )
    shortest = max(1, round(settings.shortest_contact * rate))
    for foot in range(len(SIDES)):
        for point in (HEEL, BALL):
            column = standing[:, foot, point]
            _flip_short(column, shortest, False)
            _flip_short(column, shortest, True)
    return standing


def runs(mask: Mask) -> list[tuple[int, int]]:
    """Return (first, last + 1) of every run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(np.int8)))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]


def _flip_short(column: Mask, shortest: int, value: bool) -> None:
    """Turn runs of ``value`` that are too short into the other, but for those at the ends."""
    for first, end in runs(column == value):
        inner = first > 0 and end < len(column)
        if end - first < shortest and (inner or value):
            column[first:end] = not value
