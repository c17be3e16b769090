"""Which topological model a recording is solved with."""

from kinesphere.data import Recording, TopologicalModel
from kinesphere.errors import BadModel
from kinesphere.labelling import (
    built_in_model,
    built_in_models,
    choose_model,
    coverage,
    find_subjects,
)

MOTION_ALONE = "none"


def model_for(
    recording: Recording, model: TopologicalModel | str | None, subject: str | None
) -> TopologicalModel:
    """Return the model itself, the built-in one of that name, or the one the labels cover.

    Raises
    ------
    BadModel
        If there is no such name, no built-in model fits, or motion alone is asked for.
    """
    if isinstance(model, TopologicalModel):
        return model
    if model == MOTION_ALONE:
        raise BadModel(f"solving from motion alone is not yet available; {_REMEDY}")
    if model is not None:
        return built_in_model(model)
    chosen = choose_model(recording, subject)
    if chosen is None:
        raise BadModel(
            f"no built-in model fits these {recording.n_markers} labels "
            f"({_nearest(recording, subject)}), and solving from motion alone is not yet "
            f"available; {_REMEDY}"
        )
    return chosen


_REMEDY = (
    "if the person wears one of these layouts without some limbs, name it with --model: limbs "
    "without markers are left out; else say which marker sits on which segment: 'kinesphere model "
    "FILE --segments SEGMENTS -o MODEL.json', then pass --model MODEL.json"
)


def _nearest(recording: Recording, subject: str | None) -> str:
    if subject is None:
        subjects = find_subjects(recording)
        subject = subjects[0] if len(subjects) == 1 else None
    shares = {
        name: coverage(recording, built_in_model(name), subject) for name in built_in_models()
    }
    return ", ".join(f"{name} {share:.0%}" for name, share in shares.items()) + " of its labels"
