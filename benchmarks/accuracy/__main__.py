"""``python -m benchmarks.accuracy``: run, print, write. Exit code 1 if a bar is missed."""

import argparse
import json
import sys
from pathlib import Path

from benchmarks.accuracy.conditions import CONDITIONS
from benchmarks.accuracy.measure import LAYOUTS, trials
from benchmarks.accuracy.page import missed, page
from kinesphere import __version__

ROOT = Path(__file__).parents[2]


def main() -> int:
    """Run every trial and write ``accuracy.json`` and ``accuracy.md``."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=3, help="actors a condition")
    parser.add_argument("--condition", action="append", help="only this one; nothing is written")
    arguments = parser.parse_args()
    chosen = tuple(
        c for c in CONDITIONS if not arguments.condition or c.name in arguments.condition
    )
    n_trials = len(LAYOUTS) * len(chosen) * arguments.seeds
    done = []
    for trial in trials(chosen, range(arguments.seeds)):
        done.append(trial)
        print(
            f"\r{len(done)}/{n_trials} {trial.layout}, {trial.condition:<15}",
            end="",
            file=sys.stderr,
        )
    print(file=sys.stderr)
    text = page(done)
    print(text)
    if not arguments.condition:
        results, document = ROOT / "benchmarks" / "results", ROOT / "docs" / "results"
        for folder in (results, document):
            folder.mkdir(parents=True, exist_ok=True)
        (document / "accuracy.md").write_text(text, encoding="utf-8")
        lines = ",\n".join(json.dumps(trial.as_json(), allow_nan=False) for trial in done)
        (results / "accuracy.json").write_text(
            f'{{"version": "{__version__}", "trials": [\n{lines}\n]}}\n', encoding="utf-8"
        )
    misses = missed(done)
    for sentence in misses:
        print(sentence, file=sys.stderr)
    return 1 if misses else 0


if __name__ == "__main__":
    sys.exit(main())
