"""The six directions along the axes of a coordinate system, as people and files name them."""

from typing import Literal, TypeAlias

import numpy as np

from kinesphere.data.arrays import Array

UpAxis: TypeAlias = Literal["+x", "-x", "+y", "-y", "+z", "-z"]

DIRECTIONS: tuple[UpAxis, ...] = ("+x", "-x", "+y", "-y", "+z", "-z")


def vector_from_direction(direction: str) -> Array:
    """Return the unit vector, (3,), that one of ``DIRECTIONS`` names."""
    vector = np.zeros(3)
    vector["xyz".index(direction[1])] = -1.0 if direction[0] == "-" else 1.0
    return vector


_TURNS: dict[UpAxis, list[list[int]]] = {
    "+y": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
    "-y": [[1, 0, 0], [0, -1, 0], [0, 0, -1]],
    "+z": [[1, 0, 0], [0, 0, 1], [0, -1, 0]],
    "-z": [[1, 0, 0], [0, 0, -1], [0, 1, 0]],
    "+x": [[0, -1, 0], [1, 0, 0], [0, 0, 1]],
    "-x": [[0, 1, 0], [-1, 0, 0], [0, 0, 1]],
}
"""Up in the file → the least turn that takes it to +y; rows are the world's axes in the file's."""


def world_from_up(up: UpAxis, mirrored: bool = False) -> Array:
    """Return the signed permutation that takes ``up`` to +y, (3, 3); determinant −1 if mirrored."""
    turn = np.array(_TURNS[up], dtype=np.float64)
    if mirrored:
        turn[2] *= -1
    return turn
