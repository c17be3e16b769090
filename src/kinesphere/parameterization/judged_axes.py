"""Whether axes that some phases show are those of main movements: all that tells."""

from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.even_frames import parted
from kinesphere.parameterization.anatomy import nominal_axes, room
from kinesphere.parameterization.axes.hinge import other_reading
from kinesphere.parameterization.axes.refinement import other_readings
from kinesphere.parameterization.axes.registry import BY_ORIENTATION
from kinesphere.parameterization.confidence import AxesQuality, assess_axes
from kinesphere.parameterization.coupling import coupling
from kinesphere.parameterization.doubts import apart, reasons_to_doubt, uncertain
from kinesphere.parameterization.free_hinge import worse_than_body
from kinesphere.parameterization.free_pair import (
    CLOSEST,
    free_ranges,
    in_free_motion,
    shared_rhythm,
    too_short,
)
from kinesphere.parameterization.halves import (
    LEAST_SHARE,
    Finder,
    Searcher,
    contradiction,
    early_share,
)
from kinesphere.parameterization.one_of_two import axis_told
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import AxesSettings, ParameterizationSettings
from kinesphere.parameterization.view import JointView, view_halves

COMPARABLE = 0.5  # of the whole arc: a half that moves less far is no judge of the whole

OFTEN = 4  # phases that are shorter than those of main movements must be as many
MOST_UNCERTAIN = 45.0  # deg; the setting's own limit


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
    contradicted: Array | None = None
    """(n_found,) rad, the most that any two halves are apart, also such as are no judges of the
    whole; None where that was not asked."""
    told: int | None = None
    """Which of two axes serves although the other does not: `axis_told`."""

    @property
    def kept(self) -> AxesQuality | None:
        """What is told of these axes where they serve: as uncertain as any two halves say.

        One of two that is told alone has what halves say that move as far: others may lack its
        movement, for main movements are made one after another.
        """
        if self.quality is None or self.contradicted is None or self.told is not None:
            return self.quality
        return replace(self.quality, halves=np.fmax(self.quality.halves, self.contradicted))

    def doubtful(self, options: AxesSettings) -> bool:
        """Return whether anything speaks against these axes."""
        most = np.deg2rad(options.largest_disagreement)
        return bool(self.doubts or self.quality is None or self.quality.halves.max() > most)

    def often_told(self, options: AxesSettings) -> bool:
        """Return whether one of two axes is told by short movements, many and alike."""
        if self.told is None or self.quality is None:
            return False
        alike = np.rad2deg(self.quality.halves[self.told]) <= options.largest_disagreement
        return bool(alike and (self.quality.labels == self.told).sum() >= OFTEN)


def judged(
    view: JointView,
    samples: JointSamples,
    axes: Array,
    n_axes: int,
    find: Finder,
    search: Searcher,
    settings: ParameterizationSettings,
) -> MovementAxes:
    """Return how good axes from some phases are, and what speaks against them."""
    options = with_room(settings.axes, view.name)
    free = in_free_motion(n_axes, options)
    doubtful = 2 * np.deg2rad(options.largest_uncertainty)
    # a search in free motion takes seconds: once halves contradict each other that is that
    quality = assess_axes(samples, axes, find, doubtful if free else np.inf)
    if options.refine and options.method in BY_ORIENTATION:
        one = n_axes == 1
        readings = (
            np.array([other_reading(samples, axes[0])])
            if one
            else other_readings(samples, axes, view.neighbours.wide)
        )
        quality = replace(quality, readings=readings)
    nominal = nominal_axes(view.name, axes) if view.human else None
    if not free:
        # a hinge has but one axis, whatever it does; beside main movements there is free motion
        whole = view.samples if n_axes == 1 else samples
        coupled = coupling(whole, axes, quality.ranges, view.neighbours)
        quality = replace(quality, coupled=coupled)
    positions = view.samples.positions
    if free and (short := too_short(samples)):
        return MovementAxes(axes, quality, (short,))
    if len(axes) < n_axes:
        doubts = [f"only {len(axes)} of {n_axes} main movements is there"]
    else:
        if free:
            ranges, beyond = free_ranges(view, axes)
            quality = replace(quality, ranges=ranges, coupled=shared_rhythm(samples, axes))
            closest = max(CLOSEST, options.smallest_angle)
            options = replace(options, smallest_explained=0.0, smallest_angle=closest)
        doubts = reasons_to_doubt(quality, axes, nominal, positions, options)
        doubts += [beyond] if free and beyond else []
    if nominal is not None and n_axes == 1 and worse_than_body(axes[0], nominal[0], positions):
        doubts.append("the body frame's axis suits all the movement clearly better")
    pair = n_axes == 2 and not free
    told = axis_told(quality, axes, samples, view, options) if doubts and pair else None
    if doubts and told is None:
        return MovementAxes(axes, quality, tuple(doubts))
    quality, apart_by, alone = _contradicted(view, samples, axes, n_axes, quality, search, settings)
    if not doubts:
        doubts = reasons_to_doubt(quality, axes, nominal, positions, options)
    told = axis_told(quality, axes, samples, view, options) if doubts and pair else None
    if told is not None:
        # another axis told would speak for it; alone it is as uncertain as halves of the time say
        # that move as far, however few phases one has
        apart_as_far = np.where(np.arange(len(axes)) == told, alone, np.nan)
        quality = replace(quality, halves=np.fmax(quality.halves, apart_as_far))
        apart_by = np.fmax(apart_by, quality.halves)
        if axis_told(quality, axes, samples, view, options) != told:
            doubts.append(
                f"halves of the time put the axis that is told {np.rad2deg(alone[told]):.0f}° apart"
            )
            told = None
    remark = _remark(replace(quality, halves=apart_by), told, settings.axes)
    return MovementAxes(axes, quality, tuple(doubts), remark, apart_by, told)


def _contradicted(
    view: JointView,
    samples: JointSamples,
    axes: Array,
    n_axes: int,
    quality: AxesQuality,
    search: Searcher,
    settings: ParameterizationSettings,
) -> tuple[AxesQuality, Array, Array]:
    """Return the quality with what halves of the time contradict, and the most they do, (n,) rad.

    The most holds halves, too, that are not alike enough to judge the whole, if each moves about
    one axis at a time: walking about beside a calibration contradicts nothing. Last comes how far
    halves are apart that both move as far, however few phases one has; NaN where they do not.
    """
    halves = (half.samples for half in view_halves(view, settings))
    off, arcs, pure = contradiction(halves, axes, search)
    comparable = arcs >= COMPARABLE * quality.ranges
    as_far = np.where(comparable, off, np.nan)
    if n_axes > 1:  # main movements are made one after another: a half may lack one
        half = parted(len(view.samples.positions))
        shares = early_share(samples, quality.labels, len(axes), *half)
        comparable &= np.abs(shares - 0.5) <= 0.5 - LEAST_SHARE
    halves_apart = np.fmax(quality.halves, np.where(comparable, off, np.nan))
    options = settings.axes
    judges = arcs >= np.deg2rad(options.smallest_range)
    if not in_free_motion(n_axes, options):
        judges &= pure >= options.purest
    said = np.where(judges, off, 0.0)
    return replace(quality, halves=halves_apart), np.fmax(halves_apart, said), as_far


def with_room(options: AxesSettings, name: str) -> AxesSettings:
    """Return the limits for a joint of that name: where the body's axes tell less, wider ones."""
    most = min(room(name) * options.largest_uncertainty, MOST_UNCERTAIN)
    return replace(options, largest_uncertainty=most)


def _remark(quality: AxesQuality, told: int | None, options: AxesSettings) -> str:
    """Return how far halves contradict each other or how uncertain axes are; empty if hardly."""
    of = slice(None) if told is None else slice(told, told + 1)
    if np.rad2deg(quality.halves[of].max()) > options.largest_disagreement:
        return apart(quality.halves[of], quality.ranges[of])
    if np.rad2deg(quality.uncertainty[of].max()) > options.largest_uncertainty:
        return uncertain(quality, told)
    return ""
