"""``python -m docs.make_viewer_picture``: the viewer with an arm being raised, for its page."""

import argparse
import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image
from playwright.sync_api import sync_playwright

from kinesphere.pipeline import solve
from kinesphere.synthetic import make_performance
from kinesphere.viewer import serve, take_from

PICTURES = Path(__file__).parent / "images"
SIZE = {"width": 1180, "height": 760}
JOINT, SLIDER, BY = "right_shoulder", 1, 60.0
FRAME = 90
SETTLED_MS = 5000  # software draws, and the first picture of a scene takes its time


def main() -> int:
    """Serve a synthetic actor, raise an arm, photograph the page, light or dark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--chromium", default=shutil.which("chromium") or "chromium")
    parser.add_argument("--dark", action="store_true", help="write viewer-dark.png instead")
    arguments = parser.parse_args()
    performance = make_performance(np.random.default_rng(1), layout="cmu41")
    solution = solve(performance.recording, calibration=performance.calibration)
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        server, viewer = serve(
            take_from(solution, "actor"), "actor", Path(folder) / "EDITS.toml", dark=arguments.dark
        )
        browser = playwright.chromium.launch(
            executable_path=arguments.chromium,
            args=["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
        )
        page = browser.new_page(viewport=SIZE)
        page.goto(f"http://127.0.0.1:{server.get_port()}")
        page.get_by_role("button", name="Play").wait_for()
        assert viewer.posing is not None
        viewer.seek(FRAME)
        viewer.posing.pick(solution.skeleton.joint_names.index(JOINT))
        viewer.posing.change(SLIDER, BY)
        page.wait_for_timeout(SETTLED_MS)
        for close in page.get_by_role("button", name="Close").all():  # a word about the software
            close.click()
        page.locator(".mantine-Notification-root").evaluate_all(
            "all => all.forEach(e => e.remove())"
        )
        name = "viewer-dark.png" if arguments.dark else "viewer.png"
        page.screenshot(path=PICTURES / name)
        browser.close()
        viewer.stop()
        server.stop()
    picture = Image.open(PICTURES / name).convert("RGB")
    picture.quantize(192).save(PICTURES / name, optimize=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
