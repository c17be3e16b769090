"""Histograms of colours: their bins, learning, how far two are apart."""

from functools import cache

import cv2
import numpy as np
from numpy.typing import NDArray

from kinesphere.markerless.kernels.colour import FLOOR, blurred_kernel

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
    """Let new counts, (n, n_bins), have a share in known ones; all where nothing was known."""
    total = new.sum(axis=1, keepdims=True)
    seen = total[:, 0] > 0
    empty = seen & (known.sum(axis=1) == 0)
    share = np.where(empty, 1.0, rate * seen)[:, None].astype(np.float32)
    known *= 1 - share
    known += share * new / np.maximum(total, 1)


def change(now: NDArray[np.float32], then: NDArray[np.float32]) -> float:
    """Return how much worse counted colours are explained by earlier ones, (n_bins,) each.

    In nats a pixel: the Kullback-Leibler divergence of the two densities. 0 where nothing is
    counted now.
    """
    density, earlier = np.empty_like(now), np.empty_like(now)
    blurred_kernel(now, SIDE, density)
    blurred_kernel(then, SIDE, earlier)
    return max(0.0, float((density * np.log((density + FLOOR) / (earlier + FLOOR))).sum()))
