"""``python -m benchmarks.browser``: report and viewer, built, opened and played in a Chromium.

Writes ``browser.json`` and ``browser.md``. Needs Chromium and playwright.
"""

import argparse
import json
import os
import platform
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from playwright.sync_api import Browser, Page, sync_playwright

from benchmarks.browser.page import page
from benchmarks.speed.clock import median_seconds
from kinesphere import __version__
from kinesphere.data import Solution
from kinesphere.data.edits import Edit
from kinesphere.io import read, write_solution
from kinesphere.pipeline import solve
from kinesphere.report import report_html
from kinesphere.synthetic import make_performance, spoil_with_noise
from kinesphere.synthetic.layout import Layout
from kinesphere.viewer import EditedPoses, serve, take_from

ROOT = Path(__file__).parents[2]
FRAMES = 24_000
MINUTE_HZ = 120.0
WATCHED_S = 4.0
SIZE = {"width": 1280, "height": 800}
ARGUMENTS = (
    "--no-sandbox --headless=new --use-angle=swiftshader --enable-unsafe-swiftshader "
    "--ignore-gpu-blocklist --disable-quic --no-first-run --disable-background-networking "
    "--disable-component-update --disable-sync"
)
_DRAWN = """async seconds => {
  let drawn = 0, on = true;
  const count = () => { drawn += 1; if (on) requestAnimationFrame(count); };
  requestAnimationFrame(count);
  await new Promise(done => setTimeout(done, 1000 * seconds));
  on = false;
  return drawn / seconds;
}"""


def main() -> int:
    """Measure everything and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--chromium", default=shutil.which("chromium") or "chromium")
    arguments = parser.parse_args()
    long = _solution("bodies", n_frames=FRAMES)
    minute = _solution("cmu41", n_frames=round(60 * MINUTE_HZ), rate=MINUTE_HZ)
    results: dict[str, Any] = {
        "version": __version__,
        "python": platform.python_version(),
        "cores": os.cpu_count(),
        "load": os.getloadavg()[0],
        "reports": [_report("24,000 frames, 12 limbs", long),
                    _report("one minute at 120 Hz, CMU layout", minute)],
        "edits": _edits(long),
    }  # fmt: skip
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(
            executable_path=arguments.chromium, args=ARGUMENTS.split()
        )
        results["chromium"] = browser.version
        results["pages"] = []
        for name, solution in (("one minute at 120 Hz", minute), ("24,000 frames", long)):
            solved = Path(folder) / name.replace(" ", "-").replace(",", "")
            write_solution(solution, solved, {"report.html": report_html(solution, name)})
            results["pages"] += [
                {"what": "report", "take": name, **_open_report(browser, solved)},
                {"what": "viewer", "take": name, **_open_viewer(browser, solved)},
            ]
        browser.close()
    text = page(results)
    print(text)
    for target, content in (
        ("docs/results/browser.md", text),
        ("benchmarks/results/browser.json", json.dumps(results, indent=1) + "\n"),
    ):
        (ROOT / target).write_text(content, encoding="utf-8")
    return 0


def _solution(layout: Layout, **told: Any) -> Solution:
    performance = make_performance(np.random.default_rng(1), layout=layout, **told)
    recording = spoil_with_noise(performance.recording, np.random.default_rng(2))
    model = performance.model if layout == "bodies" else None
    return solve(recording, model, calibration=performance.calibration)


def _report(name: str, solution: Solution) -> dict[str, Any]:
    built, html = median_seconds(lambda: report_html(solution, name), 3)
    return {"take": name, "built_s": built, "bytes": len(html.encode())}


def _edits(solution: Solution) -> dict[str, float]:
    """Return how long a person waits for an edit of every frame to be seen, and for the next."""
    edit = Edit(joint="left_elbow", axis=1, add_deg=30.0)
    poses = EditedPoses(solution)

    def seen() -> object:
        poses.edit([edit])
        return poses.at(7)

    def ahead() -> float:
        poses.edit([edit])
        start = time.process_time()
        poses.prepare(100)
        return time.process_time() - start

    first, _ = median_seconds(seen, 5)
    chunks = [ahead() for _ in range(5)]
    return {"seen_s": first, "chunk_s": float(np.median(chunks))}


def _open_report(browser: Browser, solved: Path) -> dict[str, float]:
    shown = browser.new_page(viewport=SIZE)
    start = time.monotonic()
    shown.goto((solved / "report.html").as_uri())
    shown.wait_for_selector("body.ready")
    opened = time.monotonic() - start
    shown.keyboard.press("Space")
    drawn = shown.evaluate(_DRAWN, WATCHED_S)
    shown.keyboard.press("o")
    plain = shown.evaluate(_DRAWN, WATCHED_S)
    shown.close()
    return {"open_s": opened, "drawn_hz": drawn, "plain_hz": plain}


def _open_viewer(browser: Browser, solved: Path) -> dict[str, float]:
    start = time.monotonic()
    with subprocess.Popen(
        [sys.executable, "-m", "kinesphere", "view", str(solved), "--no-open", "--json"],
        stdout=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdout is not None
        lines = [process.stdout.readline()]
        while lines[-1].rstrip() != "}":
            lines.append(process.stdout.readline())
        served, used = time.monotonic() - start, _processor_seconds(process.pid)
        shown = browser.new_page(viewport=SIZE)
        shown.goto(json.loads("".join(lines))["address"])
        shown.get_by_role("button", name="Play").wait_for()
        opened = time.monotonic() - start
        shown.close()
        process.terminate()
    return {"served_s": served, "served_cpu_s": used, "open_s": opened, **_play(browser, solved)}


def _processor_seconds(pid: int) -> float:
    """Return the processor time of another process so far, as Linux tells it."""
    ticks = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()[11:13]
    return sum(map(int, ticks)) / os.sysconf("SC_CLK_TCK")


def _play(browser: Browser, solved: Path) -> dict[str, float]:
    server, viewer = serve(take_from(read(solved), solved.name), solved.name, solved / "edits")
    shown = browser.new_page(viewport=SIZE)
    shown.goto(f"http://127.0.0.1:{server.get_port()}")
    shown.get_by_role("button", name="Play").wait_for()
    shown.wait_for_timeout(3000)
    sent, drawn = _watch(shown, viewer)
    shown.get_by_role("checkbox", name="Body").uncheck()
    shown.wait_for_timeout(1000)
    plain = shown.evaluate(_DRAWN, WATCHED_S)
    shown.close()
    time.sleep(0.5)
    before, start, used = viewer.shown, time.monotonic(), time.process_time()
    time.sleep(WATCHED_S)  # nobody looks: what the server alone can do
    frames = viewer.shown - before
    alone = frames / (time.monotonic() - start)
    cost = (time.process_time() - used) / max(frames, 1)
    viewer.stop()
    server.stop()
    return {
        "sent_hz": sent,
        "drawn_hz": drawn,
        "plain_hz": plain,
        "alone_hz": alone,
        "frame_s": cost,
    }


def _watch(shown: Page, viewer: Any) -> tuple[float, float]:
    shown.get_by_role("button", name="Play").click()
    shown.wait_for_timeout(1000)
    before, start = viewer.shown, time.monotonic()
    drawn = shown.evaluate(_DRAWN, WATCHED_S)
    return (viewer.shown - before) / (time.monotonic() - start), drawn


if __name__ == "__main__":
    sys.exit(main())
