"""``python -m benchmarks.accuracy.retargeting``: run, print, write; 1 if a bar is missed."""

import json
import os
import sys
from pathlib import Path

import numpy as np

from benchmarks.accuracy.retargeting.contacts import Matched, events_of, matched
from benchmarks.accuracy.retargeting.measure import Row, measured
from benchmarks.accuracy.retargeting.page import missed, page
from benchmarks.accuracy.retargeting.rigs import changed, character
from kinesphere import __version__, read, solve
from kinesphere.editing import retarget_motion
from kinesphere.io import read_rig

ROOT = Path(__file__).parents[3]
WALKS = (
    "cmu41/06_01.c3d",
    "plugin-gait/PiG_Motion-FlatFoot-Full.c3d",
    "plugin-gait/pycgm_movement.c3d",
    "cmu41/85_02.c3d",
)


def main() -> int:
    """Put real recordings on every rig and write ``retargeting.json`` and ``retargeting.md``."""
    folder = Path(os.environ.get("KINESPHERE_DATA", ROOT.parent / "shared" / "data"))
    if not folder.is_dir():
        print(f"no real recordings at {folder}; set KINESPHERE_DATA", file=sys.stderr)
        return 1
    rows: list[Row] = []
    events: dict[str, list[Matched]] = {}
    itself = 0.0
    for name in WALKS:
        print(name, file=sys.stderr)
        solution = solve(read(folder / name))
        # gaps bridged, joints held together: what a rig can play at all
        motion = retarget_motion(solution.motion, solution.skeleton)
        same = retarget_motion(motion, motion.skeleton)
        itself = max(
            itself,
            float(np.abs(same.rotations - motion.rotations).max()),
            float(np.abs(same.origins - motion.origins).max()),
        )
        rigs = [(rig, skeleton, True) for rig, skeleton in changed(motion.skeleton)]
        rigs += [
            ("character, T pose", character("t"), False),
            ("character, A pose, long legs, broad hips", character("a", 1.2, 1.4), False),
            ("CMU's BVH rig", read_rig(folder / "formats" / "01_01.bvh"), False),
        ]
        rows += [measured(name, motion, rig, skeleton, alike) for rig, skeleton, alike in rigs]
        if marked := events_of(solution.recording):
            events[name] = matched(solution.motion, marked)
    text = page(rows, events, itself)
    print(text)
    (ROOT / "docs" / "results" / "retargeting.md").write_text(text, encoding="utf-8")
    lines = ",\n".join(json.dumps(row.as_json(), allow_nan=False) for row in rows)
    (ROOT / "benchmarks" / "results" / "retargeting.json").write_text(
        f'{{"version": "{__version__}", "itself": {itself!r}, "rows": [\n{lines}\n]}}\n',
        encoding="utf-8",
    )
    misses = missed(rows, itself)
    for sentence in misses:
        print(sentence, file=sys.stderr)
    return 1 if misses else 0


if __name__ == "__main__":
    sys.exit(main())
