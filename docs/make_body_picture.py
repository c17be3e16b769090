"""``python -m docs.make_body_picture``: the body on a solved recording, as three.js shows it.

Needs a recording that does not ship with the project (``KINESPHERE_DATA``), Chromium, and npm,
which fetches three.js once.
"""

import argparse
import http.server
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
from functools import partial
from pathlib import Path

from playwright.sync_api import sync_playwright

from kinesphere.io import read
from kinesphere.io.gltf import write_gltf
from kinesphere.pipeline import solve

ROOT = Path(__file__).parents[1]
PICTURE = Path(__file__).parent / "images" / "body.png"
RECORDING = "cmu41/02_05.c3d"
TIMES = (0.0, 4.6, 7.4)  # s: standing, and two strikes
WIDTH, HEIGHT, APART = 760, 380, 1.25  # CSS pixels; m between figures
_BROWSER = (
    *("--no-sandbox", "--headless=new", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
    *("--ignore-gpu-blocklist", "--disable-quic", "--no-first-run", "--disable-sync"),
    *("--disable-background-networking", "--disable-component-update"),
)
_PAGE = """<!doctype html><style>body { margin: 0; }</style>
<script type="importmap">
  {"imports": {"three": "/node_modules/three/build/three.module.js",
               "three/addons/": "/node_modules/three/examples/jsm/"}}
</script>
<script type="module">
import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

const { poses, width, height, apart } = %s;
const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
renderer.setPixelRatio(2);
renderer.setSize(width, height);
renderer.shadowMap.enabled = true;
document.body.append(renderer.domElement);
const scene = new THREE.Scene();
scene.background = new THREE.Color(0xf5f6f8);
scene.add(new THREE.HemisphereLight(0xffffff, 0x9aa3b5, 1.6));
const wide = poses.length * apart;
const sun = new THREE.DirectionalLight(0xffffff, 2.2);
sun.position.set(-2, 6, 4);
sun.castShadow = true;
Object.assign(sun.shadow.camera, { left: -wide, right: wide, top: wide, bottom: -wide });
sun.shadow.mapSize.set(2048, 2048);
sun.shadow.normalBias = 0.02;
scene.add(sun);
const shade = new THREE.ShadowMaterial({ opacity: 0.22 });
const ground = new THREE.Mesh(new THREE.PlaneGeometry(60, 60), shade);
ground.rotation.x = -Math.PI / 2;
ground.receiveShadow = true;
scene.add(ground);
for (const [k, { file, time, turn }] of poses.entries()) {
  const { scene: shown, animations } = await new GLTFLoader().loadAsync(file);
  const mixer = new THREE.AnimationMixer(shown);
  mixer.clipAction(animations[0]).play();
  mixer.setTime(time);
  shown.updateMatrixWorld(true);
  const body = shown.getObjectByName("body");
  body.castShadow = body.receiveShadow = true;
  body.frustumCulled = false;
  const root = new THREE.Vector3().setFromMatrixPosition(body.skeleton.bones[0].matrixWorld);
  const front = new THREE.Vector3(1, 0, 0).transformDirection(body.skeleton.bones[0].matrixWorld);
  const holder = new THREE.Group(), turned = new THREE.Group();
  shown.position.set(-root.x, 0, -root.z);
  turned.rotation.y = turn - Math.atan2(-front.z, front.x) - Math.PI / 2;
  turned.add(shown);
  holder.add(turned);
  holder.position.set((k - (poses.length - 1) / 2) * apart, 0, 0);
  scene.add(holder);
}
const camera = new THREE.PerspectiveCamera(22, width / height, 0.1, 200);
camera.position.set(0, 1.35, 5.6);
camera.lookAt(0, 0.88, 0);
renderer.render(scene, camera);
window.ready = true;
</script>"""


def photograph(folder: Path, poses: list[dict[str, object]], picture: Path, chromium: str) -> None:
    """Draw poses side by side.

    Parameters
    ----------
    folder
        Holds ``node_modules`` and the files that the poses name.
    poses
        ``file``, ``time`` in s and ``turn`` in rad about the vertical, 0 from the front.
    """
    told = {"poses": poses, "width": WIDTH, "height": HEIGHT, "apart": APART}
    (folder / "index.html").write_text(_PAGE % json.dumps(told), encoding="utf-8")
    handler = partial(_Quiet, directory=str(folder))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        with sync_playwright() as session:
            browser = session.chromium.launch(executable_path=chromium, args=list(_BROWSER))
            page = browser.new_page(
                viewport={"width": WIDTH, "height": HEIGHT}, device_scale_factor=2
            )
            page.goto(f"http://127.0.0.1:{server.server_port}/")
            page.wait_for_function("window.ready", timeout=180_000)
            page.screenshot(path=str(picture))
            browser.close()
        server.shutdown()


def with_three(folder: Path) -> Path:
    """Install three.js, in the version the tests use, into a folder."""
    pinned = json.loads((ROOT / "tests" / "gltf" / "package.json").read_text(encoding="utf-8"))
    package = {"private": True, "dependencies": {"three": pinned["dependencies"]["three"]}}
    (folder / "package.json").write_text(json.dumps(package), encoding="utf-8")
    subprocess.run(
        ["npm", "install", "--no-package-lock", "--no-audit", "--no-fund", "--silent"],
        cwd=folder,
        check=True,
    )
    return folder


class _Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_: object) -> None:
        """Say nothing."""


def main() -> int:
    """Solve the recording, write its ``motion.glb``, draw three moments of it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--chromium", default=shutil.which("chromium") or "chromium")
    arguments = parser.parse_args()
    data = Path(os.environ.get("KINESPHERE_DATA", ROOT.parent / "shared" / "data"))
    if not (data / RECORDING).is_file():
        sys.exit(f"no {RECORDING} in {data}; KINESPHERE_DATA names the folder")
    solution = solve(read(data / RECORDING))
    with tempfile.TemporaryDirectory() as temporary:
        folder = with_three(Path(temporary))
        write_gltf(solution.motion, folder / "motion.glb", solution.surface)
        poses: list[dict[str, object]] = [
            {"file": "motion.glb", "time": time, "turn": 0.5} for time in TIMES
        ]
        photograph(folder, poses, PICTURE, arguments.chromium)
    return 0


if __name__ == "__main__":
    sys.exit(main())
