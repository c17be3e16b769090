"""The room: cameras around it, and what each sees of it while nobody is there."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Camera

_WALLS = 4.2
"""m from the middle."""
_CEILING = 3.4
"""m."""


def cameras_around(
    rng: np.random.Generator,
    n_cameras: int = 4,
    *,
    width: int = 640,
    height: int = 480,
    distance: float = 3.2,
    aim: Sequence[float] = (0.0, 0.9, 0.0),
    view: float = 2.2,
) -> tuple[Camera, ...]:
    """Return cameras in a ring, none quite where a plan would have it.

    Parameters
    ----------
    distance
        m from the middle.
    aim
        (3,) m, what they look at.
    view
        m, how much of the upright they see there.
    """
    target = np.asarray(aim, dtype=np.float64)
    cameras = []
    for i in range(n_cameras):
        around = 2 * np.pi * (i + 0.5) / n_cameras + rng.uniform(-0.15, 0.15)
        away = distance * rng.uniform(0.92, 1.08)
        off = away * np.cos(around), rng.uniform(0.1, 0.9), away * np.sin(around)
        centre = target + off
        ahead = target - centre
        ahead /= np.linalg.norm(ahead)
        right = np.cross(ahead, [0.0, 1.0, 0.0])
        right /= np.linalg.norm(right)
        rotation = np.stack([right, np.cross(ahead, right), ahead])
        focal = height * away / view
        matrix = np.array(
            [
                [focal, 0, width / 2 + rng.uniform(-6, 6)],
                [0, focal, height / 2 + rng.uniform(-6, 6)],
                [0, 0, 1],
            ]
        )
        bends = np.array([rng.uniform(-0.08, -0.02), rng.uniform(0, 0.04), 0.0, 0.0, 0.0])
        cameras.append(
            Camera(f"cam{i + 1:02d}", width, height, matrix, bends, rotation, -rotation @ centre)
        )
    return tuple(cameras)


def empty_room(
    camera: Camera, rng: np.random.Generator, clutter: float
) -> tuple[Array, NDArray[np.bool_]]:
    """Return what a camera sees of the empty room, and which pixels are floor.

    Every camera must be given a generator of the same state: it is one room.

    Parameters
    ----------
    clutter
        0: even walls, like a laboratory; 1: posters, shelves and carpets in all colours.

    Returns
    -------
    picture : (height, width, 3), 0–255
    floor : (height, width)
    """
    grid = np.stack(np.meshgrid(np.arange(camera.width), np.arange(camera.height)), axis=-1)
    rays = camera.rays(grid.astype(np.float64))
    low = np.array([-_WALLS, 0.0, -_WALLS])
    high = np.array([_WALLS, _CEILING, _WALLS])
    with np.errstate(divide="ignore", invalid="ignore"):
        lengths = np.maximum((low - camera.centre) / rays, (high - camera.centre) / rays)
    axis = np.nanargmin(np.where(lengths > 0, lengths, np.inf), axis=-1)
    reach = np.take_along_axis(lengths, axis[..., None], axis=-1)
    points = camera.centre + reach * rays
    side = 2 * axis + (np.take_along_axis(rays, axis[..., None], -1)[..., 0] > 0)
    picture = np.zeros((camera.height, camera.width, 3))
    for wall in range(6):
        base = np.array([168.0, 170, 174]) if wall != 2 else np.array([132.0, 128, 124])
        base = base + rng.uniform(-6, 6, 3)
        patches = _patches(rng, 70) if wall != 2 else _patches(rng, 40)
        u, v = points[..., [k for k in range(3) if k != wall // 2]][side == wall].T
        shown = np.broadcast_to(base, (len(u), 3)) * (1 + 0.10 * (v / 4.0))[:, None]
        if clutter > 0 and len(u):
            shown = shown + clutter * (_carpet(u, v, rng.uniform(0, 9, 8))[:, None] * 45)
            for (left, bottom, wide, tall), colour, stripes in patches:
                inside = (abs(u - left) < wide) & (abs(v - bottom) < tall)
                wave = 1 + 0.4 * np.sign(np.sin(stripes * u[inside]) * np.sin(stripes * v[inside]))
                shown[inside] = (1 - clutter) * shown[inside] + clutter * colour * wave[:, None]
        picture[side == wall] = shown
    return np.clip(picture, 0, 255), side == 2


def _patches(
    rng: np.random.Generator, n: int
) -> list[tuple[tuple[float, float, float, float], Array, float]]:
    found = []
    for _ in range(n):
        left, bottom = rng.uniform(-_WALLS, _WALLS), rng.uniform(-_WALLS, _WALLS)
        wide, tall = rng.uniform(0.08, 0.5, 2)
        found.append(
            ((left, bottom, wide, tall), rng.uniform(25, 215, 3), rng.choice([0.0, 12.0, 25.0]))
        )
    return found


def _carpet(u: Array, v: Array, phases: Array) -> Array:
    """Return a pattern between −1 and 1 that repeats nowhere near."""
    waves = np.zeros_like(u)
    for k, scale in enumerate((2.3, 5.1, 11.7, 23.0)):
        turned = u * np.cos(1.3 * k) + v * np.sin(1.3 * k)
        across = v * np.cos(0.7 * k) - u * np.sin(0.7 * k)
        waves += np.sin(scale * turned + phases[2 * k]) * np.sin(scale * across + phases[2 * k + 1])
    return waves / 4
