"""``python -m benchmarks.markerless.losses``: limbs put wrong noticed, right ones doubted.

Films and real footage are tracked; in some frames an arm or a leg is then put elsewhere on purpose,
turned at one joint, and judged. Beside the rule in use stands the one that judges a hand by itself.
Writes ``docs/results/markerless-losses.md``.
"""

import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from benchmarks.markerless.given_start import disturbed_start
from benchmarks.markerless.real_scenes import DATA, write_pose2sim_scene
from kinesphere.data import Array, BodyChoice, Mask, Scene, bundled_body
from kinesphere.io import replacing
from kinesphere.io.scene import read_scene
from kinesphere.markerless.anatomy import full_body
from kinesphere.markerless.eyes import fitter_for
from kinesphere.markerless.first_pose import FirstPose, first_pose
from kinesphere.markerless.pose import Pose, Posed, limited, moved, posed
from kinesphere.markerless.recovery import LIMBS, held_lost
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.shape import shaped
from kinesphere.markerless.tracking import Found, Tracking
from kinesphere.synthetic.film import make_film

PAGE = Path(__file__).parents[2] / "docs" / "results" / "markerless-losses.md"
FILMS = (("arms", "plain", 1), ("arms", "clutter", 2), ("push-ups", "hidden", 3))
BANDS = (0.1, 0.15, 0.25, np.inf)
"""m, by which the hand or foot is displaced."""
_EVERY, _DRAWN = 8, 4
"""Frames between those in which limbs are put wrong, and how often each joint is turned there."""
_TURNS = (0.4, 1.5)
"""rad, least and most."""


@dataclass
class Verdicts:
    """What was held lost: of each rule, (in use, a hand by itself)."""

    name: str
    right: list[tuple[bool, bool]] = field(default_factory=list)
    """Of frames as they were tracked: whether any limb is."""
    wrong: list[tuple[float, bool, bool]] = field(default_factory=list)
    """Of limbs put wrong: m, and whether one of those that went along is."""
    wrists: list[tuple[bool, bool]] = field(default_factory=list)
    """Of hands turned by the wrist alone, their ends by ``BANDS[0]`` or more."""


def verdicts(name: str, scene: Scene, start: FirstPose, n_frames: int) -> Verdicts:
    """Track, and judge what was found and what was put wrong."""
    settings = TrackSettings()
    body = full_body(shaped(bundled_body(), start.logs))
    chain, rng = body.chain, np.random.default_rng(5)
    fitter = fitter_for(body, scene.cameras, settings, masks=False)
    tracking, out = Tracking(fitter, start.pose), Verdicts(name)
    reach = body.ends - chain.centres

    def rules(found: Found, limbs: list[int]) -> tuple[bool, bool]:
        alone: Mask = held_lost(found.support, found.gain, settings)
        return bool(found.lost[limbs].any()), bool(alone[limbs].any())

    def end_of(at: Posed, limb: int) -> Array:
        return np.asarray(at.centres[limb] + at.rotations[limb] @ reach[limb])

    first = scene.start.frame
    for frame in scene.frames(first, min(first + n_frames, scene.n_frames)):
        found = (
            tracking.begin(frame.images) if frame.index == first else tracking.step(frame.images)
        )
        out.right.append(rules(found, list(range(len(chain.links)))))
        if (frame.index - first) % _EVERY:
            continue
        at = posed(chain, found.pose)
        for limbs in _limbs(chain.limb_names):
            for k, limb in enumerate(limbs):
                for _ in range(_DRAWN):
                    other = _turned(tracking, found.pose, limb, rng)
                    there = posed(chain, other)
                    wrist_only = k == len(limbs) - 1
                    last = limbs[-1]
                    off = (
                        end_of(there, last) - end_of(at, last)
                        if wrist_only
                        else there.centres[last] - at.centres[last]
                    )
                    if (far := float(np.linalg.norm(off))) < BANDS[0]:
                        continue
                    said = rules(tracking.judged(other), limbs[k:])
                    if not wrist_only:
                        out.wrong.append((far, *said))
                    elif chain.limb_names[limb].endswith("hand"):
                        out.wrists.append(said)
    return out


def _limbs(names: tuple[str, ...]) -> Iterator[list[int]]:
    for side in ("left", "right"):
        for limbs in LIMBS.values():
            yield [names.index(f"{side}_{limb}") for limb in limbs]


def _turned(tracking: Tracking, pose: Pose, limb: int, rng: np.random.Generator) -> Pose:
    chain = tracking.fitter.body.chain
    step, dofs = np.zeros(chain.n_dofs), np.flatnonzero(chain.dof_limbs == limb)
    way = rng.normal(size=len(dofs))
    step[dofs] = way / np.linalg.norm(way) * rng.uniform(*_TURNS)
    return limited(chain, moved(chain, pose, step))


def page(all_found: list[Verdicts]) -> str:
    """Return the page as Markdown."""
    bands = [
        f"{low * 1e3:.0f}–{high * 1e3:.0f} mm" if np.isfinite(high) else f"over {low * 1e3:.0f} mm"
        for low, high in pairwise(BANDS)
    ]
    lines = [
        "# Lost limbs, noticed and doubted",
        "",
        "Written by `python -m benchmarks.markerless.losses`. *Doubted*: frames in which a limb is "
        "held lost though none was put wrong. *Noticed*: of arms and legs put wrong on purpose, "
        "turned at shoulder, elbow, hip or knee by 23° to 86°, those of which a part that went "
        "along is held lost, by how far the hand or foot is off. *Wrists*: the same of hands that "
        f"are turned by the wrist alone and whose ends are off by {BANDS[0] * 1e3:.0f} mm or more. "
        "Each pair is of the rule in use, which judges a hand together with its forearm, and of "
        "the one that judges it by itself.",
        "",
        f"| footage | frames | doubted | {' | '.join(f'noticed, {b}' for b in bands)} | wrists |",
        "|---|--:|--:|" + "--:|" * (len(bands) + 1),
    ]
    for one in all_found:
        shares = [_pair([v[1:] for v in one.wrong if low <= v[0] < high])
                  for low, high in pairwise(BANDS)]  # fmt: skip
        lines.append(
            f"| {one.name} | {len(one.right)} | {_pair(one.right)} | {' | '.join(shares)} | "
            f"{_pair(one.wrists)} |"
        )
    return "\n".join(lines) + "\n"


def _pair(said: list[tuple[bool, bool]]) -> str:
    if not said:
        return "–"
    now, alone = np.mean(said, axis=0)
    return f"{now:.1%} / {alone:.1%} of {len(said)}"


def main() -> int:
    """Measure all, write the page."""
    found = []
    for movement, conditions, seed in FILMS:
        film = make_film(seed, movement, conditions=conditions, n_frames=41)
        scene = replace(film.scene, body=BodyChoice(fit=False))
        name = f"{movement}, {conditions}"
        found.append(verdicts(name, scene, disturbed_start(film, bundled_body(), seed), 41))
        print(found[-1].name, len(found[-1].wrong), flush=True)
    if DATA.is_dir():
        with tempfile.TemporaryDirectory() as folder:
            scene = read_scene(write_pose2sim_scene(Path(folder), masks=True))
            shot = scene.frame(scene.start.frame)
            start = first_pose(scene, bundled_body(), full_body, TrackSettings(), shot)
            found.append(verdicts("pose2sim", scene, start, scene.n_frames))
    with replacing(PAGE) as partial:
        partial.write_text(page(found), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
