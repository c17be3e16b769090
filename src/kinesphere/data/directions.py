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
