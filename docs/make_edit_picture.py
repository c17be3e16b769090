"""``python -m docs.make_edit_picture``: one pose before and after a single angle was changed.

As in figure 5b of Sar Dessai, Hornung & Kobbelt 2006; a synthetic actor, drawn by the report's own
player.
"""

import argparse
import json
import shutil
import sys
from pathlib import Path

import numpy as np
from docs.make_picture import SCRIPTS, asset, photograph

from kinesphere.data.edits import Edit
from kinesphere.editing import apply_edits
from kinesphere.pipeline import solve
from kinesphere.report.scene import scene_from_solution
from kinesphere.synthetic import make_performance

PICTURE = Path(__file__).parent / "images" / "edit.png"
WIDTH, HEIGHT = 760, 400
EDIT = Edit(joint="right_shoulder", axis=2, add_deg=75.0)

_STYLE = """
body { margin: 0; padding: 0; max-width: none; background: transparent; }
.picture { box-sizing: border-box; width: %dpx; height: %dpx; padding: 14px 16px 16px;
  display: grid; gap: 18px; grid-template-columns: 1fr 1fr; background: #f5f6f8;
  border: 1px solid #d8dde6; border-radius: 16px; }
.panel { display: flex; flex-direction: column; min-width: 0; }
.panel h2 { font-size: 15px; margin: 0 0 9px 2px; color: #161a22; }
.viewport { flex: 1; border: 1px solid var(--line); border-radius: 12px; background: #eef2f8; }
.viewport canvas { width: 100%%; height: 100%%; display: block; }
"""
_DRAW = """
(async () => {
  const theme = themeFromStyles();
  for (const panel of document.querySelectorAll(".panel")) {
    const scene = JSON.parse(panel.querySelector("script").textContent);
    const names = Object.keys(scene.arrays);
    const arrays = await Promise.all(names.map((name) => unpack(scene.arrays[name])));
    const data = Object.fromEntries(names.map((name, i) => [name, arrays[i]]));
    const player = new Player(panel.querySelector("canvas"), scene, data, theme);
    player.show = { markers: true, bones: true, mesh: true, axes: true };
    player.frame = Math.floor(scene.n_frames / scene.stride / 20);
    player.reset(0.35, 0.1);
    player.camera.distance *= 0.7;
    player.follow = false;
    player.camera.target = add(player.centreAt(player.frame), [0, 0.12, 0]);
    player.draw();
  }
})();
"""


def main() -> int:
    """Solve an actor, raise an arm, write the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--chromium", default=shutil.which("chromium") or "chromium")
    arguments = parser.parse_args()
    performance = make_performance(np.random.default_rng(1), layout="cmu41")
    solution = solve(performance.recording, calibration=performance.calibration)
    raised = apply_edits(solution, [EDIT])
    told = f"{EDIT.joint.replace('_', ' ')}, axis {EDIT.axis}, {EDIT.add_deg:+.0f}°"
    panels = "".join(
        f'<div class="panel"><h2>{title}</h2><div class="viewport"><canvas></canvas></div>'
        f'<script type="application/json">{json.dumps(scene_from_solution(shown))}</script></div>'
        for title, shown in (("As measured", solution), (told, raised))
    )
    helpers = asset("page.js").partition("\nasync function start")[0]
    scripts = "\n".join([*map(asset, SCRIPTS), helpers, _DRAW])
    html = (
        '<!doctype html><meta charset="utf-8">'
        f"<style>{asset('page.css')}{_STYLE % (WIDTH, HEIGHT)}</style>"
        f'<div class="picture">{panels}</div><script>{scripts}</script>'
    )
    photograph(html, WIDTH, HEIGHT, PICTURE, arguments.chromium)
    return 0


if __name__ == "__main__":
    sys.exit(main())
