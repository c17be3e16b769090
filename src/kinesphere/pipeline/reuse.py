"""Axes from other recordings of the same person, and what is said of them."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TypeAlias

from kinesphere import __version__
from kinesphere.data import Json, Motion, Parameters, Skeleton, Solution, Step
from kinesphere.errors import BadSetting
from kinesphere.parameterization import ParameterizationSettings, parameterize
from kinesphere.pipeline.best_axes import Calibrated, with_best_axes
from kinesphere.pipeline.carried_over import named_frames
from kinesphere.pipeline.doubts import calibration_doubts
from kinesphere.pipeline.numbered import as_numbered_in

Source: TypeAlias = Solution | Skeleton
"""Another recording of the same person, solved."""

Sources: TypeAlias = Source | Sequence[Source] | Mapping[str, Source] | None
"""One or several of them, with names or without."""


def calibrated(sources: Sources) -> tuple[Calibrated, ...]:
    """Return the skeletons of one solution or several, each with a name.

    Those that come without one are called as the file that was solved, or by their number.
    """
    if sources is None:
        return ()
    if isinstance(sources, Mapping):
        return tuple(Calibrated(name, _skeleton(source)) for name, source in sources.items())
    several = (sources,) if isinstance(sources, Solution | Skeleton) else sources
    files = [_file(source) for source in several]
    often = Counter(files)
    return tuple(
        Calibrated(file if file and often[file] == 1 else f"recording {i}", _skeleton(source))
        for i, (file, source) in enumerate(zip(files, several, strict=True), start=1)
    )


def check_reuse(settings: ParameterizationSettings, sources: Sources) -> None:
    """Raise BadSetting where the axes of other recordings and those of the body are both wanted."""
    if settings.axes.method == "body" and calibrated(sources):
        raise BadSetting(
            "axes.method is 'body', which takes no axes of another recording, yet one is given to "
            "take them from (--calibration-from); give one or the other"
        )


def parameterized(
    motion: Motion,
    settings: ParameterizationSettings,
    calibration: tuple[float, float] | None,
    others: Sequence[Calibrated],
) -> Parameters:
    """Return the joint parameters of a motion, about its own axes or those of other recordings.

    From where axes of others are, and what speaks against them or against the window, becomes a
    step of the history.

    Parameters
    ----------
    motion
        Normalized.
    settings
    calibration
        (start, end) in s since the first stored frame: where the main movements are performed.
    others
        As `calibrated` returns them; empty for the motion's own axes.

    Raises
    ------
    DegenerateMotion, BadSetting
        As `kinesphere.parameterization.parameterize` does.
    """
    others, numbered, unmatched = _as_numbered_in(motion.skeleton, others)
    doubts = calibration_doubts(motion, calibration, others) + unmatched
    found: dict[str, Json] = {}
    if calibration is not None and doubts:
        length = motion.n_frames / motion.rate
        start, end = calibration
        found = {"window_s": [start, end], "used_s": max(min(end, length) - max(start, 0.0), 0.0)}
    reuse = None
    if others:
        reuse, apart = with_best_axes(motion.skeleton, others, settings.axes)
        found |= {
            "recordings": [*sorted(other.name for other in others)],
        }
        if numbered:
            found["joints_by_markers"] = numbered
        found["frames_by_name"] = by_name = reuse.history[-1].findings["frames_by_name"]
        if named := named_frames(by_name):
            doubts += (
                "where markers do not tell how a limb's frame lies in the recording to be reused, "
                "frames of one name were taken for the same, which they are to some degrees: "
                f"{named}",
            )
        if apart:
            doubts += (
                "recordings contradict each other about these axes by more than 10° and more than "
                f"they are uncertain: {', '.join(apart)}",
            )
    if found:
        step = Step("calibration", {}, found, doubts, __version__)
        motion = replace(motion, history=(*motion.history, step))
    parameters = parameterize(motion, settings, calibration=calibration, reuse=reuse, give_way=True)
    return parameters if reuse is None else _with_origins(parameters)


def _as_numbered_in(
    skeleton: Skeleton, others: Sequence[Calibrated]
) -> tuple[tuple[Calibrated, ...], dict[str, Json], tuple[str, ...]]:
    """Return recordings with joints numbered as here, which are which, and what is left over."""
    called: list[Calibrated] = []
    numbered: dict[str, Json] = {}
    left: list[str] = []
    for other in sorted(others, key=lambda one: one.name):
        same, matched, unmatched = as_numbered_in(skeleton, other)
        called.append(same)
        if matched:
            numbered[other.name] = {**matched}
        left += [f"{joint} of {other.name} ({why})" for joint, why in unmatched.items()]
    if not left:
        return tuple(called), numbered, ()
    said = (
        "joints without a name are the same where they join limbs of the same markers; axes of "
        f"these are not reused: {', '.join(left)}"
    )
    return tuple(called), numbered, (said,)


def _with_origins(parameters: Parameters) -> Parameters:
    """Return parameters whose calibration step says from where the axes are that serve in the end.

    What is known best of other recordings may still give way to what this one tells.
    """
    skeleton = parameters.skeleton
    origins: dict[str, Json] = {
        joint.name: _origins(joint.axes_reused_from)
        for joint in skeleton.joints
        if any(joint.axes_reused_from)
    }
    history = tuple(
        replace(step, findings={**step.findings, "axes_from": origins})
        if step.name == "calibration"
        else step
        for step in parameters.history
    )
    return replace(parameters, skeleton=replace(skeleton, history=history), history=history)


def _origins(names: Sequence[str]) -> Json:
    """Return where each axis of a joint is from; null for one that was put across."""
    return {f"axis_{k}": name or None for k, name in enumerate(names, start=1)}


def _skeleton(source: Source) -> Skeleton:
    if isinstance(source, Skeleton):
        return source
    return replace(source.skeleton, history=source.parameters.history)


def _file(source: Source) -> str:
    """Return the name of the file that was solved; empty where nothing tells it."""
    for step in source.history if isinstance(source, Solution) else ():
        if step.name == "read":
            return str(step.settings.get("file") or "")
    return ""
