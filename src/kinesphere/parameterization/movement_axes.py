"""Axes from a joint's own movement, and everything that speaks against them."""

from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.even_frames import parted
from kinesphere.parameterization.anatomy import nominal_axes
from kinesphere.parameterization.angles import two_axis_angles
from kinesphere.parameterization.arcs import PERCENTILES
from kinesphere.parameterization.axes import find_axes
from kinesphere.parameterization.axes.fit import phase_labels
from kinesphere.parameterization.axes.hinge import other_reading
from kinesphere.parameterization.axes.registry import BY_ORIENTATION
from kinesphere.parameterization.axes.universal_joint import reference_rotation
from kinesphere.parameterization.confidence import AxesQuality, assess_axes
from kinesphere.parameterization.doubts import apart, reasons_to_doubt
from kinesphere.parameterization.free_hinge import worse_than_body
from kinesphere.parameterization.halves import (
    LEAST_SHARE,
    Finder,
    Searcher,
    contradiction,
    early_share,
)
from kinesphere.parameterization.main_movements import long_phases, main_movements
from kinesphere.parameterization.one_of_two import REPEATED, axis_told
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import (
    AngleSettings,
    AxesSettings,
    ParameterizationSettings,
)
from kinesphere.parameterization.view import JointView, view_halves

COMPARABLE = 0.5  # of the whole arc: a half that moves less far is no judge of the whole


@dataclass(frozen=True, eq=False)
class MovementAxes:
    """What a joint's movement tells about its axes."""

    axes: Array
    """(n_found, 3)"""
    quality: AxesQuality | None
    """None where nothing was found."""
    doubts: tuple[str, ...]
    """Why these axes should not serve, each a clause."""
    remark: str = ""
    """What a person should know of axes that serve: how far two halves contradict each other."""
    told: int | None = None
    """Which of two axes serves although the other does not: `axis_told`."""

    def doubtful(self, options: AxesSettings) -> bool:
        """Return whether anything speaks against these axes."""
        most = np.deg2rad(options.largest_disagreement)
        return bool(self.doubts or self.quality is None or self.quality.halves.max() > most)


def movement_axes(view: JointView, n_axes: int, settings: ParameterizationSettings) -> MovementAxes:
    """Return axes from the movement, how good they are, and what speaks against them."""
    options = settings.axes
    if options.method == "body":
        return MovementAxes(np.empty((0, 3)), None, ())

    def find(half: JointSamples) -> Array:
        return find_axes(half, n_axes, options)

    free = _in_free_motion(n_axes, options)

    def search(among: JointSamples) -> tuple[JointSamples, Array]:
        once = None
        for phases in (among.phases,) if free else main_movements(among, options):
            if once is not None and phases == among.phases:
                break  # phases of any kind repeat nothing
            samples = among.with_phases(phases)
            axes = find(samples)
            if len(axes) == n_axes:
                labels = phase_labels(samples, axes)
                if min((labels == k).sum() for k in range(n_axes)) >= REPEATED:
                    return samples, axes
                once = once or (samples, axes)
        return once or (samples, axes)

    samples, axes = search(view.samples)
    if len(axes) == 0:
        unseen = not view.calibration.any()
        return MovementAxes(
            axes, None, ("it is never seen" if unseen else "the limb hardly moves",)
        )
    judged = _judged(view, samples, axes, n_axes, find, search, settings)
    long = long_phases(samples)
    if judged.doubtful(options) and not free and 0 < len(long) < len(samples.phases):
        calmer = samples.with_phases(long)
        again = find(calmer)
        if len(again) == n_axes:
            second = _judged(view, calmer, again, n_axes, find, search, settings)
            if not second.doubtful(options):
                return second
    return judged


def _judged(
    view: JointView,
    samples: JointSamples,
    axes: Array,
    n_axes: int,
    find: Finder,
    search: Searcher,
    settings: ParameterizationSettings,
) -> MovementAxes:
    """Return how good axes from some phases are, and what speaks against them."""
    options = settings.axes
    free = _in_free_motion(n_axes, options)
    doubtful = 2 * np.deg2rad(options.largest_uncertainty)
    # a search in free motion takes seconds: once halves contradict each other that is that
    quality = assess_axes(samples, axes, find, doubtful if free else np.inf)
    if n_axes == 1 and options.refine and options.method in BY_ORIENTATION:
        quality = replace(quality, readings=np.array([other_reading(samples, axes[0])]))
    nominal = nominal_axes(view.name, axes) if view.human else None
    positions = view.samples.positions
    if len(axes) < n_axes:
        doubts = [f"only {len(axes)} of {n_axes} main movements is there"]
    else:
        if free:
            quality = replace(quality, ranges=_free_ranges(view, axes))
            options = replace(options, smallest_explained=0.0)
        doubts = reasons_to_doubt(quality, axes, nominal, positions, options)
    if nominal is not None and n_axes == 1 and worse_than_body(axes[0], nominal[0], positions):
        doubts.append("the body frame's axis suits all the movement clearly better")
    pair = n_axes == 2 and not free
    told = axis_told(quality, axes, view, options) if doubts and pair else None
    if doubts and told is None:
        return MovementAxes(axes, quality, tuple(doubts))
    quality, apart_by = _contradicted(view, samples, axes, n_axes, quality, search, settings)
    if not doubts:
        doubts = reasons_to_doubt(quality, axes, nominal, positions, options)
    told = axis_told(quality, axes, view, options, apart_by) if doubts and pair else None
    remark = _remark(apart_by if told is None else apart_by[[told]], options)
    return MovementAxes(axes, quality, tuple(doubts), remark, told)


def _contradicted(
    view: JointView,
    samples: JointSamples,
    axes: Array,
    n_axes: int,
    quality: AxesQuality,
    search: Searcher,
    settings: ParameterizationSettings,
) -> tuple[AxesQuality, Array]:
    """Return the quality with what halves of the time contradict, and the most they do, (n,) rad.

    The most holds halves, too, that are not alike enough to judge the whole.
    """
    halves = (half.samples for half in view_halves(view, settings))
    off, arcs = contradiction(halves, axes, search)
    comparable = arcs >= COMPARABLE * quality.ranges
    if n_axes > 1:  # main movements are made one after another: a half may lack one
        half = parted(len(view.samples.positions))
        shares = early_share(samples, quality.labels, len(axes), *half)
        comparable &= np.abs(shares - 0.5) <= 0.5 - LEAST_SHARE
    halves_apart = np.fmax(quality.halves, np.where(comparable, off, np.nan))
    said = np.where(arcs >= np.deg2rad(settings.axes.smallest_range), off, 0.0)
    return replace(quality, halves=halves_apart), np.fmax(halves_apart, said)


def _remark(halves: Array, options: AxesSettings) -> str:
    """Return how far halves contradict each other, a clause; empty where they hardly do."""
    return apart(halves) if np.rad2deg(halves.max()) > options.largest_disagreement else ""


def _in_free_motion(n_axes: int, options: AxesSettings) -> bool:
    """Return whether the method needs no main movements."""
    return options.method == "universal-joint" and n_axes == 2


def _free_ranges(view: JointView, axes: Array) -> Array:
    """Return the ranges of both angles of a joint that moves about its axes at once, (2,) rad."""
    at = view.calibration
    angles = two_axis_angles(
        view.samples.rotations,
        axes,
        reference_rotation(view.samples),
        view.long_axis,
        view.twist_known[at],
        AngleSettings(),
    ).angles[:, :2]
    low, high = np.percentile(angles, PERCENTILES, axis=0)
    return np.asarray(high - low)
