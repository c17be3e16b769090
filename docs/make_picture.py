"""``python -m docs.make_picture``: the picture at the top of the README, from a synthetic actor.

The report's own player and curves, drawn by a Chromium that runs without a window.
"""

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
from importlib.resources import files
from pathlib import Path

import numpy as np

from kinesphere.data import Solution
from kinesphere.pipeline import solve
from kinesphere.report.page import SCRIPTS as REPORT_SCRIPTS
from kinesphere.report.scene import scene_from_solution
from kinesphere.synthetic import make_performance, spoil_with_noise

PICTURE = Path(__file__).parent / "images" / "line.png"
WIDTH, HEIGHT = 1280, 436  # CSS pixels; the picture has twice as many
SHOWN_S = 6.0
WALKING = 0.9  # of the greatest speed
JOINTS = ("left_hip", "left_knee", "right_shoulder")
FILES = (
    ("report.html", "player, curves, what to trust"),
    ("skeleton.json", "lengths, centres, axes"),
    ("parameters.csv", "every angle, every frame"),
    ("recording.c3d", "labelled, with joint centres"),
    ("motion.bvh", "Blender, Unity"),
    ("motion.osim .mot", "OpenSim, with these axes"),
    ("summary.json", "settings, findings, warnings"),
)
SCRIPTS = tuple(name for name in REPORT_SCRIPTS if name not in ("heat.js", "page.js"))
_CHROMIUM = "--headless=new --no-sandbox --disable-gpu --use-angle=swiftshader \
--enable-unsafe-swiftshader --disable-quic --no-first-run --disable-background-networking \
--disable-component-update --disable-sync --hide-scrollbars --virtual-time-budget=5000 \
--default-background-color=00000000 --force-device-scale-factor=2"

_STYLE = """
body { margin: 0; padding: 0; max-width: none; background: transparent; }
.picture { box-sizing: border-box; width: %dpx; height: %dpx; padding: 16px 18px 18px;
  display: grid; gap: 26px;
  grid-template-columns: 246px 246px 1fr 226px; background: #f5f6f8; border: 1px solid #d8dde6;
  border-radius: 16px; }
.panel { position: relative; display: flex; flex-direction: column; min-width: 0; }
.panel h2 { font-size: 15px; margin: 0 0 9px 2px; color: #161a22; }
.panel + .panel::before { content: ""; position: absolute; left: -18px; top: 53%%; width: 9px;
  height: 9px;
  border: solid #3b5bdb; border-width: 2.5px 2.5px 0 0; transform: rotate(45deg); }
.viewport { flex: 1; border: 1px solid var(--line); border-radius: 12px; background: #eef2f8; }
.viewport canvas { width: 100%%; height: 100%%; display: block; }
.stack { flex: 1; display: grid; gap: 9px; }
.stack .chart { margin: 0; padding: 7px 11px 2px; border-radius: 12px; }
.stack .chart canvas { height: 84px; }
.files { flex: 1; margin: 0; padding: 4px 14px; list-style: none;
  border: 1px solid var(--line); border-radius: 12px;
  background: #fff; display: flex; flex-direction: column; justify-content: space-evenly; }
.files b { display: block; font: 600 12.5px/1.35 ui-monospace, "DejaVu Sans Mono", monospace;
  color: #3b5bdb; }
.files span { font-size: 11.5px; color: #667085; }
"""

_DRAW = """
(async () => {
  const scene = JSON.parse(document.querySelector("#scene").textContent);
  const names = Object.keys(scene.arrays);
  const arrays = await Promise.all(names.map((name) => unpack(scene.arrays[name])));
  const data = Object.fromEntries(names.map((name, i) => [name, arrays[i]]));
  const theme = themeFromStyles();
  const { frame, span, joints } = JSON.parse(document.querySelector("#wanted").textContent);
  const shown = [{ markers: true, bones: false }, { markers: true, bones: true, axes: true }];
  document.querySelectorAll(".viewport canvas").forEach((canvas, i) => {
    const markers = i ? theme.marker : "#3b5bdb";
    const player = new Player(canvas, scene, data, { ...theme, marker: markers });
    player.show = { axes: false, frames: false, names: false, ...shown[i] };
    player.frame = frame;
    player.reset(0.75, 0.14);
    player.camera.distance *= 0.66;
    player.follow = false;
    player.camera.target = add(player.centreAt(frame), [0, -0.06, 0]);
    player.draw();
  });
  const view = new TimeView(scene.n_frames / scene.rate);
  view.show(...span);
  document.querySelectorAll(".chart").forEach((element, i) => {
    const chart = new Chart(element, joints[i], scene, data, view, theme);
    chart.residualHeight = -6;
    chart.paintResidual = () => {};
    chart.range = chart.findRange();
    chart.draw();
    chart.point(frame);
  });
})();
"""


def main() -> int:
    """Solve an actor, draw the page, write the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--chromium", default=shutil.which("chromium") or "chromium")
    arguments = parser.parse_args()
    performance = make_performance(np.random.default_rng(1), layout="cmu41")
    recording = spoil_with_noise(performance.recording, np.random.default_rng(2))
    solution = solve(recording, calibration=performance.calibration)
    html = page_html(solution, performance.calibration[1])
    photograph(html, WIDTH, HEIGHT, PICTURE, arguments.chromium)
    return 0


def photograph(html: str, width: int, height: int, picture: Path, chromium: str) -> None:
    """Write what a page of some CSS pixels looks like, twice as many pixels wide and high."""
    with tempfile.TemporaryDirectory() as folder:
        page, shot = Path(folder) / "page.html", Path(folder) / "picture.png"
        page.write_text(html, encoding="utf-8")
        subprocess.run(
            [
                chromium,
                *_CHROMIUM.split(),
                f"--user-data-dir={folder}/profile",
                f"--window-size={width},{height}",
                f"--screenshot={shot}",
                page.as_uri(),
            ],
            check=True,
            capture_output=True,
            timeout=120,
        )
        picture.parent.mkdir(exist_ok=True)
        shutil.copyfile(shot, picture)


def page_html(solution: Solution, free_from_s: float) -> str:
    """Return the page that is photographed: markers, skeleton, curves, files."""
    scene = scene_from_solution(solution)
    frame = stride_frame(solution, free_from_s)
    at_s = frame / solution.motion.rate
    wanted = {
        "frame": frame // int(scene["stride"]),
        "span": [at_s - SHOWN_S / 2, at_s + SHOWN_S / 2],
        "joints": [solution.skeleton.joint_names.index(name) for name in JOINTS],
    }
    charts = "".join(
        f'<article class="card chart"><h3>{name.replace("_", " ")}<span class="values">'
        + "".join(f'<span class="value {c}" data-series="{k}"></span>' for k, c in series(name))
        + '</span></h3><div class="plot"><canvas></canvas><i class="cursor"></i></div></article>'
        for name in JOINTS
    )
    listed = "".join(f"<li><b>{name}</b><span>{what}</span></li>" for name, what in FILES)
    helpers = asset("page.js").partition("\nasync function start")[0]
    scripts = "\n".join([*map(asset, SCRIPTS), helpers, _DRAW])
    return (
        '<!doctype html><meta charset="utf-8">'
        f"<style>{asset('page.css')}{_STYLE % (WIDTH, HEIGHT)}</style>"
        '<div class="picture">'
        f"{''.join(map(_viewport, ('Labelled markers', 'Measured skeleton')))}"
        '<div class="panel"><h2>Angles about this person’s own axes</h2>'
        f'<div class="stack">{charts}</div></div>'
        f'<div class="panel"><h2>Files</h2><ul class="files">{listed}</ul></div></div>'
        f'<script type="application/json" id="scene">{json.dumps(scene)}</script>'
        f'<script type="application/json" id="wanted">{json.dumps(wanted)}</script>'
        f"<script>{scripts}</script>"
    )


def _viewport(title: str) -> str:
    canvas = '<div class="viewport"><canvas></canvas></div>'
    return f'<div class="panel"><h2>{title}</h2>{canvas}</div>'


def series(joint: str) -> list[tuple[int, str]]:
    """Return the numbers shown beside a chart: (series, style)."""
    axes = [(0, "axis1")] if joint.endswith(("knee", "elbow")) else [(0, "axis1"), (1, "axis2")]
    return [*axes, (3, "twist")]


def stride_frame(solution: Solution, free_from_s: float) -> int:
    """Return the frame of the longest step while walking."""
    motion = solution.motion
    ankles = [motion.skeleton.joint_names.index(f"{side}_ankle") for side in ("left", "right")]
    feet = motion.joint_centres()[:, ankles]
    apart = np.linalg.norm((feet[:, 0] - feet[:, 1])[:, [0, 2]], axis=1)
    speeds = np.linalg.norm(np.gradient(motion.origins[:, 0, [0, 2]], axis=0), axis=1)
    margin = round(SHOWN_S / 2 * motion.rate)
    free = slice(round(free_from_s * motion.rate) + margin, -margin)
    walking = speeds[free] > WALKING * np.nanmax(speeds[free])
    return int(free.start + np.nanargmax(np.where(walking, apart[free], 0.0)))


def asset(name: str) -> str:
    """Return a file of the report."""
    return (files("kinesphere.report") / "assets" / name).read_text(encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
