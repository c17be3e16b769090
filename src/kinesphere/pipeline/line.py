"""The straight line: a recording goes in, joint parameters come out."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from kinesphere import __version__
from kinesphere.data import Recording, Skeleton, Solution, Step, TopologicalModel
from kinesphere.errors import BadRecording
from kinesphere.labelling import coverage, label, match_labels
from kinesphere.normalization import Facing, normalize
from kinesphere.parameterization import parameterize
from kinesphere.pipeline.choice import model_for
from kinesphere.pipeline.doubts import calibration_doubts, with_checks
from kinesphere.pipeline.settings import Settings
from kinesphere.quality import orient
from kinesphere.skeleton import fit_skeleton

Progress: TypeAlias = Callable[[str, int, int], None]
"""Called with the stage about to run, its number from 0, and how many there are."""

STAGES = ("labelling", "orientation", "skeleton", "normalization", "parameterization")


def solve(
    recording: Recording,
    model: TopologicalModel | str | None = None,
    *,
    subject: str | None = None,
    calibration: tuple[float, float] | None = None,
    calibration_from: Solution | Skeleton | None = None,
    facing: Facing | None = None,
    settings: Settings | None = None,
    progress: Progress | None = None,
) -> Solution:
    """Run the whole line on one person of one recording.

    Parameters
    ----------
    recording
        As read: in the axes of its file.
    model
        Which marker sits on which limb; where no point bears one of its labels, they are given
        first. Or the name of a built-in one; None to choose the built-in
        one that the recording covers, if any; ``"none"`` for motion alone.
    subject
        The label prefix of the person, where the recording holds several.
    calibration
        (start, end) in s since the first stored frame: where the main movements are performed.
    calibration_from
        Another recording of the same person, whose axes and rest positions are used again.
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
        If no model fits, or the one that was asked for does not.
    DegenerateMotion, AmbiguousFacing
        If the motion does not determine what a stage needs.
    """
    settings = Settings() if settings is None else settings
    if recording.n_frames == 0 or not recording.seen.any():
        raise BadRecording("the recording holds no marker position: nothing to solve")
    clock = _Clock(progress)
    with clock.stage("labelling"):
        chosen = model_for(recording, model, subject)
        if subject is None and not coverage(recording, chosen):
            recording = label(recording, chosen, settings.labelling)
            if recording.confidence is None or np.isnan(recording.confidence).all():
                raise BadRecording(
                    f"no point has a label of model {chosen.name}, and none could be given: "
                    + "; ".join(recording.history[-1].warnings)
                )
        labelled = match_labels(recording, chosen, subject)
    with clock.stage("orientation"):
        oriented = with_checks(orient(labelled, chosen, settings.orientation))
    with clock.stage("skeleton"):
        fitted = fit_skeleton(oriented, chosen, settings.skeleton)
    with clock.stage("normalization"):
        motion = normalize(fitted, settings.normalization, facing)
    with clock.stage("parameterization"):
        reuse = _skeleton(calibration_from)
        if doubts := calibration_doubts(motion, calibration, reuse):
            step = Step("calibration", warnings=doubts, version=__version__)
            motion = replace(motion, history=(*motion.history, step))
        parameters = parameterize(
            motion, settings.parameterization, calibration=calibration, reuse=reuse
        )
    return Solution(
        recording=oriented,
        motion=motion,
        parameters=parameters,
        model_name=chosen.name,
        seconds=clock.seconds,
    )


def _skeleton(source: Solution | Skeleton | None) -> Skeleton | None:
    return source.skeleton if isinstance(source, Solution) else source


class _Clock:
    """Tells of stages and keeps how long each took."""

    def __init__(self, progress: Progress | None) -> None:
        self.progress = progress
        self.seconds: dict[str, float] = {}

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        if self.progress is not None:
            self.progress(name, STAGES.index(name), len(STAGES))
        start = time.perf_counter()
        yield
        self.seconds[name] = time.perf_counter() - start
