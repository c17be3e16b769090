"""Frame after frame by what there is: masks, and colours where masks are missing."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Frame
from kinesphere.markerless.fit import Fitter
from kinesphere.markerless.tracking import Found, Tracking
from kinesphere.markerless.watching import pictures_of


@dataclass(eq=False)
class Following:
    """A tracker by masks or by colours; one by masks goes on by colours where there are none."""

    tracking: Tracking
    masks: bool
    """Whether masks are what it goes by."""
    by_colours: Callable[[], Tracking] | None = None
    """Makes the tracker for instants without masks; None: these are blind."""
    _other: Tracking | None = None
    _seen: Sequence[NDArray[np.uint8] | None] = ()
    """The last images in which the person was followed."""

    @property
    def fitter(self) -> Fitter:
        """What found the last pose."""
        return (self._other or self.tracking).fitter

    @property
    def without_masks(self) -> bool:
        """Whether the last pose was found by colours, as masks were missing."""
        return self._other is not None

    def begin(self, frame: Frame) -> Found:
        """Find the pose in the first frame, about where the tracker is."""
        self._seen = frame.images
        return self.tracking.begin(pictures_of(frame, self.masks))

    def step(self, frame: Frame) -> Found:
        """Find the pose in the next frame."""
        if not self.masks or self.by_colours is None or not _bare(frame):
            if self._other is not None:  # masks are back
                self.tracking.last, self.tracking.before = self._other.last, self._other.before
                self._other = None
            found = self.tracking.step(pictures_of(frame, self.masks))
        else:
            if self._other is None:
                self._other = self.by_colours()
                self._other.last = self.tracking.last
                self._other.begin(self._seen)  # colours are learnt where masks told the pose
                self._other.before = self.tracking.before
            found = self._other.step(frame.images)
        if not found.absent:
            self._seen = frame.images
        return found


def _bare(frame: Frame) -> bool:
    """Return whether cameras show an instant of which nobody gave a mask."""
    masked = any(mask is not None for mask in frame.masks)
    return not masked and any(image is not None for image in frame.images)
