"""Where to begin with a limb whose turn about its own line only the limbs beyond it tell."""

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.algebraic_centres import sphere_centre
from kinesphere.geometry.linkage import Linkage
from kinesphere.geometry.rigid import into_frame
from kinesphere.geometry.rotations import mean_rotation
from kinesphere.geometry.vectors import is_seen, lengths
from kinesphere.skeleton.averages import mean_seen, median_seen
from kinesphere.skeleton.body_axes import unit


def turned_from_beyond(start: Linkage, points: Array) -> Linkage | None:
    """Return a linkage whose second limb turns about its line as the joints beyond it do.

    A joint beyond keeps its distance from all that is on the limb, however that turns about its
    own line: seen from the limb beyond, these points move on spheres about it. So it is found
    without the turn, and tells it: limb and joint are a triangle then. The nearest point serves,
    which errors of the pose beyond move least.

    Parameters
    ----------
    start
        With poses of every limb but for the turn.
    points : (n_frames, n_markers, 3) m
        Markers in the world, body by body; NaN where not seen.

    Returns
    -------
    None where too little of it is ever seen together.
    """
    ends = np.cumsum([len(shape) for shape in start.shapes])
    clouds = np.split(points, ends[:-1], axis=1)
    on = np.concatenate([start.origins[:, 1, None], clouds[1]], axis=1)
    shapes, beyond = list(start.shapes), []
    for body in range(2, len(start.parents)):
        turns = start.rotations[:, body]
        placed = clouds[body] - shapes[body] @ np.swapaxes(turns, 1, 2)
        shift = mean_seen(placed, axis=1)
        local = into_frame(turns, shift, on)
        away = lengths(local - shapes[body].mean(axis=0))
        nearest = int(np.nan_to_num(median_seen(away), nan=np.inf).argmin())
        centre = sphere_centre(local[:, [nearest]], np.zeros(3))
        shapes[body] = shapes[body] - centre
        beyond.append(shift + turns @ centre)
    first, last = _farthest(start.shapes[1])
    line = unit(clouds[1][:, last] - clouds[1][:, first])
    middle = (clouds[1][:, last] + clouds[1][:, first]) / 2
    across = [_across(joint - middle, line) for joint in beyond]
    off = median_seen(lengths(np.stack(across, axis=1)))
    side = unit(across[int(np.nan_to_num(off, nan=-1.0).argmax())])
    frames = np.stack([line, side, np.cross(line, side)], axis=2)
    known = is_seen(frames).all(axis=1)
    if not known.any():
        return None
    frames[known] = frames[known] @ mean_rotation(
        np.swapaxes(frames[known], 1, 2) @ start.rotations[known, 1]
    )
    rotations = start.rotations.copy()
    rotations[known, 1] = frames[known]
    local = into_frame(frames, middle, np.concatenate([on, np.stack(beyond, axis=1)], axis=1))
    usual = median_seen(local)
    if not np.isfinite(usual).all():
        return None
    usual = usual - usual[0]
    shapes[1], centres = usual[1 : 1 + len(shapes[1])], start.centres.copy()
    centres[2:] = usual[1 + len(shapes[1]) :]
    return start._replace(shapes=tuple(shapes), centres=centres, rotations=rotations)


def _farthest(shape: Array) -> tuple[int, int]:
    away = lengths(shape[:, None] - shape[None])
    first, last = np.unravel_index(away.argmax(), away.shape)
    return int(first), int(last)


def _across(vectors: Array, line: Array) -> Array:
    off: Array = vectors - np.sum(vectors * line, axis=1, keepdims=True) * line
    return off
