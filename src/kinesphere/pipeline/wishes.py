"""What a user asks of the stages after the tracker: checked before, left out where it fails."""

from collections.abc import Sequence
from dataclasses import replace
from typing import get_args

from kinesphere import __version__
from kinesphere.data import Motion, Parameters, Scene, Step
from kinesphere.errors import AmbiguousFacing, BadSetting, DegenerateMotion, KinesphereError
from kinesphere.normalization import Facing, NormalizationSettings
from kinesphere.parameterization import ParameterizationSettings
from kinesphere.pipeline.best_axes import Calibrated
from kinesphere.pipeline.motion_alone import normalized_somehow
from kinesphere.pipeline.reuse import parameterized


def check_wishes(
    scene: Scene, calibration: tuple[float, float] | None, facing: Facing | None
) -> None:
    """Raise BadSetting for what can be told to be impossible before hours of tracking."""
    if facing is not None and facing not in get_args(Facing):
        raise BadSetting(f"facing is {facing!r}; known are {', '.join(get_args(Facing))}")
    last = (scene.n_frames - 1) / scene.rate
    if calibration is not None and calibration[0] > last:
        start, end = calibration
        raise BadSetting(
            f"calibration is {start:g}–{end:g} s; the scene runs from 0 to {last:.2f} s"
        )


def normalized_at_any_rate(
    measured: Motion, settings: NormalizationSettings, facing: Facing | None
) -> Motion:
    """Normalize a motion as asked, or, where that cannot be, without the facing asked for."""
    try:
        return normalized_somehow(measured, settings, facing)
    except (AmbiguousFacing, DegenerateMotion) as error:
        if facing is None:
            raise
        step = _left_out(f"facing {facing}", error)
        measured = replace(measured, history=(*measured.history, step))
        return normalized_somehow(measured, settings, None)


def parameterized_at_any_rate(
    motion: Motion,
    settings: ParameterizationSettings,
    calibration: tuple[float, float] | None,
    others: Sequence[Calibrated],
) -> Parameters:
    """Parameterize a motion as asked, or, where that cannot be, about its own axes."""
    try:
        return parameterized(motion, settings, calibration, others)
    except KinesphereError as error:
        if calibration is None and not others:
            raise
        step = _left_out("the calibration", error)
        motion = replace(motion, history=(*motion.history, step))
        return parameterized(motion, settings, None, ())


def _left_out(what: str, error: Exception) -> Step:
    return Step("wishes", warnings=(f"{what} was left out: {error}",), version=__version__)
