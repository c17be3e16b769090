"""Speed of the tracker by method and model, decoding and rendering apart, and where time goes.

    python -m benchmarks.markerless.speed [--frames 30] [--page docs/results/markerless-speed.md]

Processor time of one thread: wall time on shared cores follows the load.
"""

import argparse
import cProfile
import pstats
from dataclasses import dataclass, replace
from pathlib import Path
from time import process_time

import numpy as np

from kinesphere.data import BodyChoice, Frame, bundled_body
from kinesphere.markerless.anatomy import full_body
from kinesphere.markerless.contour_fit import ContourFitter
from kinesphere.markerless.eyes import fitter_for
from kinesphere.markerless.first_pose import first_pose
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.tracker import MODELS
from kinesphere.markerless.tracking import Tracking
from kinesphere.markerless.transfer import taken_over
from kinesphere.synthetic.film import Film, make_film

PAGE = Path("docs/results/markerless-speed.md")
REST = "arrays handed from one to the next"
"""What is no module's: NumPy and Python between them, copies, indices, sums."""
PAPER = 2.0
"""Frames a second of the paper's system: level sets, four cameras, 21 degrees of freedom, 2006."""
MODULES = {
    "what hides what (rasterizer)": (
        "raster.py:visible_faces",
        "contour.py:parts",
        "contour.py:project",
        "rim.py:draw",
    ),
    "rim": ("contour.py:rim", "rim.py:rim"),
    "lines and colours": ("lines.py:", "colour.py:colour_samples", "colours.py:samples"),
    "histograms": (
        "colour.py:count",
        "colour.py:blurred",
        "region.py:region_score",
        "colours.py:learn",
        "histograms.py:",
    ),
    "skin and normals": ("posing.py:",),
    "derivatives": (
        "jacobian.py:",
        "rim.py:derivatives",
        "rim.py:image_directions",
        "contour.py:image_directions",
    ),
    "equations and steps": (
        "solver.py:",
        "pose.py:",
        "turns.py:",
        "prediction.py:",
        "fit.py:",
        "linalg.py:",
    ),
    "level set": (
        "levelset.py:",
        "evolution.py:",
        "distance.py:",
        "cvtColor",
        "GaussianBlur",
        "region.py:log_ratios",
        "colours.py:ratios",
        "~:{distanceTransform}",
        "~:<built-in method distanceTransform>",
    ),
    "votes and contours": ("votes.py:", "contours.py:"),
    "image to view, smaller images": ("views.py:", "remap", "resize", "evidence.py:"),
}


@dataclass(frozen=True)
class Case:
    """One method with one model, and the frames a second it is to reach."""

    model: str
    method: str
    equations: str = "image"
    wanted: float = 0.0


CASES = (
    Case("upper", "region", wanted=25),
    Case("full", "region", wanted=18),
    Case("upper", "level-set", wanted=12),
    Case("upper", "level-set", "plucker", wanted=12),
    Case("upper", "coupled", wanted=3),
)


def measure(
    case: Case, film: Film, frames: list[Frame], begun: object
) -> tuple[float, dict[str, float]]:
    """Return frames a second, and the share of each module in percent."""
    settings = TrackSettings(method=case.method, equations=case.equations)
    body = MODELS[case.model](bundled_body())
    pose = begun
    if case.model != "full":
        pose = taken_over(full_body(bundled_body()).chain, begun, body.chain)
    fitter = fitter_for(body, film.scene.cameras, settings, masks=False)
    contours = None if case.method == "region" else ContourFitter(fitter, False)
    tracking = Tracking(fitter, pose, contours=contours)
    tracking.begin(frames[0].images)
    tracking.step(frames[1].images)
    half = 2 + (len(frames) - 2) // 2
    clock = process_time()
    for frame in frames[2:half]:
        tracking.step(frame.images)
    rate = (half - 2) / (process_time() - clock)
    profile = cProfile.Profile(process_time)
    profile.enable()
    for frame in frames[half:]:
        tracking.step(frame.images)
    profile.disable()
    spent = dict.fromkeys((*MODULES, REST), 0.0)
    for (file, _, function), (_, _, own, _, _) in pstats.Stats(profile).stats.items():
        where = f"{Path(file).name}:{function}"
        module = next((m for m, keys in MODULES.items() if any(k in where for k in keys)), REST)
        spent[module] += own
    total = sum(spent.values())
    return rate, {module: 100 * s / total for module, s in spent.items()}


def main() -> None:
    """Measure every case and write the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=30)
    parser.add_argument("--page", type=Path, default=PAGE)
    asked = parser.parse_args()
    film = make_film(1, "arms", n_frames=asked.frames)
    frames = list(film.scene.frames())
    scene = replace(film.scene, body=BodyChoice(fit=False), has_masks=True)
    masked = replace(frames[0], masks=frames[0].references)
    begun = first_pose(scene, bundled_body(), full_body, TrackSettings(), masked).pose
    results = [(case, *measure(case, film, frames, begun)) for case in CASES]
    asked.page.write_text(page(results, asked.frames), encoding="utf-8")
    print(asked.page.read_text(encoding="utf-8"))


def page(results: list[tuple[Case, float, dict[str, float]]], n_frames: int) -> str:
    """Return the page."""
    lines = [
        "# Speed of the tracker",
        "",
        f"By `python -m benchmarks.markerless.speed`: arms swinging, {n_frames} frames, four "
        "cameras of 640 × 480, one thread, processor time; decoding and rendering apart.",
        "",
        f"The paper's system did {PAPER:g} frames/s with level sets, four cameras and the 21 "
        "degrees of freedom of the upper model, on a computer of 2006.",
        "",
        "| model | unknowns | method | equations | frames/s | wanted | times the paper's |",
        "|---|--:|---|---|--:|--:|--:|",
    ]
    for case, rate, _ in results:
        wanted = f"{case.wanted:g}" + ("" if rate >= case.wanted else ", **missed**")
        theirs = "–"
        if (case.model, case.method) == ("upper", "level-set"):
            theirs = f"{rate / PAPER:.0f}"
        n = MODELS[case.model](bundled_body()).chain.n_dofs
        lines.append(
            f"| {case.model} | {n} | {case.method} | {case.equations} | {rate:.1f} | {wanted} "
            f"| {theirs} |"
        )
    lines += ["", "Where the time goes, in percent:", ""]
    heads = [f"{case.model}, {case.method}, {case.equations}" for case, _, _ in results]
    lines += ["| module | " + " | ".join(heads) + " |", "|---" * (len(heads) + 1) + "|"]
    for module in (*MODULES, REST):
        shares = [spent[module] for _, _, spent in results]
        if np.max(shares) >= 0.5:
            lines.append(f"| {module} | " + " | ".join(f"{s:.0f}" for s in shares) + " |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
