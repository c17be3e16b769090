"""From frame to frame: predict, fit, judge each limb, learn the colours."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.markerless.contour_fit import ContourFitter
from kinesphere.markerless.fit import Fitter
from kinesphere.markerless.pose import Pose
from kinesphere.markerless.prediction import expectation, predicted, rest


@dataclass(frozen=True, eq=False)
class Found:
    """What one instant gave."""

    pose: Pose
    support: Array
    """(n_limbs,) 0–1, of the chain's limbs: share of the evidence along the limb's rim that
    speaks for it; NaN where no rim of it is seen."""
    gain: Array
    """(n_limbs,) nats a pixel by which what the limb covers is likelier it than background."""


@dataclass(eq=False)
class Tracking:
    """A tracker at work; fed one instant after the other."""

    fitter: Fitter
    last: Pose
    before: Pose | None = None
    contours: ContourFitter | None = None
    """Finds the poses in place of the fitter, for the methods that go by contours."""

    def begin(self, pictures: Sequence[NDArray[np.uint8]]) -> Found:
        """Take the present pose as that of these images, (h, w, 3) or masks, one an eye."""
        self._look(pictures)
        return self._judged(self.last, learn=1.0)

    def step(self, pictures: Sequence[NDArray[np.uint8]]) -> Found:
        """Find the pose in the next images."""
        self._look(pictures)
        chain, settings = self.fitter.body.chain, self.fitter.settings
        guess = predicted(chain, self.before, self.last, settings.velocity)
        priors = (expectation(chain, guess, settings), rest(chain, settings, guess))
        pose = (self.contours or self.fitter).fit(guess, priors)
        self.before, self.last = self.last, pose
        return self._judged(pose, learn=settings.learning)

    def _look(self, pictures: Sequence[NDArray[np.uint8]]) -> None:
        eyes = self.fitter.eyes
        views = [e.canvas.view.image(p) for e, p in zip(eyes, pictures, strict=True)]
        for eye, picture in zip(eyes, views, strict=True):
            eye.evidence.look(picture)
        if self.contours is not None:
            self.contours.look(views)

    def _judged(self, pose: Pose, learn: float) -> Found:
        n = len(self.fitter.body.chain.links)
        total, lines = np.zeros(n), np.zeros(n)
        scores, counts = np.zeros(n), np.zeros(n)
        for eye, (parts, rim) in zip(self.fitter.eyes, self.fitter.look_at(pose), strict=True):
            if learn >= 1:
                eye.evidence.learn(rim, parts, learn)
            eye.evidence.score(parts, scores, counts)
            if len(rim.shares):
                agreement = self.fitter.edges(eye, rim, parts, 2)[2]
                told = np.isfinite(agreement)
                np.add.at(total, rim.parts[told, 0], agreement[told])
                np.add.at(lines, rim.parts[told, 0], 1)
            if 0 < learn < 1:
                eye.evidence.learn(rim, parts, learn)
        with np.errstate(invalid="ignore"):
            support = np.where(lines >= 3, total / lines, np.nan)
            gain = np.where(counts >= 3, scores / counts, np.nan)
        return Found(pose, support, gain)
