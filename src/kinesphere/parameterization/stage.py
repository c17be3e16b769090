"""Poses into joint parameters: axes, rest positions, angles and twist of every joint (paper 4)."""

from dataclasses import replace

import numpy as np

from kinesphere import __version__
from kinesphere.data import (
    Codes,
    Joint,
    JointFlag,
    Json,
    Mask,
    Motion,
    Parameters,
    PoseFlag,
    Skeleton,
    Step,
    given_away,
)
from kinesphere.errors import BadSetting
from kinesphere.geometry.chain import joint_rotations
from kinesphere.geometry.vectors import lengths
from kinesphere.parameterization.anatomy import human_plan, without_side
from kinesphere.parameterization.angles import JointAngles, unwrapped
from kinesphere.parameterization.joint import solve_joint
from kinesphere.parameterization.joint_fit import JointFit
from kinesphere.parameterization.measures import (
    lever,
    mid_point_residuals,
    paper_measures,
)
from kinesphere.parameterization.per_joint import parse_counts, parse_windows
from kinesphere.parameterization.report import (
    Told,
    reach_warnings,
    result_findings,
    stage_warnings,
    told,
)
from kinesphere.parameterization.reused import misfit, own_or_reused
from kinesphere.parameterization.settings import (
    AxesSettings,
    ParameterizationSettings,
)
from kinesphere.parameterization.view import frames_within, reliable_frames, view_joint

TORN = 0.02  # m, joints closer together than this are never called dislocated
OUTLYING = 6.0  # robust standard deviations
LEAP = np.pi / 2  # rad between frames; the other branch is about half a turn of twist away


def parameterize(
    motion: Motion,
    settings: ParameterizationSettings | None = None,
    calibration: tuple[float, float] | None = None,
    reuse: Skeleton | None = None,
) -> Parameters:
    """Describe a normalized motion by angles about the axes the person moves around.

    Sar Dessai, Hornung & Kobbelt 2006, section 4.

    Parameters
    ----------
    motion
        With normalized limb frames.
    settings
        Methods and limits of every step; the defaults if None.
    calibration
        Start and end in s since the first stored frame: axes and rest positions are taken from
        there. None takes the whole motion.
    reuse
        A parameterized skeleton of the same person; joints of the same name take its axes and rest
        orientations.

    Returns
    -------
    kinesphere.data.Parameters
        Its skeleton's joints carry axes and rest orientations. Joints whose movement does not tell
        their axes have those of the body frame and say so (``axes_source``, warnings).

    Raises
    ------
    BadSetting
        If a calibration window holds no frame, or is given for a joint that is not there.
    """
    settings = settings or ParameterizationSettings()
    windows = _windows(motion, calibration, settings.axes)
    skeleton = motion.skeleton
    n, n_joints = motion.n_frames, len(skeleton.joints)
    angles = np.full((n, n_joints, 3), np.nan)
    twists, residuals = np.full((n, n_joints), np.nan), np.full((n, n_joints), np.nan)
    flags = np.zeros((n, n_joints), dtype=np.uint8)
    moving = np.zeros((n, n_joints), dtype=bool)
    human = human_plan(skeleton)
    known = motion.flags != PoseFlag.TWIST_UNKNOWN
    # a twist nobody knows is taken out of the poses, outward
    world = motion.rotations if known.all() else np.array(motion.rotations)
    joints: list[Joint] = []
    findings: dict[str, Json] = {}
    seen: dict[str, Told] = {}
    fits: dict[str, JointFit] = {}
    for j, joint in enumerate(skeleton.joints):
        limb, parent = skeleton.limbs[j + 1], skeleton.parents[j + 1]
        rotations = np.swapaxes(world[:, parent], -1, -2) @ world[:, j + 1]
        twist_known = known[:, j + 1]
        view = view_joint(
            joint.name,
            rotations,
            limb.long_axis,
            twist_known,
            motion.rate,
            reliable_frames(motion.flags[:, [parent, j + 1]], windows[j]),
            settings,
            human,
        )
        fit = own_or_reused(view, reuse, settings)
        solved = solve_joint(view, fit.axes, fit.rest, settings)
        if fit.source == "reused":
            fit = replace(fit, misfit=misfit(view, solved, settings))
        rebuilt = joint_rotations(fit.axes, fit.rest, limb.long_axis, solved.angles, solved.twists)
        mid_point = lever(joint.centre_in_child, limb.length, limb.long_axis)
        angles[:, j], twists[:, j] = solved.angles, solved.twists
        residuals[:, j] = mid_point_residuals(rotations, rebuilt, mid_point)
        moving[:, j] = view.movement.moving
        flags[:, j] = _flags(motion, j, solved, fit, settings)
        unknown = np.flatnonzero(~twist_known & np.isfinite(rebuilt[:, 0, 0]))
        if len(unknown):
            world[unknown, j + 1] = world[unknown, parent] @ rebuilt[unknown]
        joints.append(
            replace(
                joint,
                axes=fit.axes,
                rest=fit.rest,
                axes_source=fit.source,
                axes_assumed=fit.assumed,
                axes_uncertainty=fit.uncertainty,
            )
        )
        seen[joint.name], fits[joint.name] = told(view), fit
        findings[joint.name] = {
            **fit.findings,
            "axes_sources": list(fit.sources),
            "moving_s": float(view.movement.moving.sum() / motion.rate),
            "threshold_deg_s": float(np.rad2deg(view.movement.threshold)),
            "threshold_from_valley": view.movement.valley,
            **result_findings(residuals[:, j], twists[:, j], flags[:, j]),
            **paper_measures(rotations, rebuilt, limb.long_axis, mid_point),
        }
    if settings.angles.unwrap:
        angles, twists = unwrapped(angles), unwrapped(twists)
    warnings = stage_warnings(seen, fits, settings.axes.method)
    warnings += reach_warnings(fits, findings, settings.angles.unreachable)
    own = [name for name, fit in fits.items() if fit.source != "reused"]
    if reuse is not None and own:
        warnings += (
            f"the solution to be reused measured no axes of {', '.join(own)}; theirs are from here",
        )
    if (
        reuse is not None
        and len(own) < len(fits)
        and (settings.axes.windows or settings.axes.counts)
    ):
        warnings += ("axes.windows and axes.counts say nothing about axes that are reused",)
    warnings += _windows_beyond(motion, settings.axes)
    step = Step(
        "parameterization",
        {
            **settings.as_json(),
            "calibration_s": None if calibration is None else list(calibration),
            "reuse": reuse is not None,
        },
        {"joints": findings},
        warnings,
        __version__,
    )
    return Parameters(
        skeleton=replace(skeleton, joints=tuple(joints), history=(*motion.history, step)),
        root_positions=motion.origins[:, 0],
        root_rotations=motion.rotations[:, 0],
        angles=given_away(angles),
        twists=given_away(twists),
        residuals=given_away(residuals),
        flags=given_away(flags),
        moving=given_away(moving),
        rate=motion.rate,
        first_frame=motion.first_frame,
        history=(*motion.history, step),
    )


def _windows(
    motion: Motion, calibration: tuple[float, float] | None, axes: AxesSettings
) -> list[Mask]:
    """Return which frames each joint's axes and rest come from, masks (n_frames,)."""
    own = parse_windows(axes.windows)
    joints = motion.skeleton.joint_names
    kinds = {name: without_side(name) for name in joints}
    for setting, names in (("windows", own), ("counts", parse_counts(axes.counts))):
        if strange := [name for name in names if name not in {*joints, *kinds.values()}]:
            raise BadSetting(
                f"{setting} names {', '.join(strange)}; the joints are {', '.join(joints)}"
            )
    masks = []
    for name in joints:
        key = name if name in own else kinds[name]
        said = f"axes.windows gives {key}" if key in own else "calibration is"
        masks.append(_window(motion, own.get(key, calibration), said))
    return masks


def _windows_beyond(motion: Motion, axes: AxesSettings) -> tuple[str, ...]:
    """Return a warning for each joint whose own window reaches beyond the recording."""
    length = motion.n_frames / motion.rate
    return tuple(
        f"the window of {name}, {start:g}:{end:g} s, reaches beyond the recording, which lasts "
        f"{length:.2f} s; what there is of it was used"
        for name, (start, end) in parse_windows(axes.windows).items()
        if end > length
    )


def _window(motion: Motion, calibration: tuple[float, float] | None, said: str) -> Mask:
    """Return which frames lie in a calibration window, (n_frames,), that somebody ``said``."""
    if calibration is None:
        return np.ones(motion.n_frames, dtype=bool)
    start, end = calibration
    window = frames_within(motion.n_frames, motion.rate, calibration)
    if not window.any():
        last = motion.times[-1] if motion.n_frames else 0.0
        raise BadSetting(f"{said} {start:g}–{end:g} s; the recording runs from 0 to {last:.2f} s")
    return window


def _flags(
    motion: Motion,
    j: int,
    solved: JointAngles,
    fit: JointFit,
    settings: ParameterizationSettings,
) -> Codes:
    """Return the JointFlags of joint ``j``, (n_frames,) uint8."""
    limbs = [int(motion.skeleton.parents[j + 1]), j + 1]
    unseen = np.isnan(solved.angles[:, len(fit.axes) - 1])
    flags = np.where(unseen, JointFlag.UNSEEN, 0)
    with np.errstate(invalid="ignore"):
        far = solved.excess > np.deg2rad(settings.angles.unreachable)
        edge = solved.sines < np.sin(np.deg2rad(settings.angles.singular))
    flags |= np.where(far, JointFlag.UNREACHABLE, 0)
    if len(fit.axes) > 1:
        flags |= np.where(edge | leaps(solved), JointFlag.SINGULAR, 0)
    pose = motion.flags[:, limbs]
    flags |= np.where(~unseen & (pose[:, 1] == PoseFlag.TWIST_UNKNOWN), JointFlag.TWIST_UNKNOWN, 0)
    flags |= np.where(~unseen & (pose == PoseFlag.FILLED).any(axis=1), JointFlag.FILLED, 0)
    flags |= np.where(_torn(motion, j), JointFlag.DISLOCATED, 0)
    return flags.astype(np.uint8)


def leaps(solved: JointAngles) -> Mask:
    """Return the frames on both sides of a leap of an angle, (n_frames,).

    Only near a singular pose can angles leap while the limb does not: the solution passes to its
    other branch, between two frames if the motion is fast.
    """
    angles = np.column_stack([solved.angles, solved.twists])
    with np.errstate(invalid="ignore"):
        turned = np.abs((np.diff(angles, axis=0) + np.pi) % (2 * np.pi) - np.pi)
        leap = (turned > LEAP).any(axis=1)
    beside: Mask = np.zeros(len(angles), dtype=bool)
    beside[:-1] |= leap
    beside[1:] |= leap
    return beside


def _torn(motion: Motion, j: int) -> Mask:
    """Return where parent and child disagree about the joint far more than usual, (n_frames,)."""
    joint, parent = motion.skeleton.joints[j], motion.skeleton.parents[j + 1]
    by_parent = motion.rotations[:, parent] @ joint.centre_in_parent + motion.origins[:, parent]
    by_child = motion.rotations[:, j + 1] @ joint.centre_in_child + motion.origins[:, j + 1]
    apart = lengths(by_parent - by_child)
    known: Mask = np.isfinite(apart)
    if not known.any():
        return known
    usual = float(np.median(apart[known]))
    spread = 1.4826 * float(np.median(np.abs(apart[known] - usual)))
    with np.errstate(invalid="ignore"):
        return np.asarray(apart > usual + max(OUTLYING * spread, TORN))
