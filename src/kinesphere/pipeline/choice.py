"""Which topological model a recording is solved with."""

import numpy as np

from kinesphere.data import Recording, TopologicalModel
from kinesphere.errors import BadRecording
from kinesphere.labelling import (
    LabellingSettings,
    built_in_model,
    built_in_models,
    choose_model,
    coverage,
    find_subjects,
    label,
)

MOTION_ALONE = "none"


def model_for(
    recording: Recording, model: TopologicalModel | str | None, subject: str | None
) -> TopologicalModel | None:
    """Return the model itself, the built-in one of that name, or the one the labels cover.

    None where motion alone is asked for, or no built-in model fits: then bodies and joints are
    found from the motion.

    Raises
    ------
    BadModel
        If there is no built-in model of that name.
    """
    if isinstance(model, TopologicalModel):
        return model
    if model == MOTION_ALONE:
        return None
    if model is not None:
        return built_in_model(model)
    return choose_model(recording, subject)


def with_labels(
    recording: Recording, model: TopologicalModel, subject: str | None, settings: LabellingSettings
) -> Recording:
    """Return the recording with labels of the model, given where no point bears one.

    Raises
    ------
    BadRecording
        If none could be given.
    """
    if subject is not None or coverage(recording, model):
        return recording
    labelled = label(recording, model, settings)
    if labelled.confidence is None or np.isnan(labelled.confidence).all():
        raise BadRecording(
            f"no point has a label of model {model.name}, and none could be given: "
            + "; ".join(labelled.history[-1].warnings)
        )
    return labelled


def why_no_model(recording: Recording, subject: str | None) -> str:
    """Return how far the labels are from every built-in model, for a person."""
    if subject is None:
        subjects = find_subjects(recording)
        subject = subjects[0] if len(subjects) == 1 else None
    shares = {
        name: coverage(recording, built_in_model(name), subject) for name in built_in_models()
    }
    nearest = ", ".join(f"{name} {share:.0%}" for name, share in shares.items())
    return (
        f"no built-in model fits these {recording.n_markers} labels ({nearest} of its labels): "
        "bodies and joints are from motion alone; if the person wears one of these layouts "
        "without some limbs, or without its labels, name it with --model: limbs without markers "
        "are left out, points without labels are labelled first; a model of your own says which "
        "marker sits on which segment ('kinesphere model')"
    )
