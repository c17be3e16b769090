"""``python -m docs.make_animation``: a real recording, solved, in motion, for the README.

A boxer of the CMU Graphics Lab Motion Capture Database (02_05; mocap.cs.cmu.edu, NSF
EIA-0196217): markers, skeleton, body and two of the angles, drawn by the report's own player in a
Chromium without a window. Recordings are never part of the project; this is a picture of one.
"""

import argparse
import io
import json
import os
import shutil
import sys
from pathlib import Path

from docs.make_picture import SCRIPTS, asset
from PIL import Image
from playwright.sync_api import sync_playwright

from kinesphere.data import Solution
from kinesphere.io import read
from kinesphere.pipeline import solve
from kinesphere.report.scene import scene_from_solution

ANIMATION = Path(__file__).parent / "images" / "motion.webp"
RECORDING = "cmu41/02_05.c3d"
WIDTH, HEIGHT = 720, 360
SPAN = (2.0, 6.0)  # s of the recording
RATE = 20.0  # Hz of the animation
JOINTS = ("right_elbow", "right_shoulder")
QUALITY = 62

_STYLE = """
body { margin: 0; padding: 0; max-width: none; background: #fff; }
.picture { box-sizing: border-box; width: %dpx; height: %dpx; padding: 12px; display: grid;
  gap: 12px; grid-template-columns: 336px 1fr; background: #f5f6f8; }
.viewport { border: 1px solid var(--line); border-radius: 12px; background: #eef2f8; }
.viewport canvas { width: 100%%; height: 100%%; display: block; }
.stack { display: grid; gap: 10px; grid-template-rows: 1fr 1fr; }
.stack .chart { margin: 0; padding: 8px 11px 2px; border-radius: 12px; }
.stack .chart canvas { height: 118px; }
"""
_DRAW = """
(async () => {
  const scene = JSON.parse(document.querySelector("#scene").textContent);
  const names = Object.keys(scene.arrays);
  const arrays = await Promise.all(names.map((name) => unpack(scene.arrays[name])));
  const data = Object.fromEntries(names.map((name, i) => [name, arrays[i]]));
  const theme = themeFromStyles();
  const { span, joints } = JSON.parse(document.querySelector("#wanted").textContent);
  const player = new Player(document.querySelector(".viewport canvas"), scene, data, theme);
  player.show = { markers: true, bones: true, mesh: true };
  player.frame = Math.round(span[0] * scene.rate);
  player.reset(-0.55, 0.1);
  player.camera.distance *= 0.78;
  player.follow = false;
  player.camera.target = add(player.centreAt(player.frame), [0.05, 0.1, 0]);
  const view = new TimeView(scene.n_frames / scene.rate);
  view.show(...span);
  const charts = [...document.querySelectorAll(".chart")].map((element, i) => {
    const chart = new Chart(element, joints[i], scene, data, view, theme);
    chart.residualHeight = -6;
    chart.paintResidual = () => {};
    chart.draw();
    return chart;
  });
  window.show = (time) => {
    const frame = Math.round(time * scene.rate);
    player.draw(frame);
    charts.forEach((chart) => chart.point(frame));
  };
  document.body.classList.add("ready");
})();
"""


def main() -> int:
    """Solve the recording, photograph its frames, write the animation."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--chromium", default=shutil.which("chromium") or "chromium")
    parser.add_argument("--data", type=Path, default=os.environ.get("KINESPHERE_DATA"))
    arguments = parser.parse_args()
    if arguments.data is None:
        parser.error("set KINESPHERE_DATA, or --data, to where the recordings are")
    solution = solve(read(arguments.data / RECORDING))
    pictures = photographs(page_html(solution), arguments.chromium)
    pictures[0].save(
        ANIMATION, save_all=True, append_images=pictures[1:], duration=round(1000 / RATE),
        loop=0, quality=QUALITY, method=4,
    )  # fmt: skip
    return 0


def photographs(html: str, chromium: str) -> list[Image.Image]:
    """Return what the page looks like at every time of the animation."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=chromium,
            args=["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
        )
        page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
        page.set_content(html)
        page.wait_for_selector("body.ready")
        shown = []
        for k in range(round((SPAN[1] - SPAN[0]) * RATE)):
            page.evaluate("time => show(time)", SPAN[0] + k / RATE)
            shown.append(Image.open(io.BytesIO(page.screenshot())).convert("RGB"))
        browser.close()
    return shown


def page_html(solution: Solution) -> str:
    """Return the page that is photographed."""
    names = solution.skeleton.joint_names
    joints = [names.index(name) for name in JOINTS]
    wanted = {"span": SPAN, "joints": joints}
    charts = "".join(
        f'<article class="card chart"><h3>{name.replace("_", " ")}<span class="values">'
        + "".join(
            f'<span class="value axis{k + 1}" data-series="{k}"></span>'
            for k in range(solution.skeleton.joints[j].n_axes)
        )
        + '<span class="value twist" data-series="3"></span></span></h3>'
        '<div class="plot"><canvas></canvas><i class="cursor"></i></div></article>'
        for name, j in zip(JOINTS, joints, strict=True)
    )
    helpers = asset("page.js").partition("\nasync function start")[0]
    scripts = "\n".join([*map(asset, SCRIPTS), helpers, _DRAW])
    return (
        '<!doctype html><meta charset="utf-8">'
        f"<style>{asset('page.css')}{_STYLE % (WIDTH, HEIGHT)}</style>"
        '<div class="picture"><div class="viewport"><canvas></canvas></div>'
        f'<div class="stack">{charts}</div></div>'
        f'<script type="application/json" id="scene">{json.dumps(scene_from_solution(solution))}'
        f'</script><script type="application/json" id="wanted">{json.dumps(wanted)}</script>'
        f"<script>{scripts}</script>"
    )


if __name__ == "__main__":
    sys.exit(main())
