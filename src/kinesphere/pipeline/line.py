"""The straight line: a recording goes in, joint parameters come out."""

from dataclasses import replace

from kinesphere.data import Recording, Solution, TopologicalModel
from kinesphere.errors import BadRecording
from kinesphere.io.own_points import without_own_points
from kinesphere.labelling import match_labels
from kinesphere.normalization import Facing, normalize
from kinesphere.pipeline.choice import MOTION_ALONE, model_for, with_labels
from kinesphere.pipeline.clock import Clock, Progress
from kinesphere.pipeline.doubts import with_checks
from kinesphere.pipeline.motion_alone import discovered, normalized_somehow
from kinesphere.pipeline.reuse import Sources, calibrated, check_reuse, parameterized
from kinesphere.pipeline.settings import Settings
from kinesphere.pipeline.surface import body_for, surface_for
from kinesphere.quality import orient
from kinesphere.skeleton import fill_markers, fit_skeleton

STAGES = ("labelling", "orientation", "skeleton", "normalization", "parameterization", "surface")
"""In this order; from motion alone the first one is ``discovery`` instead."""


def solve(
    recording: Recording,
    model: TopologicalModel | str | None = None,
    *,
    subject: str | None = None,
    calibration: tuple[float, float] | None = None,
    calibration_from: Sources = None,
    facing: Facing | None = None,
    settings: Settings | None = None,
    progress: Progress | None = None,
) -> Solution:
    """Run the whole line on one person of one recording.

    Parameters
    ----------
    recording
        As read: in the axes of its file. Joint centres that an earlier solution put into it are
        left out.
    model
        Which marker sits on which limb; where no point bears one of its labels, they are given
        first. Or the name of a built-in one; None to choose the built-in one that the recording
        covers, if any; ``"none"`` for motion alone, as it is where none fits.
    subject
        The label prefix of the person, where the recording holds several.
    calibration
        (start, end) in s since the first stored frame: where the main movements are performed.
    calibration_from
        Another recording of the same person, whose axes and rest positions are used again; of
        several, for each joint the axes that are known best. By name, or named as their files. Axes
        that are doubtful there, or plainly wrong here, give way to better ones of the recording.
    facing
        The axis of the world a person looks along in the default position, where the motion does
        not tell.
    settings
        Of every stage; the defaults, if None.
    progress
        Told of each stage before it runs.

    Raises
    ------
    BadRecording
        If there is nothing to solve.
    BadModel
        If the model that was asked for does not fit.
    DegenerateMotion, AmbiguousFacing
        If the motion does not determine what a stage needs.
    BadSetting
        If ``calibration_from`` is given although the body's axes are asked for.
    """
    settings = Settings() if settings is None else settings
    recording = without_own_points(recording)
    if recording.n_frames == 0 or not recording.seen.any():
        raise BadRecording("the recording holds no marker position: nothing to solve")
    check_reuse(settings.parameterization, calibration_from)
    clock = Clock(progress, len(STAGES))
    body = body_for(settings.surface)  # first, so that a file that cannot be used costs no wait
    unit = None
    given = model_for(recording, model, subject)
    with clock.stage("discovery" if given is None else "labelling"):
        if given is None:
            labelled, chosen, unit = discovered(
                recording,
                subject,
                settings.discovery,
                settings.skeleton,
                settings.orientation,
                asked=model == MOTION_ALONE,
            )
        else:
            recording = with_labels(recording, given, subject, settings.labelling)
            labelled, chosen = match_labels(recording, given, subject), given
    with clock.stage("orientation"):
        oriented = with_checks(orient(labelled, chosen, settings.orientation), unit)
    with clock.stage("skeleton"):
        # markers that were found loose are not to be taken in again
        measured = settings.skeleton if given else replace(settings.skeleton, adopt_markers=False)
        motion = fit_skeleton(oriented, chosen, measured, unit=unit)
        if settings.skeleton.fill_markers:
            oriented = fill_markers(oriented, motion)
            motion = replace(motion, history=(*motion.history, oriented.history[-1]))
    with clock.stage("normalization"):
        aligned = normalize if given else normalized_somehow
        motion = aligned(motion, settings.normalization, facing)
    with clock.stage("parameterization"):
        parameters = parameterized(
            motion, settings.parameterization, calibration, calibrated(calibration_from)
        )
    with clock.stage("surface"):
        surface, step = surface_for(motion, settings.surface, body)
        parameters = replace(parameters, history=(*parameters.history, step))
    return Solution(
        recording=oriented,
        motion=motion,
        parameters=parameters,
        model_name=chosen.name,
        seconds=clock.seconds,
        surface=surface,
    )
