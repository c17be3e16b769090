"""What must not change a motion: the order of cameras, the choice of axes, the direction of time.

    python -m benchmarks.markerless.laws [--frames 40] [--page docs/results/markerless-laws.md]

One film of arms swinging, tracked as it is, with its cameras in another order, with world and
cameras turned and shifted, and from its end to its beginning; each from a pose off by 2° and 8 mm.
"""

import argparse
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from benchmarks.markerless.given_start import disturbed_start
from kinesphere.data import Array, BodyChoice, Frame, Scene, StartChoice, bundled_body
from kinesphere.io import replacing
from kinesphere.markerless import TrackedMotion
from kinesphere.markerless.first_pose import FirstPose
from kinesphere.markerless.tracker import track
from kinesphere.synthetic.film import Film, make_film

PAGE = Path("docs/results/markerless-laws.md")
TURN, SHIFT = Rotation.from_rotvec([0.3, -1.1, 0.4]).as_matrix(), np.array([3.0, -1.0, 2.0])


@dataclass(frozen=True)
class Kept:
    """Frames in memory, their images in another order of cameras."""

    shots: tuple[Frame, ...]
    order: tuple[int, ...]

    def frames(self, start: int, stop: int, step: int = 1) -> Iterator[Frame]:
        """Yield frames as footage does."""
        for shot in self.shots[start:stop:step]:
            one, two, three = (
                tuple(pictures[i] for i in self.order)
                for pictures in (shot.images, shot.masks, shot.references)
            )
            yield replace(shot, images=one, masks=two, references=three)


def apart(one: TrackedMotion, other: TrackedMotion) -> Array:
    """Return how far joint centres of two motions are from each other, (n_frames, n_limbs) mm."""
    return np.asarray(np.linalg.norm(one.origins - other.origins, axis=-1) * 1e3)


def laws(n_frames: int) -> dict[str, Array]:
    """Return, for each law, how far joint centres are from where it would have them, in mm."""
    film = make_film(1, "arms", n_frames=n_frames)
    shots, model = tuple(film.scene.frames()), bundled_body()
    order = tuple(range(len(film.scene.cameras)))
    start = disturbed_start(film, model, 1)

    def tracked(scene: Scene, order: tuple[int, ...], start: FirstPose) -> TrackedMotion:
        plain = replace(scene, footage=Kept(shots, order), body=BodyChoice(fit=False, height=1.0))
        return track(plain, model, start=start)

    plain = tracked(film.scene, order, start)
    mixed = order[::-1]
    cameras = tuple(film.scene.cameras[i] for i in mixed)
    permuted = tracked(replace(film.scene, cameras=cameras), mixed, start)
    there = tuple(camera.turned(TURN, SHIFT) for camera in film.scene.cameras)
    turned = tracked(replace(film.scene, cameras=there), order, _taken(start))
    back = replace(turned, origins=(turned.origins - SHIFT) @ TURN)
    last = FirstPose(plain.body.pose(plain.parameters[-1]), start.logs, float("nan"), "given")
    scene = replace(film.scene, start=StartChoice(frame=n_frames - 1))
    return {
        "cameras permuted": apart(plain, permuted),
        "world turned and shifted": apart(plain, back),
        "time reversed": apart(plain, tracked(scene, order, last)),
        "(the truth, for comparison)": _from_truth(plain, film),
    }


def _taken(start: FirstPose) -> FirstPose:
    balls = start.pose.balls.copy()
    balls[0] = TURN @ balls[0]
    position = TURN @ start.pose.position + SHIFT
    return replace(start, pose=replace(start.pose, balls=balls, position=position))


def _from_truth(tracked: TrackedMotion, film: Film) -> Array:
    centres = film.joint_centres
    at = {name: i for i, name in enumerate(tracked.limb_names)}
    off = [tracked.origins[:, at[name]] - centres[name] for name in tracked.limb_names[1:]]
    return np.asarray(np.linalg.norm(np.stack(off, axis=1), axis=-1) * 1e3)


def main() -> None:
    """Measure, print, write the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=40)
    parser.add_argument("--page", type=Path, default=PAGE)
    asked = parser.parse_args()
    lines = [
        "# What must not change a motion without markers",
        "",
        f"By `python -m benchmarks.markerless.laws`: arms swinging, {asked.frames} frames, tracked "
        "twice; how far joint centres of the two motions are apart.",
        "",
        "| what was changed | median | 95 % | most |",
        "|---|--:|--:|--:|",
    ]
    for name, off in laws(asked.frames).items():
        lines.append(
            f"| {name} | {np.median(off):.2f} mm | {np.quantile(off, 0.95):.2f} mm | "
            f"{off.max():.2f} mm |"
        )
    print("\n".join(lines))
    with replacing(asked.page) as partial:
        partial.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
