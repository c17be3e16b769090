"""One joint as the whole recording shows it: samples, movement, calibration."""

from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import Array, Codes, Mask, PoseFlag
from kinesphere.geometry.even_frames import parted
from kinesphere.geometry.rotations import carried
from kinesphere.parameterization.coupling import Neighbours
from kinesphere.parameterization.movement_filter import Movement, limb_speeds, movement_of
from kinesphere.parameterization.samples import JointSamples, runs, smooth_rotations
from kinesphere.parameterization.settings import ParameterizationSettings
from kinesphere.parameterization.slow_movement import slow_movement

FAIR_SHARE = 0.25  # of the seen frames; the others may show movements that these do not
NONE = Neighbours()
EDGE = 0.01  # of a frame: a frame on the edge of a window is inside, however its time is rounded


@dataclass(frozen=True, eq=False)
class Smoothed:
    """A joint's rotations without noise, whichever frames count."""

    rotations: Array
    """(n_frames, 3, 3)"""
    speeds: Array
    """(n_frames,) rad/s, of the limb."""
    slow: Movement | None = None
    """The movement of a limb that goes far but never fast, the same for every part of it."""


@dataclass(frozen=True, eq=False)
class JointView:
    """One joint as the whole recording shows it."""

    name: str
    rotations: Array
    """(n_frames, 3, 3) ``parent_from_child``; NaN where unseen."""
    long_axis: Array
    """(3,) in the child."""
    twist_known: Mask
    """(n_frames,) False where the orientation about the limb is arbitrary."""
    samples: JointSamples
    """The calibration's frames one after another, smoothed, with their movement phases."""
    movement: Movement
    calibration: Mask
    """(n_frames,) seen and reliable frames that axes and rest are taken from."""
    smoothed: Smoothed
    """All frames, those outside the calibration too."""
    human: bool = True
    """Whether anatomy says where this joint can have an axis."""
    neighbours: Neighbours = NONE
    """How limbs move at the joints that share a limb with this one."""

    @property
    def gravity(self) -> Array:
        """(3,) centre of gravity of the samples; the limb aligned with its parent without any."""
        p = self.samples.positions
        return np.asarray(p.mean(axis=0)) if len(p) else self.long_axis


def frames_within(n_frames: int, rate: float, window: tuple[float, float]) -> Mask:
    """Return which frames lie in a window, (start, end) in s since the first one, both included."""
    start, end = (rate * edge for edge in window)
    frames = np.arange(n_frames)
    return np.asarray((frames >= start - EDGE) & (frames <= end + EDGE))


def reliable_frames(flags: Codes, window: Mask) -> Mask:
    """Return the frames of a window whose poses are good enough to find axes from, (n_frames,).

    Each limb counts where its pose came about as well as it usually does: a limb of three markers
    leans on a joint only while one of them is hidden, a sparse one always. Where this leaves too
    little, worse poses count too, what was filled at last; a doubtful axis beats none.

    Parameters
    ----------
    flags : (n_frames, 2)
        PoseFlag of parent and child.
    window : (n_frames,)
    """
    seen = np.asarray(window & (flags != PoseFlag.UNSEEN).all(axis=1))
    enough = FAIR_SHARE * seen.sum()
    levels = [  # the flags are in the order of trust
        next(level for level in PoseFlag if (limb <= level).sum() >= enough)
        for limb in flags[seen].T
    ]
    for least in PoseFlag:
        chosen = seen & (flags <= np.maximum(levels, least)).all(axis=1)
        if chosen.sum() >= enough:
            return np.asarray(chosen)
    return seen


def view_joint(
    name: str,
    rotations: Array,
    long_axis: Array,
    twist_known: Mask,
    rate: float,
    calibration: Mask,
    settings: ParameterizationSettings,
    human: bool = True,
    smoothed: Smoothed | None = None,
    neighbours: Neighbours = NONE,
) -> JointView:
    """Smooth one joint's rotations and find its movement phases; arguments as in `JointView`.

    ``smoothed`` is what another view of the same joint has already.

    Frames outside ``calibration`` are neither found axes from nor smoothed into those that are; a
    phase runs on across the few that are missing inside it. Where none of them passes the threshold
    the movement may be slow (`kinesphere.parameterization.slow_movement`).
    """
    cutoff = 0.0 if settings.filter.method == "paper" else settings.filter.cutoff
    first_view = smoothed is None
    if smoothed is None:
        smooth = smooth_rotations(rotations, rate, cutoff)
        smoothed = Smoothed(smooth, limb_speeds(carried(smooth, long_axis), rate, settings.filter))
    smooth = smoothed.rotations
    chosen = np.asarray(np.isfinite(smooth[:, 0, 0]) & calibration)
    movement = smoothed.slow or movement_of(smoothed.speeds, rate, settings.filter, calibration)
    if first_view and not movement.valley:
        positions = carried(smooth, long_axis)
        slow = slow_movement(positions, rate, chosen, movement.moving & chosen, settings)
        smoothed = replace(smoothed, slow=slow)
        movement = slow or movement
    frames = np.flatnonzero(chosen)
    if 0 < len(frames) < len(rotations):
        first, own = frames[0], slice(frames[0], frames[-1] + 1)
        alone = np.where(chosen[own, None, None], rotations[own], np.nan)
        smooth = smooth_rotations(alone, rate, cutoff)[frames - first]
    else:
        smooth = smooth[frames]
    phases = tuple(
        (int(a), int(b))
        for a, b in np.searchsorted(frames, np.reshape(runs(movement.moving), (-1, 2)))
        if b > a
    )
    samples = JointSamples(
        smooth, carried(smooth, long_axis), phases, rate, long_axis, frames, rotations[frames]
    )
    return JointView(
        name,
        rotations,
        long_axis,
        twist_known,
        samples,
        movement,
        chosen,
        smoothed,
        human,
        neighbours,
    )


def view_halves(view: JointView, settings: ParameterizationSettings) -> tuple[JointView, JointView]:
    """Return the joint as each half of its calibration alone would show it."""
    frames = np.flatnonzero(view.calibration)
    n_early, first_late = parted(len(frames))
    early, late = np.zeros((2, len(view.calibration)), dtype=bool)
    early[frames[:n_early]] = late[frames[first_late:]] = True
    first, second = (
        view_joint(
            view.name,
            view.rotations,
            view.long_axis,
            view.twist_known,
            view.samples.rate,
            half,
            settings,
            view.human,
            view.smoothed,
            view.neighbours,
        )
        for half in (early, late)
    )
    return first, second
