"""``python -m benchmarks.accuracy.labels [PART…]``: run, print, write; all parts by default."""

import argparse
import json
import sys

from benchmarks.accuracy.labels import broken, clean, elsewhere, live, missing, reliability, trials
from benchmarks.accuracy.labels.page import page
from benchmarks.accuracy.labels.sources import ROOT, folder
from kinesphere import __version__

RESULTS = ROOT / "benchmarks" / "results" / "labelling.json"
PARTS = {
    "pairs": clean.pairs,
    "windows-5s": lambda: clean.windows(5.0, several=False),
    "windows-2s": lambda: clean.windows(2.0, several=True),
    "missing": missing.missing,
    "reliability": reliability.reliability,
    "broken": broken.broken,
    "broken-fresh": lambda: broken.broken(broken.FRESH),
    "halves": elsewhere.halves,
    "functional": trials.functional,
    "static": trials.static,
    "creatures": elsewhere.creatures,
    "two-people": elsewhere.two_people,
    "refusals": elsewhere.refusals,
    "speed": live.speed,
    "live": live.live,
}


def main() -> int:
    """Run the parts named and write ``labelling.json`` and ``labelling.md``."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("part", nargs="*", choices=[*PARTS, []], help="only these")
    chosen = parser.parse_args().part or list(PARTS)
    if not folder().is_dir():
        print(f"no real recordings at {folder()}; KINESPHERE_DATA names them", file=sys.stderr)
        return 2
    for name in chosen:
        found = PARTS[name]()
        # read again: parts may run side by side
        known = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {}
        known.update({"version": __version__, name: found})
        ordered = {key: known[key] for key in ("version", *PARTS) if key in known}
        rows = ",\n".join(
            f'"{key}": '
            + (
                "[\n" + ",\n".join(json.dumps(row) for row in value) + "\n]"
                if isinstance(value, list)
                else json.dumps(value)
            )
            for key, value in ordered.items()
        )
        RESULTS.write_text("{" + rows + "}\n", encoding="utf-8")
        text = page(ordered)
        (ROOT / "docs" / "results" / "labelling.md").write_text(text, encoding="utf-8")
    print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
