"""How far a foot's frame turns where one of its markers is missing: python -m <this module>.

Writes ``docs/results/feet.md`` and ``benchmarks/results/feet.json``; a minute.
"""

import argparse
import json
import os
import sys
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from kinesphere import __version__
from kinesphere.data import Motion, Recording
from kinesphere.geometry.rotations import rotation_angle
from kinesphere.io import read
from kinesphere.labelling import choose_model, match_labels
from kinesphere.normalization import normalize
from kinesphere.quality import orient
from kinesphere.skeleton import fit_skeleton

ROOT = Path(__file__).resolve().parents[2]
RECORDINGS = (
    "functional/anatomical_posture",
    "functional/Test_func_lankle",
    "functional/Test_func_rhip",
    "functional/Test_func_lknee",
    "cmu41/06_01",
    "cmu41/85_02",
    "plugin-gait/pycgm_static",
    "plugin-gait/pycgm_movement",
    "plugin-gait/PiG_Motion-FlatFoot-Full",
)
SIDES = ("left", "right")


@dataclass(frozen=True)
class Row:
    """A foot without one of its markers, beside the same with it."""

    recording: str
    marker: str
    n_left: int
    """Markers that the foot has left."""
    by_the_other: float
    """deg, median over frames of how far its frame is turned, as delivered."""
    alone: float
    """deg, the same by its own markers, the other foot having no say."""


def rows_of(folder: Path, name: str) -> Iterator[Row]:
    """Yield a row for every marker of either foot of a recording."""
    recording = read(folder / f"{name}.c3d")
    assert isinstance(recording, Recording)
    model = choose_model(recording)
    assert model is not None
    recording = orient(match_labels(recording, model), model)
    whole = normalize(fit_skeleton(recording, model))
    for side in SIDES:
        foot = f"{side}_foot"
        markers = whole.skeleton.limb(foot).markers
        for marker in markers:
            kept = [i for i, label in enumerate(recording.labels) if label != marker]
            less = Recording(
                recording.markers[:, kept],
                tuple(recording.labels[i] for i in kept),
                recording.rate,
                history=recording.history,
            )
            motion = fit_skeleton(less, model)
            found, alone = normalize(motion), normalize(_numbered(motion))
            yield Row(
                name.split("/")[1],
                marker,
                len(markers) - 1,
                _apart(whole, found, foot),
                _apart(whole, alone, foot),
            )


def _numbered(motion: Motion) -> Motion:
    """Return the motion with markers that are but numbered, so that no foot lends its line."""
    limbs = tuple(
        replace(limb, markers=tuple(f"{limb.name}{k}" for k in range(len(limb.markers))))
        for limb in motion.skeleton.limbs
    )
    return replace(motion, skeleton=replace(motion.skeleton, limbs=limbs))


def _apart(whole: Motion, less: Motion, limb: str) -> float:
    i, j = (one.skeleton.limb_names.index(limb) for one in (whole, less))
    turned = np.swapaxes(whole.rotations[:, i], -1, -2) @ less.rotations[:, j]
    return float(np.rad2deg(np.nanmedian(rotation_angle(turned))))


def page(rows: list[Row]) -> str:
    """Return the results page."""
    lines = [
        "# Feet that lack a marker",
        "",
        "Written by `python -m benchmarks.accuracy.lost_foot_markers`.",
        "",
        "One marker of a foot is left out, and its frame compared with that of the same recording",
        "with all of them: median over frames of the angle between both, in degrees. *Alone*: by",
        "the markers that the foot has left (away from the heel, where there is but that; level on",
        "the floor, where it rests and has no heel). *By the other*, the default: as the other",
        "foot points, mirrored onto the markers that both have. What is left is for the most part",
        "how unlike the markers of both feet were put on; of feet with a single marker left, the",
        "twist that nothing tells. Before, a heel alone was taken for the toes, 149 to 170° off.",
        "",
        "| markers left | left out | feet | alone | by the other |",
        "|---|---|---:|---:|---:|",
    ]
    for several in (True, False):
        for marker in dict.fromkeys(row.marker[1:] for row in rows):
            of = [r for r in rows if r.marker[1:] == marker and (r.n_left > 1) == several]
            if of:
                cells = (_shown([getattr(r, key) for r in of]) for key in ("alone", "by_the_other"))
                left = "two and three" if several else "one"
                lines.append(f"| {left} | {marker} | {len(of)} | " + " | ".join(cells) + " |")
    lines += [
        "",
        "Median (least to most). Each foot by itself:",
        "",
        "| recording | left out | alone | by the other |",
        "|---|---|---:|---:|",
    ]
    lines += [
        f"| {r.recording} | {r.marker} | {r.alone:.1f} | {r.by_the_other:.1f} |" for r in rows
    ]
    return "\n".join(lines) + "\n"


def _shown(values: list[float]) -> str:
    return f"{np.median(values):.1f} ({min(values):.1f} to {max(values):.1f})"


def main() -> int:
    """Measure what recordings there are and write the page and its figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    default = os.environ.get("KINESPHERE_DATA", ROOT.parent / "shared" / "data")
    parser.add_argument("folder", type=Path, nargs="?", default=Path(default))
    folder = parser.parse_args().folder
    if not (folder / "functional").is_dir():
        print(f"no functional trials at {folder}; name their folder", file=sys.stderr)
        return 2
    rows = [row for name in RECORDINGS for row in rows_of(folder, name)]
    (ROOT / "docs" / "results" / "feet.md").write_text(page(rows), encoding="utf-8")
    (ROOT / "benchmarks" / "results" / "feet.json").write_text(
        json.dumps({"version": __version__, "feet": [asdict(r) for r in rows]}, indent=1) + "\n",
        encoding="utf-8",
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
