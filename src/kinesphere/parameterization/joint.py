"""One joint: its movement, its axes, its rest orientation, and whether they can be trusted."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Array, AxesSource, Json
from kinesphere.parameterization.anatomy import (
    body_axes,
    declared_n_axes,
    joint_kind,
    substitute_axes,
)
from kinesphere.parameterization.axes.fit import moving_positions
from kinesphere.parameterization.axis_figures import (
    free_findings,
    nearest_places,
    quality_findings,
    with_places,
)
from kinesphere.parameterization.confidence import AxesQuality, observed_n_axes
from kinesphere.parameterization.doubts import uncertain_in_free_motion
from kinesphere.parameterization.free_hinge import FreeHinge, hinge_worth_having
from kinesphere.parameterization.joint_angles import larger_excursion_positive
from kinesphere.parameterization.joint_fit import JointFit, angles_between, or_null
from kinesphere.parameterization.judged_axes import MovementAxes
from kinesphere.parameterization.movement_axes import movement_axes
from kinesphere.parameterization.one_of_two import completed
from kinesphere.parameterization.per_joint import parse_counts
from kinesphere.parameterization.second_axis import cone_spread, second_axis
from kinesphere.parameterization.settings import (
    AxesSettings,
    ParameterizationSettings,
)
from kinesphere.parameterization.view import JointView
from kinesphere.parameterization.zero import (
    OUT_OF_REACH,
    aligned_rest,
    body_rest,
    movement_rest,
    reach_and_twist,
)


def fit_joint(
    view: JointView, settings: ParameterizationSettings, n_axes: int | None = None
) -> JointFit:
    """Find the axes that move a limb, and the rest orientation of its joint.

    Parameters
    ----------
    view
        The joint; a known name declares how many axes it has and their signs.
    settings
        Methods and limits.
    n_axes
        How many axes are looked for, whatever name and settings say.

    Returns
    -------
    JointFit
        Never an exception for want of movement: then the axes are the body's, and a warning says
        why.
    """
    options = settings.axes
    if view.calibration.any() and view.twist_known[view.calibration].mean() < 0.5:
        options = replace(options, method="small-circle")  # orientations tell nothing here
        settings = replace(settings, axes=options)
    observed = observed_n_axes(view.samples)
    declared = declared_n_axes(view.name, parse_counts(options.counts))
    n_axes = n_axes or declared or observed or 2
    keep = options.on_doubt == "movement"
    if n_axes == 1 and options.method == "universal-joint":
        options = replace(options, method="phase-log-pca")  # that method is for two axes
        settings = replace(settings, axes=options)

    found = movement_axes(view, n_axes, settings)
    axes, quality, doubts = found.axes, found.quality, list(found.doubts)
    free = hinge_worth_having(view, options) if doubts and n_axes == 1 else None
    source: AxesSource = "movement"
    assumed: tuple[bool, ...] = ()
    loose = ""
    one = _one_and_across(view, found, settings) if doubts and not keep else None
    if free is not None:
        axes, rest, _ = movement_rest(view, free.axis[None], _height(view, free.axis), settings)
        uncertainty = np.array([free.uncertainty])
        # what speaks against the axis of main movements says nothing of this one
        doubts = [uncertain_in_free_motion(free.uncertainty, free.reading, free.coupled)]
    elif one is not None:
        axes, rest, quality = one
        uncertainty, loose = quality.uncertainty, found.remark
        assumed = tuple(bool(np.isnan(u)) for u in uncertainty)
    elif quality is not None and len(axes) == n_axes and (not doubts or keep):
        axes, rest, order = movement_rest(view, axes, quality.heights, settings)
        quality = (found.kept or quality).ordered(order)
        uncertainty = quality.uncertainty
        if n_axes > 1:
            share, _ = reach_and_twist(view, axes, rest, settings)
            if share > OUT_OF_REACH:
                doubts.append(f"the limb is out of these axes' reach in {share:.0%} of the frames")
        if not doubts:
            loose = found.remark
    served = free is not None or one is not None
    places = list(range(n_axes))  # of the axes that figures are told of, among those that serve
    if not served and (len(axes) < n_axes or (doubts and not keep)):
        source = "body"
        axes = substitute_axes(view.name, n_axes, view.gravity)[::-1]
        rest = body_rest(view, axes, settings)
        uncertainty = np.full(n_axes, np.nan)
        places = nearest_places(found.axes, axes)
    added = ""
    if n_axes == 1 and asked_n_axes(view.name, options) is None:
        spread = np.rad2deg(cone_spread(view.samples.positions, axes[0]))
        if spread > options.largest_spread and (side := body_axes(view.name)) is not None:
            across = second_axis(axes[0], rest @ view.long_axis, side[1])
            axes, uncertainty = np.array([across, axes[0]]), np.array([np.nan, uncertainty[0]])
            places = [place + 1 for place in places]
            added = f"{spread:.0f}°"
            assumed = (True, False) if source == "movement" else ()
    if joint_kind(view.name) is None:
        axes = larger_excursion_positive(view, axes, rest, settings)
    findings: dict[str, Json] = {
        "n_axes": len(axes),
        "n_axes_by_data": observed,
        "axes_method": options.method,
        "axes_source": source,
        "doubts": [*doubts, loose] if loose else list(doubts),
        "remark": loose or None,
        "phases_s": [list(span) for span in view.samples.phase_times],
        "reliable_s": float(view.calibration.sum() / view.samples.rate),
        "axes_uncertainty_deg": or_null(np.rad2deg(uncertainty)),
        "axes_apart_deg": angles_between(axes),
        **with_places(
            quality_findings(quality) if free is None else free_findings(free), places, len(axes)
        ),
    }
    if source == "movement" and n_axes == 1 and (reading := _reading(quality, free)) > 0:
        findings["other_reading_deg"] = float(np.rad2deg(reading))
    kept = ""
    if free is not None:
        left, body_left = np.rad2deg(free.error), np.rad2deg(free.body_error)
        findings |= {"held_out_deg": left, "held_out_body_deg": body_left}
        findings["main_movement_doubts"] = list(found.doubts)
        kept = f"{left:.1f}° instead of {body_left:.1f}°"
    return JointFit(
        axes,
        rest,
        source,
        uncertainty,
        findings,
        tuple(doubts),
        kept=kept,
        added=added,
        assumed=assumed,
        half_told=one is not None,
        loose=loose,
    )


def _one_and_across(
    view: JointView, found: MovementAxes, settings: ParameterizationSettings
) -> tuple[Array, Array, AxesQuality] | None:
    """Return the one axis that is told of two, the other across it, rest, and what is known.

    None where not exactly one is told, or where the limb cannot be followed about the two.
    """
    kept = found.kept
    if found.told is None or kept is None:
        return None
    axes, at = completed(found.axes[found.told], view.name, view.gravity)
    rest = aligned_rest(view, axes)
    share, _ = reach_and_twist(view, axes, rest, settings)
    return None if share > OUT_OF_REACH else (axes, rest, kept.only(found.told, at))


def asked_n_axes(name: str, options: AxesSettings) -> int | None:
    """Return how many axes the user said a joint has; None where nobody did."""
    counts = parse_counts(options.counts)
    return counts.get(name, counts.get(joint_kind(name) or name))


def _reading(quality: AxesQuality | None, free: FreeHinge | None) -> float:
    """Return how far the axis that serves is off if its limb twists with the angle, rad."""
    if free is not None:
        return free.reading
    return 0.0 if quality is None else float(quality.readings[0])


def _height(view: JointView, axis: Array) -> Array:
    """Return the cosine of the cone on which a hinge moves, (1,)."""
    moving = moving_positions(view.samples)
    return np.array([float(np.median(moving @ axis))])
