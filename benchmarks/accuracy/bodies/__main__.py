"""``python -m benchmarks.accuracy.bodies``: run, print, write. Exit code 1 if a bar is missed."""

import argparse
import json
import math
import sys
from collections.abc import Callable
from dataclasses import asdict
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from benchmarks.accuracy.bodies.arm import arm_figures
from benchmarks.accuracy.bodies.cases import ROOT, actor_case, creature_cases, folder, real_cases
from benchmarks.accuracy.bodies.centres import centre_rows
from benchmarks.accuracy.bodies.changes import change_rows
from benchmarks.accuracy.bodies.cost import Cost, cost_rows, plot
from benchmarks.accuracy.bodies.functional import functional_rows
from benchmarks.accuracy.bodies.hiding import hiding_rows
from benchmarks.accuracy.bodies.hips import hip_rows
from benchmarks.accuracy.bodies.linked_limbs import linked_figures
from benchmarks.accuracy.bodies.page import bars, page
from benchmarks.accuracy.bodies.partitions import Row, rows
from benchmarks.accuracy.bodies.perturbed import perturbed_rows
from benchmarks.accuracy.bodies.strayed import strayed_rows
from benchmarks.accuracy.bodies.told import told_rows
from kinesphere import __version__

RESULTS = ROOT / "benchmarks" / "results" / "skeleton.json"
ACTORS = 10
CREATURES = 6
"""Animals, hands, players and pairs of people."""


def _partitions() -> list[dict[str, Any]]:
    found = [_told(row) for row in rows(real_cases())]
    for seed in range(CREATURES):
        found += [_told(row) for row in rows(creature_cases(seed))]
    for spoilt in (False, True):
        for seed in range(ACTORS):
            case = actor_case(seed, spoilt=spoilt)
            found += [_told(row) for row in rows([case], centres=True)]
    return [asdict(row) for row in found]


def _changes() -> list[dict[str, Any]]:
    quadruped, hand, _, people = creature_cases(0)
    lawful = [actor_case(0, spoilt=True), quadruped, hand, people]
    cmu = [case for case in real_cases() if case.name.startswith("cmu41")]
    return [asdict(row) for row in change_rows(lawful, cmu)]


SECTIONS: dict[str, Callable[[], Any]] = {
    "partitions": _partitions,
    "changes": _changes,
    "perturbed": lambda: [asdict(row) for row in perturbed_rows()],
    "strayed": lambda: [asdict(row) for row in strayed_rows()],
    "centres": lambda: [asdict(row) for row in centre_rows()],
    "told": lambda: [asdict(row) for row in told_rows()],
    "arm": arm_figures,
    "linked": linked_figures,
    "hips": lambda: [asdict(row) for row in hip_rows()],
    "functional": lambda: [asdict(row) for row in functional_rows()],
    "hiding": lambda: [asdict(row) for row in hiding_rows()],
}


def main() -> int:
    """Run every section; write ``skeleton.json``, ``skeleton.md`` and the plot."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--without-peer", action="store_true", help="write the page without the peer's columns"
    )
    parser.add_argument(
        "--only",
        choices=sorted(SECTIONS),
        nargs="+",
        help="renew these sections and keep the rest as it was measured last",
    )
    arguments = parser.parse_args()
    with_peer = not arguments.only or "functional" in arguments.only
    if with_peer and not _peer() and not arguments.without_peer:
        print(
            "the peer biobuddy is not installed here, and the page would lose its columns: "
            "pip install -e .[bench], in an environment of its own, or --without-peer",
            file=sys.stderr,
        )
        return 2
    if not folder().is_dir():
        print(f"no real recordings at {folder()}; set KINESPHERE_DATA", file=sys.stderr)
        return 2
    if arguments.only:
        found = json.loads(RESULTS.read_text(encoding="utf-8"))
        found |= {"version": __version__, **{name: SECTIONS[name]() for name in arguments.only}}
        if "functional" in arguments.only:
            found["peer"] = _peer()
        if absent := {*SECTIONS, "cost"} - found.keys():
            print(
                f"{RESULTS} has no {', '.join(sorted(absent))} to keep: run without --only",
                file=sys.stderr,
            )
            return 2
        return _ended(found, None)
    costs = cost_rows()
    found = {
        "version": __version__,
        "peer": _peer(),
        **{name: measure() for name, measure in SECTIONS.items()},
        "cost": [asdict(row) for row in costs],
    }
    return _ended(found, costs)


def _ended(found: dict[str, Any], costs: list[Cost] | None) -> int:
    """Write what was found; return 1 if a bar is missed, and say which."""
    found = _plain(found)
    _write(found, costs)
    missed = [bar for bar in bars(found) if not bar.met]
    for bar in missed:
        print(f"{bar.what}: {bar.found}; {bar.wanted} is wanted", file=sys.stderr)
    return 1 if missed else 0


def _write(found: dict[str, Any], costs: list[Cost] | None) -> None:
    text = page(found)
    print(text)
    documents = ROOT / "docs"
    (documents / "results" / "skeleton.md").write_text(text, encoding="utf-8")
    if costs is not None:
        (documents / "images" / "skeleton-cost.svg").write_text(plot(costs), encoding="utf-8")
    RESULTS.write_text(json.dumps(found, indent=1, allow_nan=False) + "\n", encoding="utf-8")


def _told(row: Row) -> Row:
    print(f"\r{row.case:<44} {row.method:<9}", end="", file=sys.stderr)
    return row


def _peer() -> str:
    try:
        return f"biobuddy {version('biobuddy')}"
    except PackageNotFoundError:
        return ""


def _plain(value: Any) -> Any:
    """Return what JSON can hold; NaN becomes null, digits that mean nothing are cut."""
    if isinstance(value, float):
        return round(value, 5) if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: _plain(v) for key, v in value.items()}
    return [_plain(v) for v in value] if isinstance(value, list) else value


if __name__ == "__main__":
    sys.exit(main())
