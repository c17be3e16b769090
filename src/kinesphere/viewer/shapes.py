"""The shapes that the scene repeats, of unit size: a bone, an arrow, a ball, a ring."""

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array

Mesh: TypeAlias = tuple[Array, NDArray[np.uint32]]
"""Vertices (n, 3) and faces (m, 3), anticlockwise from outside."""


def bone() -> Mesh:
    """Return a bone from the origin along x, thickest near its start, 1 long and 1 thick."""
    ring = [(0.14, y, z) for y, z in ((0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5))]
    vertices = np.array([(0.0, 0.0, 0.0), *ring, (1.0, 0.0, 0.0)])
    faces = []
    for k in range(4):
        a, b = 1 + k, 1 + (k + 1) % 4
        faces += [(0, b, a), (5, a, b)]
    return vertices, np.array(faces, dtype=np.uint32)


def arrow(sides: int = 12) -> Mesh:
    """Return an arrow along x through the origin, from −0.6 to 1, of radius 0.05 at its head."""
    profile = ((-0.6, 0.0), (-0.6, 0.02), (0.8, 0.02), (0.8, 0.05), (1.0, 0.0))
    return _turned(profile, sides)


def ball(rings: int = 6, sides: int = 10) -> Mesh:
    """Return a sphere about the origin, of radius 1."""
    turns = np.linspace(np.pi, 0.0, rings + 1)
    return _turned(tuple((float(np.cos(t)), float(np.sin(t))) for t in turns), sides)


def ring(tube: float, sides: int = 48, around: int = 8) -> Mesh:
    """Return a ring about x, of radius 1 and with a tube of radius ``tube``."""
    turns = -2 * np.pi * np.arange(around + 1) / around
    profile = tuple((float(tube * np.cos(t)), float(1 + tube * np.sin(t))) for t in turns)
    return _turned(profile, sides)


def _turned(profile: tuple[tuple[float, float], ...], sides: int) -> Mesh:
    """Return the surface that a line of (x, radius) makes when it is turned about x."""
    turns = 2 * np.pi * np.arange(sides) / sides
    points = np.array([(x, r * np.cos(t), r * np.sin(t)) for x, r in profile for t in turns])
    faces = []
    for circle in range(len(profile) - 1):
        for k in range(sides):
            a, b = circle * sides + k, circle * sides + (k + 1) % sides
            faces += [(a, b, b + sides), (a, b + sides, a + sides)]
    # a circle without radius is one point, and a line that ends where it began meets itself
    _, first, same = np.unique(
        np.round(points, 9) + 0.0, axis=0, return_index=True, return_inverse=True
    )
    joined = same.reshape(-1)[np.array(faces)]
    a, b, c = joined.T
    joined = joined[(a != b) & (b != c) & (c != a)]
    return points[first], joined.astype(np.uint32)
