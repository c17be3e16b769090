"""``python -m benchmarks.accuracy.mesh``: measure the surface, write ``docs/results/mesh.md``."""

import json
import os
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.accuracy.mesh.brought import brought_bodies
from benchmarks.accuracy.mesh.measures import (
    TWIST_JOINTS,
    distances,
    naive_blend,
    twisted_forearm,
)
from benchmarks.accuracy.mesh.page import page
from kinesphere import __version__, bundled_body, read, skin, solve
from kinesphere.data import Motion, Solution, motion_from_parameters
from kinesphere.editing import attach_surface
from kinesphere.editing.mesh.merging import on_limbs_of
from kinesphere.editing.mesh.proportions import begins_of, fit_limbs
from kinesphere.editing.mesh.shape import fit_shape
from kinesphere.editing.mesh.skin import bind_transforms
from kinesphere.editing.mesh.standing import ups_while_standing
from kinesphere.editing.mesh.untangle import inverted_faces
from kinesphere.geometry.skinning import dual_quaternion_blend, linear_blend
from kinesphere.io.gltf import write_gltf
from kinesphere.synthetic import make_performance

ROOT = Path(__file__).parents[3]
RECORDINGS = ("02_05", "06_01", "85_02", "135_02")
LOOKED_AT = 40  # frames of each recording, evenly spaced
FRAMES = 24_000


def main() -> int:
    """Measure, write ``mesh.json`` and ``mesh.md``; 1 if something is missed."""
    folder = Path(os.environ.get("KINESPHERE_DATA", ROOT.parent / "shared" / "data"))
    if not folder.is_dir():
        print(f"no real recordings at {folder}; KINESPHERE_DATA names them", file=sys.stderr)
        return 2
    solutions = {name: solve(read(folder / f"cmu41/{name}.c3d")) for name in RECORDINGS}
    found = {
        "version": __version__,
        "inverted": {
            name: _inverted(solution.motion)
            for name, solution in (solutions | _others(folder)).items()
        },
        "twist": [_twist(solutions, degrees) for degrees in (45, 90, 135)],
        "brought": brought_bodies(folder, solutions["06_01"].motion),
        "markers": {name: _markers(solution) for name, solution in solutions.items()},
        "skinning": _skinning(solutions["02_05"]),
        "glb": _glb(),
    }
    text = json.dumps(found, indent=1) + "\n"
    (ROOT / "benchmarks" / "results" / "mesh.json").write_text(text, encoding="utf-8")
    text, missed = page(found)
    (ROOT / "docs" / "results" / "mesh.md").write_text(text, encoding="utf-8")
    print(text)
    return int(missed)


def _others(folder: Path) -> dict[str, Solution]:
    """Solve people of another layout, whose skeletons are otherwise wrong."""
    return {path.stem: solve(read(path)) for path in sorted(folder.glob("plugin-gait/*.c3d"))}


def _inverted(motion: Motion) -> dict[str, int]:
    """Count the triangles that look away from where their limb took them."""
    body = on_limbs_of(bundled_body(), motion.skeleton)
    body = body.shaped(fit_shape(body, begins_of(motion.skeleton)))
    turns = fit_limbs(body, motion.skeleton, ups_while_standing(motion)).turns
    surface = attach_surface(motion)
    turned = inverted_faces(surface.vertices, surface.faces, surface.weights, body.vertices, turns)
    return {"faces": len(surface.faces), "inverted": int(turned.sum())}


def _twist(solutions: dict[str, Solution], degrees: float) -> dict[str, Any]:
    """Take the worst of all recordings and both sides."""
    row: dict[str, Any] = {"degrees": degrees}
    for blend in ("linear", TWIST_JOINTS, "dual-quaternion"):
        kept = [
            twisted_forearm(attach_surface(solution.motion), side, sign * degrees, blend)
            for solution in solutions.values()
            for side in ("left", "right")
            for sign in (1, -1)
        ]
        row[blend] = {
            "volume": min(volume for volume, _ in kept),
            "section": min(section for _, section in kept),
        }
    return row


def _markers(solution: Solution) -> dict[str, Any]:
    """Return distances of all markers that belong to a limb, over frames and by limb."""
    surface, motion = attach_surface(solution.motion), solution.motion
    frames = np.unique(np.linspace(0, motion.n_frames - 1, LOOKED_AT).astype(np.intp))
    vertices = skin(surface, motion, frames)
    by_limb: dict[str, list[float]] = {}
    for limb in motion.skeleton.limbs:
        at = solution.recording.columns(limb.markers)
        for frame, shape in zip(frames, vertices, strict=True):
            points = solution.recording.markers[frame, at]
            points = points[np.isfinite(points).all(axis=1)]
            found = distances(points, shape, surface.faces)
            by_limb.setdefault(limb.name, []).extend(found.tolist())
    every = np.concatenate([np.array(values) for values in by_limb.values()])
    return {
        "samples": len(every),
        "median_mm": 1e3 * float(np.median(np.abs(every))),
        "p95_mm": 1e3 * float(np.percentile(np.abs(every), 95)),
        "inside_percent": 100 * float((every < 0).mean()),
        "by_limb_mm": {
            name: 1e3 * float(np.median(np.abs(values))) for name, values in by_limb.items()
        },
    }


def _skinning(solution: Solution) -> dict[str, float]:
    """Return ms a frame of the kernels and of NumPy's twin, and how far apart they are."""
    surface = attach_surface(solution.motion)
    frames = np.arange(100)
    rotations, shifts = bind_transforms(surface, solution.motion, frames)
    given = surface.vertices, surface.weight_limbs, surface.weight_shares, rotations, shifts
    apart = np.abs(linear_blend(*given) - naive_blend(*given)).max()
    return {
        "vertices": surface.n_vertices,
        "linear_ms": _milliseconds(lambda: linear_blend(*given)) / len(frames),
        "dual_quaternion_ms": _milliseconds(lambda: dual_quaternion_blend(*given)) / len(frames),
        "numpy_ms": _milliseconds(lambda: naive_blend(*given)) / len(frames),
        "apart_m": float(apart),
    }


def _glb() -> dict[str, float]:
    """Return how long ``motion.glb`` of a long take takes, markers and body included."""
    made = make_performance(np.random.default_rng(0), rate=120.0, calibration_s=8.0, free_s=2.0)
    motion = motion_from_parameters(made.parameters)
    at = np.arange(FRAMES) % motion.n_frames
    long = replace(
        motion,
        **{name: getattr(motion, name)[at] for name in ("rotations", "origins", "flags")},
        residuals=motion.residuals[at],
    )
    markers = replace(
        made.recording, markers=made.recording.markers[at], residuals=None, confidence=None
    )
    surface = attach_surface(motion)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "motion.glb"
        seconds = _milliseconds(lambda: write_gltf(long, path, surface, markers)) / 1e3
        size = path.stat().st_size
    return {
        "frames": FRAMES,
        "limbs": len(motion.skeleton.limbs),
        "markers": markers.n_markers,
        "seconds": seconds,
        "megabytes": size / 1e6,
    }


def _milliseconds(work: Callable[[], object]) -> float:
    """Return the least processor time of three runs after one that warms up."""
    work()
    times = []
    for _ in range(3):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return 1e3 * min(times)


if __name__ == "__main__":
    sys.exit(main())
