"""From frame to frame: predict, fit, judge each limb, bring lost ones back, learn the colours."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Mask
from kinesphere.markerless.absence import nobody_seen
from kinesphere.markerless.contour_fit import ContourFitter
from kinesphere.markerless.fit import Fitter
from kinesphere.markerless.pose import Pose, difference
from kinesphere.markerless.prediction import expectation, predicted, rest
from kinesphere.markerless.recovery import Watch, carried, held_lost, recovered

_OPENING = 5
"""Times the first pose is fitted at most: nobody knows how far off it is."""
_STILL = 0.005
"""rad and m; a fit that moves it by less is the last."""
_LINES = 3
"""Lines along a limb's rim, over all cameras, from which it can be judged."""


@dataclass(frozen=True, eq=False)
class Found:
    """What one instant gave."""

    pose: Pose
    support: Array
    """(n_limbs,) 0–1, of the chain's limbs: share of the evidence along the limb's rim that
    speaks for it; NaN where no rim of it is seen."""
    gain: Array
    """(n_limbs,) nats a pixel by which what the limb covers is likelier it than background."""
    lost: Mask
    """(n_limbs,) held lost."""
    absent: bool = False
    """Whether nobody is there: the pose is the last one in which somebody was."""


@dataclass(eq=False)
class Tracking:
    """A tracker at work; fed one instant after the other."""

    fitter: Fitter
    last: Pose
    before: Pose | None = None
    contours: ContourFitter | None = None
    """Finds the poses in place of the fitter, for the methods that go by contours."""
    watch: Watch = field(default_factory=Watch)

    def begin(self, pictures: Sequence[NDArray[np.uint8] | None]) -> Found:
        """Learn from images, one an eye, (h, w, 3) or masks, that show about the present pose."""
        self._look(pictures)
        chain, settings = self.fitter.body.chain, self.fitter.settings
        if self.fitter.open_eyes:
            self.judged(self.last, learn=1.0)
            for _ in range(_OPENING):
                priors = (expectation(chain, self.last, settings), rest(chain, settings, self.last))
                before, self.last = self.last, self.fitter.fit(self.last, priors)
                if np.abs(difference(chain, before, self.last)).max() < _STILL:
                    break
        return self.judged(self.last, learn=1.0)

    def step(self, pictures: Sequence[NDArray[np.uint8] | None]) -> Found:
        """Find the pose in the next images."""
        self._look(pictures)
        chain, settings = self.fitter.body.chain, self.fitter.settings
        guess = predicted(chain, self.before, self.last, settings.velocity)
        if not self.fitter.open_eyes:
            # nothing to go by: the last pose stays, and its speed is forgotten
            self.before = None
            return self.judged(self.last)
        priors = (expectation(chain, guess, settings), rest(chain, settings, guess))
        pose = (self.contours or self.fitter).fit(guess, priors)
        found = self.judged(pose, learn=settings.learning)
        if found.absent:
            # where the person was seen last is where they are looked for until they come back
            self.before = None
            return replace(found, pose=self.last)
        self.before, self.last = self.last, pose
        missed = found.lost | np.isnan(found.gain)  # nobody sees it: it may be elsewhere
        if settings.recover and (names := self.watch.due(chain, missed)):
            better = recovered(self.fitter, pose, names)
            if better is not None:
                self.before, self.last = None, better  # it did not move there: it was there
                found = self.judged(better)
        return found

    def _look(self, pictures: Sequence[NDArray[np.uint8] | None]) -> None:
        eyes = self.fitter.eyes
        views = [
            None if p is None else e.canvas.view.image(p)
            for e, p in zip(eyes, pictures, strict=True)
        ]
        for eye, picture in zip(eyes, views, strict=True):
            eye.evidence.look(picture)
        if self.contours is not None:
            self.contours.look(views)

    def judged(self, pose: Pose, learn: float = 0.0) -> Found:
        """Judge a pose, and take it as true as far as ``learn`` goes."""
        n = len(self.fitter.body.chain.links)
        told_for, told = np.zeros(n), np.zeros(n)
        scores, counts = np.zeros(n), np.zeros(n)
        looks = list(zip(self.fitter.open_eyes, self.fitter.look_at(pose), strict=True))
        for eye, (parts, rim) in looks:
            if learn >= 1:
                eye.evidence.learn(rim, parts, learn)
            eye.evidence.score(parts, scores, counts)
            if len(rim.shares):
                agreement = self.fitter.edges(eye, rim, parts, 2)[2]
                known = np.isfinite(agreement)
                np.add.at(told_for, rim.parts[known, 0], agreement[known])
                np.add.at(told, rim.parts[known, 0], 1)
        support, gain = _shares(told_for, told, scores, counts)
        with_hands = [carried(self.fitter.body.chain, x) for x in (told_for, told, scores, counts)]
        lost = held_lost(*_shares(*with_hands), self.fitter.settings)
        absent = nobody_seen(support, gain, lost)
        if 0 < learn < 1 and not absent:
            for eye, (parts, rim) in looks:
                eye.evidence.learn(rim, parts, learn)
        return Found(pose, support, gain, lost, absent)


def _shares(told_for: Array, told: Array, scores: Array, counts: Array) -> tuple[Array, Array]:
    """Return support and gain, (n_limbs,); NaN where there is too little to tell."""
    with np.errstate(invalid="ignore", divide="ignore"):
        support = np.where(told >= _LINES, told_for / told, np.nan)
        gain = np.where(counts >= _LINES, scores / counts, np.nan)
    return support, gain
