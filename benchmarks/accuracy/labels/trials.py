"""A lab's own people: functional trials by one another, movements by a standing trial."""

from dataclasses import replace
from typing import Any

from benchmarks.accuracy.labels.elsewhere import scored
from benchmarks.accuracy.labels.sources import folder
from kinesphere import read
from kinesphere.data import Recording
from kinesphere.labelling import built_in_model, match_labels
from kinesphere.skeleton.statistics import marker_statistics


def functional() -> list[dict[str, Any]]:
    """Every functional trial by the model of each other one: one person."""
    known = built_in_model("plugin-gait")
    files = sorted((folder() / "functional").glob("*.c3d"))
    trials = {f.stem: match_labels(read(f), known) for f in files}
    rows = []
    for learnt in ("Test_func_lhip", "Test_func_trunk"):
        model = replace(
            known, statistics=(marker_statistics(trials[learnt], known.labels, learnt),)
        )
        for name, trial in trials.items():
            if name != learnt:
                rows.append(scored(f"functional/{name}", model, trial, f"by {learnt} (one person)"))
    return rows


def static() -> list[dict[str, Any]]:
    """Movements by the model of a standing trial, of the same person and of another one."""
    known = built_in_model("plugin-gait")
    rows = []

    def trial(path: str) -> Recording:
        return match_labels(read(folder() / f"{path}.c3d"), known)

    people = {
        "functional/anatomical_posture": [
            f"functional/Test_func_{x}"
            for x in ("anat", "lankle", "lhip", "lknee", "rankle", "rhip", "rknee", "trunk")
        ],
        "plugin-gait/PiG_Calibration-FlatFoot-Full": ["plugin-gait/PiG_Motion-FlatFoot-Full"],
        "plugin-gait/pycgm_static": ["plugin-gait/pycgm_movement"],
    }
    abroad = (
        "functional/Test_func_trunk",
        "plugin-gait/PiG_Motion-FlatFoot-Full",
        "plugin-gait/pycgm_movement",
    )
    for standing, own in people.items():
        learnt = marker_statistics(trial(standing), known.labels, standing)
        model = replace(known, statistics=(learnt,))
        for moving in own:
            rows.append(scored(moving, model, trial(moving), f"by {standing} (one person)"))
        for moving in abroad:
            if moving not in own:
                rows.append(scored(moving, model, trial(moving), f"by {standing} (another person)"))
    return rows
