"""What is known of a joint, and what a person should know about it."""

import numpy as np

from kinesphere.data import Array, Joint, Limb, Observability, PoseFlag
from kinesphere.geometry.centre_covariance import ROUNDING
from kinesphere.geometry.even_frames import even_frames
from kinesphere.geometry.in_words import in_millimetres
from kinesphere.geometry.range_of_motion import RANGE_SAMPLE, range_of_motion
from kinesphere.geometry.vectors import lengths
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.body_axes import unit
from kinesphere.skeleton.measured import MeasuredJoint
from kinesphere.skeleton.poses import Poses
from kinesphere.skeleton.settings import SkeletonSettings

VERDICT_NOISE = 5e-4
"""m, least noise the verdict on a centre reckons with: no recording is better than that."""

SAID = 0.5e-3
"""m, least way that anatomy has drawn a centre that a person is told of."""


def describe_joint(
    measured: MeasuredJoint, parent: Poses, child: Poses, body: Body, settings: SkeletonSettings
) -> Joint:
    """Return the joint with its residual, range of motion, covariance and observability.

    The residual is that of the frames in which the child's markers alone tell its pose: elsewhere
    the pose is put at the joint, and coming apart by nothing says nothing. NaN where that is so
    in all frames, as it is of limbs of two markers.
    """
    fit, model = measured.fit, measured.model
    assert body.centre is not None
    gap = lengths(parent.carry(fit.centre) - child.carry(body.centre))
    known = gap[np.isfinite(gap) & (child.flags == PoseFlag.MEASURED)]
    moved = range_of_motion(_relative(parent, child))
    verdict, note = verdict_on(measured, moved, settings)
    return Joint(
        name=model.name,
        parent=model.parent,
        child=model.child,
        centre_in_parent=fit.centre,
        centre_in_child=body.centre,
        residual=float(np.sqrt(np.mean(known**2))) if len(known) else np.nan,
        range_of_motion=moved,
        covariance=fit.covariance,
        observability=verdict,
        note=note,
    )


def _relative(parent: Poses, child: Poses) -> Array:
    """Return ``parent_from_child`` in frames spread over those that show both, (n, 3, 3)."""
    both = np.flatnonzero((parent.flags != PoseFlag.UNSEEN) & (child.flags != PoseFlag.UNSEEN))
    at = both[even_frames(len(both), RANGE_SAMPLE)]
    relative: Array = np.swapaxes(parent.rotations[at], 1, 2) @ child.rotations[at]
    return relative


def verdict_on(
    measured: MeasuredJoint, moved: float, settings: SkeletonSettings
) -> tuple[Observability, str]:
    """Return how well the motion tells a centre, and the note that says so to a person.

    Parameters
    ----------
    moved
        rad, range of motion.
    """
    fit = measured.fit
    inflate = max(1.0, (VERDICT_NOISE / max(fit.noise, 1e-9)) ** 2)
    variances, directions = np.linalg.eigh(fit.data_covariance)
    # beside what is open, nothing but rounding
    variances = np.where(variances < ROUNDING * variances[-1], 0.0, variances)
    by_motion = inflate * variances
    # a centre held where it is expected is off by what that is off, whatever the motion would tell
    deviations = np.sqrt(np.maximum(by_motion, np.linalg.eigvalsh(fit.covariance)))
    # open: worse known than is useful, or known better from the expectation than from the motion
    astray = _times_the_expectation(np.sqrt(variances) * directions, fit.prior)
    weak = max(int((deviations > settings.undetermined_mm * 1e-3).sum()), int((astray > 1).sum()))
    degrees = np.rad2deg(moved)
    placed = f"placed by expectation ({measured.source})"
    if moved < np.deg2rad(settings.min_range_deg) or weak > 1:
        if measured.drawn_away:
            placed = f"{in_millimetres(measured.off)} from where it is expected ({measured.source})"
        return "undetermined", f"range of motion {degrees:.0f}°, centre undetermined, {placed}"
    if weak == 1:
        return "hinge", (
            f"range of motion {degrees:.0f}°, centre open along one axis "
            f"(± {in_millimetres(np.sqrt(np.linalg.eigvalsh(fit.covariance)[-1]))}), there {placed}"
        )
    note = f"range of motion {degrees:.0f}°"
    if measured.drawn >= SAID:
        drawn = f"drawn {in_millimetres(measured.drawn)} towards where it is expected"
        note = f"{note}, {drawn} ({measured.source})"
    return "determined", note


def _times_the_expectation(roots: Array, prior: Array) -> Array:
    """Return how many standard deviations of an expectation others are, (3,).

    By singular values of roots, of which rounding leaves far more than of eigenvalues of their
    squares: an open direction is 10⁹ times another one where there is no noise.

    Parameters
    ----------
    roots : (3, 3) m
        Deviations along their directions, in the columns.
    prior : (3, 3) 1/m²
        Precision of the expectation.
    """
    precisions, directions = np.linalg.eigh(prior)
    times: Array = np.linalg.svd(
        (np.sqrt(np.maximum(precisions, 0.0)) * directions).T @ roots, compute_uv=False
    )
    return times


def describe_limb(body: Body, joints: dict[str, MeasuredJoint]) -> Limb:
    """Return the limb with its markers, and its length and long axis from joint to far end.

    The far end is the next joint; the middle of the next joints where there are several, the neck
    of a trunk that has one; the farthest marker where there is none. Of a root it goes from the
    middle of the joints below to the joint above, in the sense of ``body.up``.
    """
    ends = {
        joint.model.child: joint.fit.centre
        for joint in joints.values()
        if joint.model.parent == body.name
    }
    if body.centre is None:
        up = np.array([0.0, 1.0, 0.0]) if body.up is None else body.up
        above = [c for name, c in ends.items() if name in ("trunk", "head")]
        below = [
            c for name, c in ends.items() if name not in ("trunk", "head") and "arm" not in name
        ]
        if above and below:
            span = np.mean(above, axis=0) - np.mean(below, axis=0)
            return _limb(body, float(np.linalg.norm(span)), unit(span))
        return _limb(body, np.nan, up)
    if "head" in ends:
        far = ends["head"]
    elif ends:
        far = np.mean(list(ends.values()), axis=0)
    else:
        arms = body.shape - body.centre
        far = body.shape[int(np.nan_to_num(np.linalg.norm(arms, axis=1), nan=-1.0).argmax())]
    span = far - body.centre
    length = float(np.linalg.norm(span))
    return _limb(body, length, unit(span) if length > 1e-9 else np.array([0.0, 1.0, 0.0]))


def _limb(body: Body, length: float, long_axis: Array) -> Limb:
    return Limb(body.name, body.parent, body.labels, body.shape, length, long_axis)
