"""Cameras to be written in every format."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.data import Camera


@pytest.fixture
def cameras(rng):
    """Two cameras that differ in everything."""
    found = []
    for i, size in enumerate(((640, 480), (1088, 1920))):
        turn = Rotation.random(rng=rng).as_matrix()
        matrix = np.array([[700.0 + i, 0, 311.5], [0, 705.0, 240.25], [0, 0, 1]])
        bends = rng.normal(scale=0.05, size=5)
        found.append(Camera(f"cam{i + 1}", *size, matrix, bends, turn, rng.normal(size=3)))
    return tuple(found)
