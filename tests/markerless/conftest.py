"""A body among cameras, drawn by the rasterizer."""

import numpy as np
import pytest

from kinesphere.data import Camera, bundled_body
from kinesphere.markerless.anatomy import full_body, upper_body

LENS = np.array([[620.0, 0, 319.5], [0, 620.0, 239.5], [0, 0, 1]])


def camera_at(place, target, name="cam", lens=LENS, size=(640, 480)):
    """Return a pinhole that looks from one point to another, the world's y up."""
    ahead = np.asarray(target, float) - place
    ahead /= np.linalg.norm(ahead)
    right = np.cross(ahead, [0.0, 1, 0])
    right /= np.linalg.norm(right)
    rotation = np.stack([right, np.cross(ahead, right), ahead])
    return Camera(name, *size, lens, np.zeros(5), rotation, -rotation @ place)


def ring(n, radius=2.6, target=(0, 0.9, 0), height=1.5):
    """Return cameras around a target."""
    turns = np.linspace(0, 2 * np.pi, n, endpoint=False) + 0.4
    return tuple(
        camera_at(
            np.array([radius * np.cos(a), height + 0.2 * (i % 2), radius * np.sin(a)]),
            target,
            f"cam{i + 1:02d}",
        )
        for i, a in enumerate(turns)
    )


@pytest.fixture(name="ring", scope="session")
def ring_fixture():
    """Return what puts cameras around a target."""
    return ring


@pytest.fixture(scope="session")
def whole():
    """Return the bundled body, whole."""
    return full_body(bundled_body())


@pytest.fixture(scope="session")
def upper():
    """Return its upper body: the paper's model."""
    return upper_body(bundled_body())
