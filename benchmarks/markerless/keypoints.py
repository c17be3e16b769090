"""A pose estimator that is off by some pixels, and how good a start is by its keypoints.

    python -m benchmarks.markerless.keypoints [--noise 5] [--frames 10]

prints, for films on which the start from silhouettes fails, how far joint centres are off in the
first frame: by keypoints alone, and after the fit to the images.
"""

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np

from kinesphere.data import Array, BodyChoice, StartChoice, bundled_body
from kinesphere.data.keypoints import KEYPOINTS, SeenKeypoints
from kinesphere.io.json_files import write_json
from kinesphere.io.keypoints import SETS
from kinesphere.markerless.anatomy import full_body
from kinesphere.markerless.keypoint_marks import marks_of
from kinesphere.markerless.keypoint_start import pose_from_keypoints
from kinesphere.markerless.pose import posed
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.shape import FACTORS, shaped
from kinesphere.markerless.tracker import track
from kinesphere.synthetic.film import Film, another_person, make_film

MISSING, WRONG = 0.1, 0.05
"""Share of keypoints that a camera does not see, and that it sees elsewhere (by 80 px)."""
_FILMS = (("push-ups", "plain"), ("push-ups", "clutter"), ("arms", "clutter"))


def true_keypoints(film: Film, frame: int) -> Array:
    """Return where the person's keypoints are, (n_keypoints, 3) m."""
    motion = film.motion
    body = full_body(motion.surface)
    marks = marks_of(body)
    limbs = [motion.surface.limbs.index(body.chain.limb_names[i]) for i in marks.limbs]
    out = marks.places - motion.surface.joint_centres[limbs]
    turned = np.einsum("kij,kj->ki", motion.turns[frame, limbs], out)
    return np.asarray(motion.joint_centres[frame, limbs] + turned)


def seen_keypoints(film: Film, frame: int, seed: int, noise: float) -> SeenKeypoints:
    """Return what an estimator sees of a frame, off by ``noise`` px, gaps and blunders included."""
    rng = np.random.default_rng([seed, frame, 9])
    truth = true_keypoints(film, frame)
    pixels = np.array([camera.project(truth) for camera in film.scene.cameras])
    pixels += rng.normal(scale=noise, size=pixels.shape)
    confidence = rng.uniform(0.4, 1.0, pixels.shape[:2])
    confidence[rng.random(confidence.shape) < MISSING] = 0.0
    wrong = rng.random(confidence.shape) < WRONG
    pixels[wrong] += rng.normal(scale=80, size=(int(wrong.sum()), 2))
    pixels[confidence == 0] = np.nan
    return SeenKeypoints(pixels, confidence)


def write_keypoints(film: Film, folder: Path, seed: int, noise: float, n_frames: int) -> None:
    """Write BODY_25 as OpenPose does: a folder for each camera, a file for each frame."""
    names = SETS[25][1]
    for frame in range(n_frames):
        seen = seen_keypoints(film, frame, seed, noise)
        for c, camera in enumerate(film.scene.cameras):
            rows = np.zeros((len(names), 3))
            for i, name in enumerate(names):
                if name in KEYPOINTS and seen.confidence[c, k := KEYPOINTS.index(name)] > 0:
                    rows[i] = (*seen.pixels[c, k], seen.confidence[c, k])
            place = folder / f"{camera.name}_json"
            place.mkdir(parents=True, exist_ok=True)
            person = {"person_id": [-1], "pose_keypoints_2d": rows.ravel().round(3)}
            path = place / f"{camera.name}_{frame:012d}_keypoints.json"
            write_json({"version": 1.3, "people": [person]}, path)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--noise", type=float, default=5.0, help="px")
    parser.add_argument("--frames", type=int, default=10, help="tracked; 0: keypoints alone")
    noise, n_frames = vars(parser.parse_args()).values()
    model = bundled_body()
    print("film                 seed   keypoints mm   tracked mm   (mean, greatest; frame 0)")
    for movement, conditions in _FILMS:
        for seed in (1, 2, 3):
            person = another_person(model, np.random.default_rng([seed, 77]))
            film = make_film(seed, movement, conditions=conditions, surface=person)
            start = StartChoice(keypoints=seen_keypoints(film, 0, seed, noise))
            scene = replace(
                film.scene, n_frames=max(1, n_frames), start=start, body=BodyChoice(fit=True)
            )
            none = np.zeros(len(FACTORS))
            known = pose_from_keypoints(scene, model, none, TrackSettings(), sizes=True)
            chain = full_body(shaped(model, known.logs)).chain
            row = _errors(film, chain.limb_names, posed(chain, known.pose).centres)
            if n_frames:
                found = track(scene, model, TrackSettings())
                row += "   " + _errors(film, found.limb_names, found.origins[0])
            print(f"{movement + ', ' + conditions:20} {seed:4}   {row}", flush=True)


def _errors(film: Film, names: tuple[str, ...], centres: Array) -> str:
    limbs = film.motion.surface.limbs
    off = [
        1e3 * np.linalg.norm(centre - film.motion.joint_centres[0, limbs.index(name)])
        for name, centre in zip(names[1:], centres[1:], strict=True)
        if name in limbs
    ]
    return f"{np.mean(off):6.0f} {np.max(off):5.0f}"


if __name__ == "__main__":
    main()
