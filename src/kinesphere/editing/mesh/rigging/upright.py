"""Which ways a person's surface may stand and look: told by its mirror plane, or stated."""

import numpy as np
from scipy.spatial import KDTree

from kinesphere.data import Array
from kinesphere.errors import BadSurface

_ROUNDS = 8
_SNAP = np.cos(np.radians(12.0))
"""Files are modelled along their axes; a mirror plane is found to a few degrees."""
_TURN = 0.08  # of the size, that a quarter turn of the normals counts as


def ways_to_stand(points: Array, normals: Array, up: str, facing: str) -> list[Array]:
    """Return rotations ``body_from_mesh`` that may be right, each (3, 3).

    A body mirrors itself left to right, and is far taller than deep. That leaves which end is up
    and which side is the front: four ways, fewer where they are stated. What lies within a few
    degrees of the axes of the file lies along them.

    Parameters
    ----------
    points, normals : (n, 3)
        Samples of the surface; as large as a person, about.
    up, facing
        ``"auto"`` or an axis of the mesh: ``"+y"``, ``"-x"``…

    Raises
    ------
    BadSurface
        If both are stated along one line.
    """
    if (said := ways_as_said(up, facing)) is not None:
        return [said]
    said_up, said_front = axis_named(up), axis_named(facing)
    across = _mirror_normal(points, normals)
    off = points - points.mean(axis=0)
    off = off - np.outer(off @ across, across)
    tall = np.linalg.eigh(off.T @ off)[1][:, -1]
    across, tall = snapped(across, tall)
    found = []
    for sign in (1.0, -1.0):
        for side in (1.0, -1.0):
            way = sign * tall
            front = side * np.cross(way, across)
            if said_up is not None and abs(said_up @ way) < _SNAP:
                continue
            if said_front is not None and abs(said_front @ front) < _SNAP:
                continue
            if (said_up is None or said_up @ way > 0) and (
                said_front is None or said_front @ front > 0
            ):
                found.append(body_axes(front, way))
    if found:
        return found
    stated = said_up if said_up is not None else said_front
    assert stated is not None
    others = [s * np.roll(np.abs(stated), k) for k in (1, 2) for s in (1.0, -1.0)]
    if said_up is not None:
        return [body_axes(other, said_up) for other in others]
    return [body_axes(stated, other) for other in others]


def ways_as_said(up: str, facing: str) -> Array | None:
    """Return ``body_from_mesh`` where both axes are stated; None where one is not."""
    tall, front = axis_named(up), axis_named(facing)
    if tall is None or front is None:
        return None
    if abs(tall @ front) > 0.5:
        raise BadSurface(f"surface.up is {up} and surface.facing {facing}: they must be square")
    return body_axes(front, tall)


def axis_named(name: str) -> Array | None:
    """Return the axis that ``"+y"`` names, None for ``"auto"``."""
    if name == "auto":
        return None
    return np.asarray(np.eye(3)["xyz".index(name[1])] * (-1.0 if name[0] == "-" else 1.0))


def name_of_axis(direction: Array) -> str:
    """Return ``"+y"`` or the like; two where a direction lies between them."""
    k = int(np.abs(direction).argmax())
    name = ("-" if direction[k] < 0 else "+") + "xyz"[k]
    off = np.degrees(np.arccos(np.clip(abs(direction[k]), -1.0, 1.0)))
    return name if off < 1.0 else f"{off:.0f}° off {name}"


def body_axes(front: Array, up: Array) -> Array:
    """Return rows x (front), y (up), z (right)."""
    return np.stack([front, up, np.cross(front, up)])


def _mirror_normal(points: Array, normals: Array) -> Array:
    """Return the normal of the plane that the points mirror themselves in best, (3,)."""
    centre = points.mean(axis=0)
    own = np.linalg.eigh((points - centre).T @ (points - centre))[1].T
    size = np.sqrt(((points - centre) ** 2).sum(axis=1).mean())
    tree = KDTree(np.hstack([points, _TURN * size * normals]))
    best, least = own[0], np.inf
    for start in (*own, *np.eye(3)):
        normal, middle = start, centre
        for _ in range(_ROUNDS):
            mirrored = points - 2 * np.outer((points - middle) @ normal, normal)
            turned = normals - 2 * np.outer(normals @ normal, normal)
            apart, near = tree.query(np.hstack([mirrored, _TURN * size * turned]))
            score = float(np.minimum(apart, 0.1 * size).mean())
            if score < least:
                best, least = normal, score
            twin = points[near]
            close = apart <= np.quantile(apart, 0.8)
            middle = (points[close] + twin[close]).mean(axis=0) / 2
            both = (points[close] - middle).T @ (twin[close] - middle)
            normal = np.linalg.eigh(both + both.T)[1][:, 0]
    return np.asarray(best)


def snapped(across: Array, tall: Array) -> tuple[Array, Array]:
    """Return both directions along axes of the file, where they nearly are."""
    a, t = int(np.abs(across).argmax()), int(np.abs(tall).argmax())
    if a == t or abs(across[a]) < _SNAP or abs(tall[t]) < _SNAP:
        if abs(tall[t]) >= _SNAP:  # turned about the vertical alone
            tall = np.sign(tall[t]) * np.eye(3)[t]
            across = across - (across @ tall) * tall
            across = across / np.linalg.norm(across)
        return across, tall
    return np.sign(across[a]) * np.eye(3)[a], np.sign(tall[t]) * np.eye(3)[t]
