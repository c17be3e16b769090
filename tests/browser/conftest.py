"""A Chromium without a window, and pages in it that confess every complaint and every request."""

import os
import shutil
import time
from pathlib import Path

import numpy as np
import pytest

from kinesphere.io import write_solution
from kinesphere.pipeline import solve
from kinesphere.report import report_html
from kinesphere.synthetic import make_performance

ARGUMENTS = [
    "--no-sandbox",
    "--headless=new",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
PATIENCE = 60.0
"""s after which something is called not to happen."""


def until(met, *arguments):
    """Wait until something is true; a page that forbids eval cannot be asked to wait itself."""
    end = time.monotonic() + PATIENCE
    while not (found := met(*arguments)):
        assert time.monotonic() < end, f"{met} did not come true in {PATIENCE:.0f} s"
        time.sleep(0.02)
    return found


def chromium():
    """Return where Chromium is; skip where it is not, unless that is forbidden."""
    found = os.environ.get("KINESPHERE_CHROMIUM") or shutil.which("chromium")
    if found and Path(found).exists():
        return found
    if os.environ.get("KINESPHERE_DATA_REQUIRED"):
        pytest.fail("browser tests are required, but there is no chromium on the PATH")
    return pytest.skip("there is no chromium on the PATH; set KINESPHERE_CHROMIUM")


@pytest.fixture(scope="module")
def browser():
    """Return one browser a module: playwright's event loop must not outlive those who use it."""
    if os.environ.get("KINESPHERE_DATA_REQUIRED"):
        from playwright.sync_api import sync_playwright
    else:
        sync_playwright = pytest.importorskip("playwright.sync_api").sync_playwright
    path = chromium()
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=path, args=ARGUMENTS)
        yield started
        started.close()


class Watched:
    """A page, and what it complained of and asked for."""

    def __init__(self, page):
        self.page, self.complaints, self.requests = page, [], []
        self.until = until
        page.on("console", self._heard)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("request", lambda request: self.requests.append(request.url))

    def _heard(self, message):
        if message.type in ("error", "warning"):
            self.complaints.append(message.text)


@pytest.fixture
def watch(browser):
    """Return a function that opens a page with the options of a browser context."""
    contexts = []

    def opened(**options):
        context = browser.new_context(**{"viewport": {"width": 1280, "height": 860}, **options})
        contexts.append(context)
        return Watched(context.new_page())

    yield opened
    for context in contexts:
        context.close()


@pytest.fixture(name="until")
def _until():
    return until


@pytest.fixture(scope="session")
def solution():
    true = make_performance(np.random.default_rng(3), rate=20.0, calibration_s=12.0, free_s=3.0)
    markers = np.array(true.recording.markers)
    markers[60:75, 3] = np.nan
    recording = type(true.recording)(**{**true.recording.__dict__, "markers": markers})
    return solve(recording, true.model, calibration=true.calibration)


@pytest.fixture(scope="session")
def solved(solution, tmp_path_factory):
    folder = tmp_path_factory.mktemp("browser") / "walk"
    write_solution(solution, folder, {"report.html": report_html(solution, "walk.c3d")})
    return folder
