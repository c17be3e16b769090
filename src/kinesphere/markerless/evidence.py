"""What a tracker asks of an image: where the person is, and how surely."""

from typing import Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Mask
from kinesphere.markerless.rim import Parts, Rim

STRIDE = 3
"""px; of the grid on which poses are compared."""
MOST = 3.0
"""nats a pixel may say."""


class Evidence(Protocol):
    """What one camera's image says."""

    @property
    def seeing(self) -> bool:
        """Whether there is an image at this instant."""

    def look(self, picture: NDArray[np.uint8] | None) -> None:
        """Take in a new image of the view, or that there is none."""

    def samples(self, rim: Rim, use: NDArray[np.int8], scale: int) -> Array:
        """Return how likely samples across the rim are the person's, (n, SAMPLES)."""

    def ratios(self, parts: Parts, reach: int) -> NDArray[np.float32]:
        """Return how much likelier each pixel is the person's, (height, width) in nats.

        Asked for the limb nearest to it, up to ``reach`` px from the model.
        """

    def learn(self, rim: Rim, parts: Parts, rate: float) -> None:
        """Take the present pose as true, as far as ``rate`` (0 to 1) goes."""

    def score(self, parts: Parts, scores: Array, counts: Array) -> None:
        """Add how much a pose explains, (n_limbs,) in nats, and by how many pixels."""

    def person(self, model: Mask) -> tuple[Mask, Mask]:
        """Return, on a grid of pixels around the model, what it covers and where a person is."""


class Levels:
    """An image at its own and, as they are asked for, at smaller sizes."""

    def __init__(self, picture: NDArray[np.uint8]) -> None:
        self._levels = {1: picture}

    def __getitem__(self, scale: int) -> NDArray[np.uint8]:
        """Return the image ``scale`` times smaller, averaged."""
        if scale not in self._levels:
            full = self._levels[1]
            size = (max(2, full.shape[1] // scale), max(2, full.shape[0] // scale))
            small = cv2.resize(full, size, interpolation=cv2.INTER_AREA)
            self._levels[scale] = np.asarray(small, dtype=np.uint8)
        return self._levels[scale]
