"""Poses into joint parameters: axes, rest positions, angles and twist of every joint (paper 4)."""

from dataclasses import replace

import numpy as np

from kinesphere import __version__
from kinesphere.data import (
    Joint,
    Json,
    Motion,
    Parameters,
    Skeleton,
    Step,
    given_away,
)
from kinesphere.geometry.chain import joint_rotations
from kinesphere.geometry.poses import relative_rotations
from kinesphere.parameterization.anatomy import human_plan
from kinesphere.parameterization.angles import unwrapped
from kinesphere.parameterization.calibration_windows import windows_beyond, windows_of
from kinesphere.parameterization.coupling import neighbours_of
from kinesphere.parameterization.joint_angles import solve_joint
from kinesphere.parameterization.joint_fit import JointFit
from kinesphere.parameterization.joint_flags import flags_of, twists_known
from kinesphere.parameterization.measures import (
    lever,
    mid_point_residuals,
    paper_measures,
)
from kinesphere.parameterization.reach_report import reach_warnings
from kinesphere.parameterization.report import (
    Told,
    result_findings,
    stage_warnings,
    told,
)
from kinesphere.parameterization.reused import not_reused, own_or_reused
from kinesphere.parameterization.settings import (
    ParameterizationSettings,
)
from kinesphere.parameterization.view import reliable_frames, view_joint


def parameterize(
    motion: Motion,
    settings: ParameterizationSettings | None = None,
    calibration: tuple[float, float] | None = None,
    reuse: Skeleton | None = None,
    *,
    give_way: bool = False,
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
    give_way
        Whether those that are doubtful, or plainly wrong for this motion, give way to its own
        (`kinesphere.parameterization.giving_way`); else that is only said.

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
    windows = windows_of(motion, calibration, settings.axes)
    skeleton = motion.skeleton
    n, n_joints = motion.n_frames, len(skeleton.joints)
    angles = np.full((n, n_joints, 3), np.nan)
    twists, residuals = np.full((n, n_joints), np.nan), np.full((n, n_joints), np.nan)
    flags = np.zeros((n, n_joints), dtype=np.uint8)
    moving = np.zeros((n, n_joints), dtype=bool)
    human = human_plan(skeleton)
    known = twists_known(motion.flags)
    # a twist nobody knows is taken out of the poses, outward
    world = motion.rotations if known.all() else np.array(motion.rotations)
    joints: list[Joint] = []
    findings: dict[str, Json] = {}
    seen: dict[str, Told] = {}
    fits: dict[str, JointFit] = {}
    neighbours = neighbours_of(motion)
    for j, joint in enumerate(skeleton.joints):
        limb, parent = skeleton.limbs[j + 1], skeleton.parents[j + 1]
        rotations = relative_rotations(world[:, parent], world[:, j + 1])
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
            neighbours=neighbours[j],
        )
        fit = own_or_reused(view, reuse, settings, give_way=give_way)
        solved = solve_joint(view, fit.axes, fit.rest, settings)
        rebuilt = joint_rotations(fit.axes, fit.rest, limb.long_axis, solved.angles, solved.twists)
        mid_point = lever(joint.centre_in_child, limb.length, limb.long_axis)
        angles[:, j], twists[:, j] = solved.angles, solved.twists
        residuals[:, j] = mid_point_residuals(rotations, rebuilt, mid_point)
        moving[:, j] = view.movement.moving
        flags[:, j] = flags_of(motion, j, solved, fit, twist_known, settings)
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
                axes_reused_from=fit.reused_from,
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
    warnings = stage_warnings(seen, fits, settings.axes.method, reuse=reuse is not None)
    warnings += reach_warnings(fits, findings, settings.angles.unreachable)
    own = [name for name, fit in fits.items() if fit.source != "reused"]
    warnings += not_reused([name for name in own if not fits[name].gave_way], reuse)
    if (
        reuse is not None
        and len(own) < len(fits)
        and (settings.axes.windows or settings.axes.counts)
    ):
        warnings += ("axes.windows and axes.counts say nothing about axes that are reused",)
    warnings += windows_beyond(motion, settings.axes)
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
