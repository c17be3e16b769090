"""A person to look at: marker positions that anybody would recognise."""

import numpy as np
import pytest

from kinesphere.data import Recording

RATE = 60.0  # Hz
FRAMES = 47
MIDDLE = {
    "C7": (-0.06, 1.48),
    "T10": (-0.09, 1.28),
    "CLAV": (0.06, 1.43),
    "STRN": (0.09, 1.27),
}
"""x anterior, y up, m; on the middle plane."""
RIGHT = {
    "FHD": (0.09, 1.70, 0.08),
    "BHD": (-0.09, 1.70, 0.07),
    "SHO": (0.0, 1.46, 0.19),
    "ELB": (-0.02, 1.13, 0.27),
    "WRA": (0.05, 0.87, 0.28),
    "FWT": (0.10, 1.02, 0.13),
    "BWT": (-0.09, 1.04, 0.06),
    "KNE": (0.0, 0.50, 0.14),
    "ANK": (-0.02, 0.08, 0.13),
    "HEE": (-0.07, 0.04, 0.10),
    "TOE": (0.14, 0.04, 0.12),
}
"""x anterior, y up, z right, m; the left side is its mirror image."""
LABELS = (*MIDDLE, *(f"R{name}" for name in RIGHT), *(f"L{name}" for name in RIGHT))


def figure():
    """Return the standing person, (26, 3) m."""
    right = np.array(list(RIGHT.values()))
    return np.concatenate([[(x, y, 0.0) for x, y in MIDDLE.values()], right, right * [1, 1, -1]])


def person_of(positions):
    """Return a recording of (n_frames, 26, 3) positions, y up."""
    return Recording(markers=positions, labels=LABELS, rate=RATE)


@pytest.fixture
def walker(rng):
    """Return a person who walks 2 m on a slant, bobs, and is seen with noise and gaps."""
    t = np.linspace(0, 1, FRAMES)[:, None]
    body = figure()
    step = np.sin(8 * np.pi * t) * (body[:, 1] < 0.6)  # legs swing, in turns
    swing = 0.15 * step * np.sign(body[:, 2])
    positions = np.tile(body, (FRAMES, 1, 1))
    positions[..., 0] += 2.0 * t + swing
    positions[..., 1] += 0.02 * np.sin(16 * np.pi * t) * (body[:, 1] > 0.6)
    positions[..., 2] += 0.9 * t + 0.7
    positions += rng.normal(scale=1e-3, size=positions.shape)
    positions[rng.random(positions.shape[:2]) < 0.05] = np.nan
    return person_of(positions)


@pytest.fixture
def statue():
    """Return a person who stands still, 0.7 m to the right of the origin, facing along x."""
    return person_of(np.tile(figure() + np.array([0.3, 0.0, 0.7]), (FRAMES, 1, 1)))
