"""Histograms of colours: their bins, learning, how far two are apart."""

from functools import cache

import cv2
import numpy as np
from numpy.typing import NDArray

from kinesphere.markerless.kernels.colour import FLOOR

SIDE = 16
"""Bins along each of lightness, a and b."""
_AB = 64.0  # a and b beyond this share the last bin: nothing in a room is more colourful


@cache
def lab_bins() -> NDArray[np.uint16]:
    """Return the histogram bin of five bits each of red, green and blue, (32768,)."""
    steps = (np.arange(32) * 8 + 4).astype(np.uint8)
    colours = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1)
    lab = cv2.cvtColor(colours.reshape(1, -1, 3).astype(np.float32) / 255, cv2.COLOR_RGB2LAB)[0]
    lightness = np.clip(lab[:, 0] / 100 * SIDE, 0, SIDE - 1).astype(int)
    ab = np.clip((lab[:, 1:] + _AB) / (2 * _AB) * SIDE, 0, SIDE - 1).astype(int)
    return np.asarray((lightness * SIDE + ab[:, 0]) * SIDE + ab[:, 1], dtype=np.uint16)


def mix(known: NDArray[np.float32], new: NDArray[np.float32], rate: float) -> None:
    """Let new densities, (n, n_bins), have a share in known ones; all where nothing was known."""
    seen = new.any(axis=1)
    share = np.where(seen & ~known.any(axis=1), 1.0, rate * seen)[:, None].astype(np.float32)
    known *= 1 - share
    known += share * new


def change(now: NDArray[np.float32], then: NDArray[np.float32]) -> float:
    """Return how much worse a density of colours is explained by an earlier one, nats a pixel.

    The Kullback-Leibler divergence; 0 where nothing is seen now.
    """
    return max(0.0, float((now * np.log((now + FLOOR) / (then + FLOOR))).sum()))
