"""How large the person is, where only a pose is given to begin with."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Camera
from kinesphere.data.surface import Surface
from kinesphere.markerless.body import Body
from kinesphere.markerless.eyes import fitter_for
from kinesphere.markerless.first_pose import FirstPose
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.shape import shaped
from kinesphere.markerless.tracking import Tracking

_TRIED = 0.03 * np.arange(-4, 5)
"""Logarithms of sizes; the factors of `shape` do the rest."""


def with_best_size(
    start: FirstPose,
    cameras: Sequence[Camera],
    surface: Surface,
    model: Callable[[Surface], Body],
    settings: TrackSettings,
    pictures: Sequence[NDArray[np.uint8] | None],
    *,
    masks: bool,
) -> FirstPose:
    """Return a start whose size explains the first images best, its pose as it was.

    A body too large puts its feet onto the floor and learns the floor's colours as theirs; no
    fitting brings them back. So every size learns its own colours, and the one wins whose limbs
    are, on average, most unlike what lies behind them (which alone favours small bodies) along
    the clearest rims (which alone favours large ones). Given masks are not learnt: there the size
    wins that explains most.
    """
    best, most = start, -np.inf
    for more in sorted(_TRIED, key=abs):  # of equals the one nearest to what was given
        logs = start.logs.copy()
        logs[0] += more
        body = model(shaped(surface, logs))
        tracking = Tracking(fitter_for(body, cameras, settings, masks=masks), start.pose)
        found = tracking.begin(pictures)
        if not np.isfinite(found.gain * found.support).any():
            return start
        if masks:
            explained = float(tracking.fitter.score(found.pose)[0].sum())
        else:
            explained = float(np.nanmean(found.gain * found.support))
        if explained > most:
            best, most = replace(start, logs=logs), explained
    return best
