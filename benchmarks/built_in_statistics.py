"""``python -m benchmarks.built_in_statistics``: the statistics of the built-in models.

Recordings stay where they are: what is written is the mean and the deviation of every distance
between two markers, to a tenth of a millimetre, and which fours of markers keep their side.
"""

import json
import os
import sys
from pathlib import Path

import numpy as np

from kinesphere import read
from kinesphere.data import MarkerStatistics
from kinesphere.labelling import built_in_model, match_labels
from kinesphere.skeleton.statistics import marker_statistics

ROOT = Path(__file__).parents[1]
SOURCES = {
    "cmu41": (
        ("CMU 06_01, walking", "cmu41/06_01.c3d"),
        ("CMU 02_05, punching", "cmu41/02_05.c3d"),
        ("CMU 85_02, acrobatics", "cmu41/85_02.c3d"),
        ("CMU 135_02, martial arts", "cmu41/135_02.c3d"),
    ),
    "plugin-gait": (
        ("pyCGM sample, range of motion", "plugin-gait/pycgm_movement.c3d"),
        ("BioBuddy sample, hip", "functional/Test_func_lhip.c3d"),
        ("BTK sample, walking", "plugin-gait/PiG_Motion-FlatFoot-Full.c3d"),
    ),
}
"""Built-in model → (name of the recording, file). One recording a person."""
QUADRUPLES = 2000
"""As many as labelling looks at."""


def as_dict(found: MarkerStatistics) -> dict[str, object]:
    """Return statistics as a model's file has them, without digits that mean nothing."""

    def rows(values: np.ndarray) -> list[list[float | None]]:
        return [[None if np.isnan(v) else round(float(v), 4) for v in row] for row in values]

    return {
        "recording": found.recording,
        "labels": list(found.labels),
        "mean_m": rows(found.mean),
        "deviation_m": rows(found.deviation),
        "handedness": [
            [*map(int, four), round(float(sign), 2)]
            for four, sign in zip(
                found.quadruples[:QUADRUPLES], found.handedness[:QUADRUPLES], strict=True
            )
        ],
    }


def main() -> int:
    """Write a file a model."""
    folder = Path(os.environ.get("KINESPHERE_DATA", ROOT.parent / "shared" / "data"))
    for name, sources in SOURCES.items():
        model = built_in_model(name)
        found = []
        for title, file in sources:
            recording = match_labels(read(folder / file), model)
            labels = tuple(x for x in model.labels if x in recording.labels)
            found.append(as_dict(marker_statistics(recording, labels, title)))
        path = ROOT / "src" / "kinesphere" / "labelling" / "statistics" / f"{name}.json"
        lines = ",\n".join(json.dumps(one, separators=(",", ":")) for one in found)
        path.write_text(f"[\n{lines}\n]\n", encoding="utf-8")
        print(f"{path.name}: {len(found)} recordings, {path.stat().st_size // 1024} kB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
