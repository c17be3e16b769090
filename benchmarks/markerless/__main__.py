"""``python -m benchmarks.markerless``: films and real footage tracked, the results page written.

    python -m benchmarks.markerless [--only TEXT] [--frames 300] [--seed 3]

Outcomes are kept in ``benchmarks/results/markerless.json`` as they come; the page is written from
them. ``--only`` measures the cases whose name holds the text anew and leaves the others as they
are; every row tells of how many frames it is. Exit code 1 where a limit is missed.
"""

import argparse
import sys
import tempfile
from pathlib import Path

from benchmarks.markerless import real
from benchmarks.markerless.page import page
from benchmarks.markerless.rendered import outcomes
from benchmarks.markerless.store import keep
from kinesphere.io import replacing

PAGE = Path(__file__).parents[2] / "docs" / "results" / "markerless.md"


def main() -> int:
    """Run what the command line asks for; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", default="", help="cases whose name holds this")
    parser.add_argument("--frames", type=int, default=300, help="of each, if there are as many")
    parser.add_argument("--seed", type=int, help="of the seeds of each film this one only")
    asked = parser.parse_args()
    missed = False
    for film in outcomes(asked.only, asked.frames, asked.seed):
        print(film.case.name, film.seed, film.errors or film.failed, flush=True)
        keep([film], [])
        missed |= film.missed
    with tempfile.TemporaryDirectory() as folder:
        for one in real.outcomes(Path(folder), asked.only, asked.frames):
            print(one, flush=True)
            keep([], [one])
            missed |= one.missed
    with replacing(PAGE) as partial:
        partial.write_text(page(*keep([], [])), encoding="utf-8")
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
