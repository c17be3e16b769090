"""Starts found from images alone: how many are right, doubted, and wrong without a word.

    python -m benchmarks.markerless.starts [--only TEXT] [--seed 3]

Outcomes are kept in ``benchmarks/results/markerless-starts.json`` as they come; the page is
written from them. Exit code 1 where a wrong start is believed.
"""

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from time import process_time

import numpy as np

from benchmarks.markerless.measures import ASTRAY
from kinesphere.data import BodyChoice, bundled_body
from kinesphere.errors import BadScene
from kinesphere.io import replacing
from kinesphere.io.json_files import write_json
from kinesphere.markerless.anatomy import full_body
from kinesphere.markerless.first_pose import FirstPose, first_pose
from kinesphere.markerless.pose import posed
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.shape import shaped
from kinesphere.synthetic.film import Film, another_person, make_film

PAGE = Path(__file__).parents[2] / "docs" / "results" / "markerless-starts.md"
KEPT = Path(__file__).parents[1] / "results" / "markerless-starts.json"
N_FRAMES = 300
FILMS = (
    *(("push-ups", "plain", 4, seed) for seed in (1, 11, 28)),
    *(("turn", "plain", 4, seed) for seed in (2, 27)),
    *(("arms", "plain", 4, seed) for seed in (5, 12, 13, 21)),
    *(("body", "plain", 4, seed) for seed in (1, 25)),
    *(("turn", "plain", 3, seed) for seed in (1,)),
    *(("arms", "clutter", 4, seed) for seed in (1,)),
    *(("arms", "plain", 4, seed) for seed in (3, 9, 10, 22)),
    *(("body", "plain", 4, seed) for seed in (24,)),
    *(("turn", "plain", 3, seed) for seed in (26,)),
    *(("arms", "plain", 4, seed) for seed in (23,)),
)
"""Movement, conditions, cameras, seed."""


@dataclass(frozen=True)
class StartOutcome:
    """One start, held against the truth."""

    film: str
    seed: int
    joints_mean: float | None
    """mm; None where the start was refused."""
    joints_worst: float | None
    edges: float | None
    overlap: float | None
    bare: float | None
    """l."""
    said: str
    """Nothing, a doubt, or why it was refused."""
    seconds: float
    """Of processor time."""

    @property
    def right(self) -> bool:
        """Whether no joint is astray."""
        return self.joints_worst is not None and self.joints_worst <= ASTRAY * 1e3

    @property
    def verdict(self) -> str:
        """What became of it."""
        if self.joints_worst is None:
            return "refused"
        if self.right:
            return "doubted wrongly" if self.said else "found"
        return "doubted rightly" if self.said else "**wrong without a word**"


def outcome(movement: str, conditions: str, n_cameras: int, seed: int) -> StartOutcome:
    """Return how the start of one film comes out."""
    model = bundled_body()
    person = another_person(model, np.random.default_rng([seed, 77]))
    film = make_film(
        seed,
        movement,
        conditions=conditions,
        n_frames=N_FRAMES,
        n_cameras=n_cameras,
        surface=person,
    )
    name = f"{movement}, {conditions}, {n_cameras} cameras"
    scene = replace(film.scene, body=BodyChoice(fit=True))
    clock = process_time()
    try:
        found = first_pose(scene, model, full_body, TrackSettings(), scene.frame(0))
    except BadScene as error:
        return StartOutcome(
            name, seed, None, None, None, None, None, str(error), process_time() - clock
        )
    seconds = process_time() - clock
    off = 1e3 * _off(found, film)
    evidence = found.evidence
    assert evidence is not None
    return StartOutcome(
        name,
        seed,
        float(off.mean()),
        float(off.max()),
        evidence.edges,
        evidence.overlap,
        1e3 * evidence.bare,
        found.doubt,
        seconds,
    )


def _off(found: FirstPose, film: Film) -> np.ndarray:
    chain = full_body(shaped(bundled_body(), found.logs)).chain
    centres = posed(chain, found.pose).centres
    limbs = film.motion.surface.limbs
    own = [chain.limb_names.index(limb) for limb in limbs]
    return np.asarray(np.linalg.norm(centres[own] - film.motion.joint_centres[0], axis=-1))


def page(outcomes: Sequence[StartOutcome]) -> str:
    """Return the results page as Markdown."""
    verdicts = [one.verdict for one in outcomes]
    counts = ", ".join(f"{verdicts.count(v)} {v}" for v in dict.fromkeys(verdicts))
    lines = [
        "# Starts from images alone",
        "",
        "Written by `python -m benchmarks.markerless.starts`: neither masks nor plates, a person "
        "of unknown shape, the first frame of films of 640 × 480 pixels. A start is *right* if no "
        f"joint is more than {ASTRAY * 1e3:.0f} mm from the truth. What it is judged by (edges "
        "along the rim, overlap with the silhouettes, space left bare) knows nothing of that.",
        "",
        f"**Of {len(outcomes)} starts: {counts}.** Processor time a start: "
        f"{np.mean([o.seconds for o in outcomes]):.0f} s, at most "
        f"{max(o.seconds for o in outcomes):.0f} s.",
        "",
        "| film | seed | joints, mean | worst | edges | overlap | bare | verdict |",
        "|---|--:|--:|--:|--:|--:|--:|---|",
    ]
    for one in outcomes:
        lines.append(
            f"| {one.film} | {one.seed} | {_number(one.joints_mean, 0, ' mm')} | "
            f"{_number(one.joints_worst, 0, ' mm')} | {_number(one.edges, 2)} | "
            f"{_number(one.overlap, 2)} | {_number(one.bare, 1, ' l')} | {one.verdict} |"
        )
    return "\n".join(lines) + "\n"


def _number(value: float | None, digits: int, unit: str = "") -> str:
    return "–" if value is None else f"{value:.{digits}f}{unit}"


def main() -> int:
    """Run what the command line asks for; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", default="", help="films whose name holds this")
    parser.add_argument("--seed", type=int, help="this seed only")
    asked = parser.parse_args()
    known = json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.exists() else []
    kept = {(one["film"], one["seed"]): StartOutcome(**one) for one in known}
    silent = False
    for movement, conditions, n_cameras, seed in FILMS:
        name = f"{movement}, {conditions}, {n_cameras} cameras"
        if asked.only not in name or asked.seed not in (None, seed):
            continue
        one = outcome(movement, conditions, n_cameras, seed)
        print(one.film, one.seed, one.verdict, one, flush=True)
        silent |= not one.right and not one.said
        kept[one.film, one.seed] = one
        write_json([asdict(o) for o in kept.values()], KEPT)
        _write_page(kept)
    return int(silent)


def _write_page(kept: dict[tuple[str, int], StartOutcome]) -> None:
    order = sorted((f"{m}, {c}, {n} cameras", seed) for m, c, n, seed in FILMS)
    with replacing(PAGE) as partial:
        partial.write_text(page([kept[key] for key in order if key in kept]), encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
