"""Independent readers of glTF: Khronos' validator in Node, three.js in a browser."""

import hashlib
import json
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest

HERE = Path(__file__).parent
CACHE = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "kinesphere-tests"
BROWSER = (
    *("--no-sandbox", "--headless=new", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
    *("--ignore-gpu-blocklist", "--disable-quic", "--no-first-run", "--disable-sync"),
    *("--disable-background-networking", "--disable-component-update"),
)
_KINDS = {".js": "text/javascript", ".html": "text/html", ".glb": "model/gltf-binary"}


def lacking(why):
    """Skip, saying why, unless that is forbidden."""
    if os.environ.get("KINESPHERE_DATA_REQUIRED"):
        pytest.fail(f"required, but {why}")
    pytest.skip(why)


def tool(*names):
    """Return where one of these programs is."""
    found = next(filter(None, map(shutil.which, names)), None)
    return found or lacking(f"there is no {names[0]}")


@pytest.fixture(scope="session")
def node_modules():
    """Return the folder of the pinned npm packages, installed on first use."""
    pinned = (HERE / "package.json").read_bytes()
    folder = CACHE / f"gltf-{hashlib.sha256(pinned).hexdigest()[:12]}"
    if not folder.is_dir():
        npm = tool("npm")
        CACHE.mkdir(parents=True, exist_ok=True)
        fresh = Path(tempfile.mkdtemp(dir=CACHE))
        (fresh / "package.json").write_bytes(pinned)
        command = [npm, "install", "--no-package-lock", "--no-audit", "--no-fund", "--silent"]
        done = subprocess.run(
            command, cwd=fresh, capture_output=True, text=True, timeout=300, check=False
        )
        if done.returncode:
            shutil.rmtree(fresh)
            lacking(f"npm could not install {pinned.decode()}: {done.stderr.strip()}")
        try:
            fresh.rename(folder)  # another process may have been quicker
        except OSError:
            shutil.rmtree(fresh)
    return folder / "node_modules"


@pytest.fixture(scope="session")
def issues_of(node_modules):
    """Return a function: path → what Khronos' validator finds wrong."""
    node = tool("node")

    def issues(path):
        command = [node, HERE / "validate.js", node_modules, path]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
        return json.loads(done.stdout)["issues"]

    return issues


@pytest.fixture(scope="session")
def browser():
    """Return a headless Chromium without a GPU."""
    playwright = pytest.importorskip("playwright.sync_api")
    path = tool("chromium", "chromium-browser", "google-chrome")
    with playwright.sync_playwright() as session:
        opened = session.chromium.launch(executable_path=path, args=list(BROWSER))
        yield opened
        opened.close()


@pytest.fixture
def in_three(browser, node_modules):
    """Return a function: path of a GLB → a page that has it open in three.js."""
    pages = []

    def opened(path):
        def answer(route):
            asked = route.request.url.removeprefix("http://gltf.test/").split("?")[0]
            file = {"": HERE / "page.html", "motion.glb": path}.get(asked, node_modules / asked)
            if not file.is_file():
                return route.fulfill(status=404)
            return route.fulfill(body=file.read_bytes(), content_type=_KINDS.get(file.suffix, ""))

        page = browser.new_page()
        pages.append(page)
        troubles = []
        page.on("pageerror", lambda error: troubles.append(str(error)))
        page.route("http://gltf.test/**", answer)
        page.goto("http://gltf.test/")
        page.wait_for_function("window.ready", timeout=60_000)
        assert not troubles
        return page

    yield opened
    for page in pages:
        page.close()
