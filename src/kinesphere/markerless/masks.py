"""Evidence from masks: given ones, or an image of probabilities."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Mask
from kinesphere.markerless.evidence import MOST, STRIDE, Levels
from kinesphere.markerless.kernels.contour import NOWHERE
from kinesphere.markerless.kernels.lines import SAMPLES, mask_samples_kernel
from kinesphere.markerless.kernels.region import mask_score_kernel
from kinesphere.markerless.pieces import around
from kinesphere.markerless.rim import Parts, Rim

_NOTHING = np.zeros((2, 2), dtype=np.uint8)


class Masks:
    """A mask, or an image of probabilities from 0 to 255, is what there is."""

    def __init__(self) -> None:
        self._levels = Levels(_NOTHING)
        self._seeing = False

    @property
    def seeing(self) -> bool:
        """Whether there is a mask at this instant."""
        return self._seeing

    def look(self, picture: NDArray[np.uint8] | None) -> None:
        """Take in a new mask, or that there is none."""
        self._seeing = picture is not None
        self._levels = Levels(_NOTHING if picture is None else picture)

    def samples(self, rim: Rim, use: NDArray[np.int8], scale: int) -> Array:
        """Return how likely samples across the rim are the person's."""
        use = np.where(rim.parts[:, 1:] >= 0, np.int8(0), use)  # a mask knows no inner contours
        out = np.empty((len(use), SAMPLES))
        level = self._levels[scale]
        mask_samples_kernel(rim.pixels, rim.normals, use, level, float(scale), float(scale), out)
        return out

    def ratios(self, parts: Parts, reach: int) -> NDArray[np.float32]:
        """Return how much likelier each pixel is the person's."""
        mask = self._levels[1]
        out = np.zeros(mask.shape, dtype=np.float32)
        if (box := around(parts.limbs != NOWHERE, reach)) is not None:
            p = 0.02 + 0.96 * mask[box].astype(np.float32) / 255
            out[box] = np.log(p / (1 - p))
        return out

    def learn(self, rim: Rim, parts: Parts, rate: float) -> None:
        """Do nothing: a mask is given."""

    def score(self, parts: Parts, scores: Array, counts: Array) -> None:
        """Add how much a pose explains."""
        mask_score_kernel(parts.limbs, self._levels[1], STRIDE, MOST, scores, counts)

    def person(self, model: Mask) -> tuple[Mask, Mask]:
        """Return what the model covers, and the mask."""
        return model, np.asarray(self._levels[1] > 127)
