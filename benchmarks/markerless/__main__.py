"""``python -m benchmarks.markerless``: films and real footage tracked, the results page written.

    python -m benchmarks.markerless [--only TEXT] [--frames 300] [--page docs/results/markerless.md]

With ``--only`` or fewer frames nothing is written but what is printed. Exit code 1 where a limit
is missed.
"""

import argparse
import sys
import tempfile
from pathlib import Path

from benchmarks.markerless import real
from benchmarks.markerless.page import page
from benchmarks.markerless.rendered import Outcome, outcomes

PAGE = Path("docs/results/markerless.md")


def main() -> int:
    """Run what the command line asks for; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", default="", help="cases whose name holds this")
    parser.add_argument("--frames", type=int, default=300)
    asked = parser.parse_args()
    films: list[Outcome] = []
    for outcome in outcomes(asked.only, asked.frames):
        films.append(outcome)
        print(outcome.case.name, outcome.seed, outcome.errors or outcome.failed, flush=True)
    found: list[real.RealOutcome] = []
    with tempfile.TemporaryDirectory() as folder:
        for i, run in enumerate((real.pose2sim, real.parsec)):
            if asked.only in run.__name__ and real.DATA.is_dir():
                for one in run(Path(folder) / str(i)):
                    found.append(one)
                    print(one, flush=True)
    if not asked.only and asked.frames >= 300:
        PAGE.write_text(page(films, found, asked.frames), encoding="utf-8")
    return int(any(outcome.missed for outcome in films))


if __name__ == "__main__":
    sys.exit(main())
