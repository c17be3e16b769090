"""The line where no model is given: bodies found first, and a front for what has none."""

from dataclasses import replace

from kinesphere import __version__
from kinesphere.data import Motion, Recording, Step, TopologicalModel
from kinesphere.errors import AmbiguousFacing, BadRecording, DegenerateMotion
from kinesphere.labelling import find_subjects
from kinesphere.normalization import Facing, NormalizationSettings, normalize
from kinesphere.normalization.doubts import LYING
from kinesphere.pipeline.choice import why_no_model
from kinesphere.pipeline.doubts import why_it_fails
from kinesphere.quality import OrientationSettings, gathered, right_handed, with_zeros_as_gaps
from kinesphere.skeleton import DiscoverySettings, SkeletonSettings, discover

FRONTS: tuple[Facing, ...] = ("+x", "+z", "+y")
"""Where a body faces that has no front of its own, a hand or a crane: x by convention, or the first
of the world's axes that does not lie across its plane."""


def discovered(
    recording: Recording,
    subject: str | None,
    settings: DiscoverySettings,
    skeleton: SkeletonSettings,
    orientation: OrientationSettings,
    *,
    asked: bool,
) -> tuple[Recording, TopologicalModel, float | None]:
    """Return the recording, the model that its motion tells, and how many times too large it is.

    The last as `kinesphere.skeleton.fit_skeleton` takes it.

    Parameters
    ----------
    subject
        Only markers whose label has this prefix take part; all, if None.
    orientation
        By which the recording is oriented afterwards: sides are told of what comes out of that.
    asked
        True where motion alone was asked for, False where it is for want of a model.

    Raises
    ------
    BadRecording, DegenerateMotion
        As `kinesphere.skeleton.discover` does, zeros that may be why named first; and for a
        subject that no label names.
    """
    if subject is not None:
        recording = _of_subject(recording, subject)
    given, (recording, zeros) = recording, with_zeros_as_gaps(recording)
    try:
        found = discover(right_handed(recording, orientation), settings, skeleton)
    except (BadRecording, DegenerateMotion) as failed:
        raise why_it_fails(given, failed) from failed
    step = found.step
    if zeros:
        told = f"{gathered(zeros)[0].what}: taken for missing"
        step = replace(step, warnings=(told, *step.warnings))
    if not asked:
        step = replace(step, warnings=(why_no_model(recording, subject), *step.warnings))
    return replace(recording, history=(*recording.history, step)), found.model, found.unit


def normalized_somehow(
    motion: Motion, settings: NormalizationSettings, facing: Facing | None
) -> Motion:
    """Normalize a motion that may have neither front nor enough joints for a body frame.

    Where nothing tells a front and nobody said one, the body faces an axis of the world, aloud.
    Where motion alone gave a person's names and the body never stands, the names are doubted.

    Raises
    ------
    AmbiguousFacing, DegenerateMotion
        If the facing that was asked for does not help, or none does.
    """
    try:
        return _with_names_doubted(normalize(motion, settings, facing))
    except (AmbiguousFacing, DegenerateMotion) as missing:
        if facing is not None:
            raise
        turned, front = _facing_an_axis(motion, settings)
        step = Step(
            "front",
            findings={"facing": front},
            warnings=(
                f"the body has no front of its own, so it faces the world's {front}: its frames "
                "and the signs of its angles mean nothing beyond this recording "
                f"({_first(missing)})",
            ),
            version=__version__,
        )
        return _with_names_doubted(replace(turned, history=(*turned.history, step)))


def _with_names_doubted(motion: Motion) -> Motion:
    """Return the motion; with a warning where limbs are called a person's that never stands.

    Proportions and size of some animals are a person's; how they stand is not. Bent knees, arms
    held out or a body that moves say nothing: people at work or walking do that.
    """
    found = {step.name: step.findings for step in motion.history}
    named = found.get("discovery", {}).get("names_confidence") is not None
    terms = found.get("normalization", {}).get("terms")
    tilt = terms.get("trunk_tilt_deg") if isinstance(terms, dict) else None
    if not named or not isinstance(tilt, int | float) or tilt <= LYING:
        return motion
    step = Step(
        "posture",
        findings={"trunk_tilt_deg": tilt},
        warnings=(
            "the limbs are named as a person's, but the body never stands like a person (its trunk "
            f"is {tilt:.0f} deg off upright at best): of an animal the names are wrong, of "
            "somebody who lies they are to be checked",
        ),
        version=__version__,
    )
    return replace(motion, history=(*motion.history, step))


def _facing_an_axis(motion: Motion, settings: NormalizationSettings) -> tuple[Motion, Facing]:
    for front in FRONTS[:-1]:
        try:
            return _assumed(normalize(motion, settings, front), front), front
        except AmbiguousFacing:
            continue
    return _assumed(normalize(motion, settings, FRONTS[-1]), FRONTS[-1]), FRONTS[-1]


def _assumed(motion: Motion, front: Facing) -> Motion:
    """Return a normalized motion whose history does not say that a user named the front."""
    *before, step = motion.history
    facing = {**step.findings["facing"], "decided_by": f"assumed ({front})"}  # type: ignore[dict-item]
    told, assumed = f"front as told by user ({front})", f"the front that was assumed ({front})"
    step = replace(
        step,
        findings={**step.findings, "facing": facing},
        warnings=tuple(text.replace(told, assumed) for text in step.warnings),
    )
    return replace(motion, history=(*before, step))


def _first(error: Exception) -> str:
    return str(error).partition(";")[0].partition(":")[0]


def _of_subject(recording: Recording, subject: str) -> Recording:
    kept = [
        column
        for column, label in enumerate(recording.labels)
        if label.rpartition(":")[0].strip() == subject
    ]
    if not kept:
        there = ", ".join(find_subjects(recording)) or "none: labels have no prefix"
        raise BadRecording(f"no marker belongs to subject {subject!r}; subjects are {there}")
    return replace(
        recording,
        markers=recording.markers[:, kept],
        labels=tuple(recording.labels[column] for column in kept),
        residuals=None if recording.residuals is None else recording.residuals[:, kept],
    )
