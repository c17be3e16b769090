"""Evidence from colours: of limbs, of what lies beside them, of the rest of the room."""

import cv2
import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Mask
from kinesphere.markerless.evidence import MOST, STRIDE, Levels
from kinesphere.markerless.histograms import SIDE, change, lab_bins, mix
from kinesphere.markerless.kernels.colour import (
    FLOOR,
    blurred_kernel,
    colour_samples_kernel,
    count_far_kernel,
    count_lines_kernel,
)
from kinesphere.markerless.kernels.contour import NOWHERE
from kinesphere.markerless.kernels.lines import SAMPLES
from kinesphere.markerless.kernels.region import log_ratios_kernel, region_score_kernel
from kinesphere.markerless.pieces import around
from kinesphere.markerless.rim import Parts, Rim

_MARGIN = 20
"""px around the model in which a person is looked for."""
_CHANGED = 0.02
"""nats a pixel; from which on the light has changed so much that limbs are learnt in full."""
_NOTHING = np.zeros((2, 2, 3), dtype=np.uint8)


class Colours:
    """Colours of limbs and of the background beside them, learnt from the poses found."""

    def __init__(
        self, groups: NDArray[np.int32], near_limbs: NDArray[np.bool_], local: float
    ) -> None:
        n = int(groups.max()) + 1
        self._groups, self._near_limbs, self._local = groups, near_limbs, local
        self._densities = [
            np.zeros((n, SIDE**3), dtype=np.float32),
            np.zeros((n, SIDE**3), dtype=np.float32),
            np.zeros((1, SIDE**3), dtype=np.float32),
        ]
        self._witness = np.zeros((1, SIDE**3), dtype=np.float32)
        """Background in the light in which the limbs were learnt."""
        self._levels = Levels(_NOTHING)
        self._seeing = False

    @property
    def seeing(self) -> bool:
        """Whether there is an image at this instant."""
        return self._seeing

    def look(self, picture: NDArray[np.uint8] | None) -> None:
        """Take in a new image, or that there is none."""
        self._seeing = picture is not None
        self._levels = Levels(_NOTHING if picture is None else picture)

    def samples(self, rim: Rim, use: NDArray[np.int8], scale: int) -> Array:
        """Return how likely samples across the rim are the person's."""
        limbs, near, far = self._densities
        out = np.empty((len(use), SAMPLES))
        colour_samples_kernel(
            rim.pixels,
            rim.normals,
            rim.parts,
            use,
            self._levels[scale],
            float(scale),
            float(scale),
            lab_bins(),
            self._groups,
            limbs,
            near,
            far[0],
            self._local,
            out,
        )
        return out

    def ratios(self, parts: Parts, reach: int) -> NDArray[np.float32]:
        """Return how much likelier each pixel near the model is the person's."""
        out = np.zeros(parts.limbs.shape, dtype=np.float32)
        box = around(parts.limbs != NOWHERE, reach)
        if box is None:
            return out
        limbs, near, far = self._densities
        ratios = np.empty_like(out[box])
        log_ratios_kernel(
            _nearest(parts.limbs[box]),
            np.ascontiguousarray(self._levels[1][box]),
            lab_bins(),
            self._groups,
            limbs,
            near,
            far[0],
            self._local,
            ratios,
        )
        out[box] = cv2.blur(ratios, (3, 3))  # single pixels err
        return out

    def learn(self, rim: Rim, parts: Parts, rate: float) -> None:
        """Mix the colours of the present pose into those known.

        Limbs wear what they wear: theirs change with the light, which the background tells of
        wherever the pose is. They are learnt as far as it has changed since; what lies beside
        them is learnt always, as they move. Learnt in every frame, a sleeve put wrong becomes
        right by and by.
        """
        fresh = [np.zeros_like(counts) for counts in self._densities]
        image, bins = self._levels[1], lab_bins()
        count_lines_kernel(
            rim.pixels,
            rim.normals,
            rim.parts,
            parts.limbs,
            self._near_limbs,
            image,
            bins,
            self._groups,
            2,
            14,
            20,
            fresh[0],
            fresh[1],
        )
        count_far_kernel(parts.limbs, image, bins, 4, fresh[2][0])
        for counts in fresh:
            for row in counts:
                blurred_kernel(row, SIDE, row)
        limb_rate = rate
        if rate < 1:
            limb_rate *= min(1.0, change(fresh[2], self._witness) / _CHANGED)
        mix(self._witness, fresh[2], limb_rate)
        rates = (limb_rate, rate, rate)
        for known, new, share in zip(self._densities, fresh, rates, strict=True):
            mix(known, new, share)

    def score(self, parts: Parts, scores: Array, counts: Array) -> None:
        """Add how much a pose explains."""
        limbs, _, far = self._densities
        region_score_kernel(
            parts.limbs,
            self._levels[1],
            lab_bins(),
            self._groups,
            limbs,
            far[0],
            STRIDE,
            MOST,
            scores,
            counts,
        )

    def person(self, model: Mask) -> tuple[Mask, Mask]:
        """Return, on a grid of pixels around the model, what it covers and where a person is.

        By the colours of all limbs together against those of the background; smoothed, as single
        pixels err. In clutter that is a rough guess.
        """
        box = around(model, _MARGIN)
        if box is None:
            return model, np.zeros_like(model)
        rows, cols = box
        grid = (slice(rows.start, rows.stop, STRIDE), slice(cols.start, cols.stop, STRIDE))
        colours = self._levels[1][grid].astype(np.intp) >> 3
        bins = lab_bins()[(colours[..., 0] << 10) + (colours[..., 1] << 5) + colours[..., 2]]
        limbs, near, far = self._densities
        counts, beside = (c.any(axis=1, keepdims=True) for c in (limbs, near))
        person = (limbs * counts).sum(axis=0) / max(1, counts.sum())
        ground = 0.5 * (near * beside).sum(axis=0) / max(1, beside.sum()) + 0.5 * far[0]
        ratio = np.log((person + FLOOR) / (ground + FLOOR)).astype(np.float32)
        return model[grid], np.asarray(cv2.blur(ratio[bins], (3, 3)) > 0)


def _nearest(limbs: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return the limb nearest to each pixel of an image of limbs."""
    shown = limbs != NOWHERE
    _, labels = cv2.distanceTransformWithLabels(
        (~shown).astype(np.uint8), cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL
    )
    owner = np.full(int(labels.max()) + 1, NOWHERE, dtype=np.int32)
    owner[labels[shown]] = limbs[shown]
    return np.asarray(owner[labels])
