"""Outcomes kept in a file, each under its name, so that one case can be measured anew alone."""

import json
from dataclasses import asdict
from pathlib import Path

from benchmarks.markerless.measures import Errors
from benchmarks.markerless.real import NAMES, RealOutcome
from benchmarks.markerless.rendered import CASES, Case, Outcome
from kinesphere.io import replacing

RESULTS = Path(__file__).parents[1] / "results" / "markerless.json"


def kept(path: Path = RESULTS) -> tuple[list[Outcome], list[RealOutcome]]:
    """Return what was measured before: films in the order of ``CASES``, recordings of ``NAMES``.

    Cases that are no longer there, or have other limits or conditions now, are left out.
    """
    if not path.is_file():
        return [], []
    stored = json.loads(path.read_text(encoding="utf-8"))
    usual = asdict(Case("", ""))  # what a case of old did not say
    films = []
    for case in CASES:
        for row in stored["films"]:
            if json.loads(json.dumps(usual)) | row["case"] == json.loads(json.dumps(asdict(case))):
                errors = None if row["errors"] is None else Errors(**row["errors"])
                films.append(Outcome(case, row["seed"], row["n_frames"], errors, row["failed"]))
    return films, [RealOutcome(**row) for row in stored["real"] if row["name"] in NAMES]


def keep(
    films: list[Outcome], real: list[RealOutcome], path: Path = RESULTS
) -> tuple[list[Outcome], list[RealOutcome]]:
    """Enter new outcomes, each in place of the one of the same case and seed; return all."""
    old_films, old_real = kept(path)
    by_seed = {(o.case.name, o.seed): o for o in (*old_films, *films)}
    by_name = {o.name: o for o in (*old_real, *real)}
    order = {case.name: i for i, case in enumerate(CASES)}
    all_films = sorted(by_seed.values(), key=lambda o: (order[o.case.name], o.seed))
    all_real = [by_name[name] for name in NAMES if name in by_name]
    stored = {
        "films": [asdict(outcome) for outcome in all_films],
        "real": [asdict(outcome) for outcome in all_real],
    }
    with replacing(path) as partial:
        partial.write_text(json.dumps(stored, indent=1) + "\n", encoding="utf-8")
    return all_films, all_real
