"""A film as files, with its truth: ``kinesphere track FOLDER/SCENE.toml -o OUT`` runs on it.

    python -m benchmarks.markerless.film FOLDER [--movement arms] [--conditions plain] [--seed 1]

``truth.npz`` beside it holds the limbs' names, joint centres and turns, and the elbows' angles;
``markers.c3d`` and ``markers.json`` are what a marker system would have recorded, and its model:

    kinesphere solve FOLDER/markers.c3d --model FOLDER/markers.json -o MARKERS
    kinesphere compare MARKERS OUT --joint left_elbow -o both.html
"""

import argparse
from pathlib import Path

import numpy as np

from benchmarks.markerless.keypoints import write_keypoints
from kinesphere.data import bundled_body
from kinesphere.io import replacing, write_c3d
from kinesphere.io.model_json import write_model
from kinesphere.io.scene import write_scene
from kinesphere.synthetic.film import (
    CONDITIONS,
    MOVEMENTS,
    Film,
    another_person,
    make_film,
    marker_model,
    markers_of,
)


def write_film(film: Film, folder: Path, images: str = "mp4") -> Path:
    """Write a film and its truth; return the path of its ``SCENE.toml``."""
    path = write_scene(film.scene, folder, images)
    surface, motion = film.motion.surface, film.motion
    with replacing(folder / "truth.npz") as partial, partial.open("wb") as file:
        np.savez(
            file,
            limbs=np.array(surface.limbs),
            parents=surface.parents,
            joint_centres=motion.joint_centres,
            turns=motion.turns,
            elbow_angles=film.elbow_angles,
            vertices=surface.vertices,
            rate=motion.rate,
        )
    write_c3d(markers_of(motion, np.random.default_rng(film.footage.seed)), folder / "markers.c3d")
    write_model(marker_model(surface), folder / "markers.json")
    return path


def main() -> None:
    """Make the film that the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--movement", default="arms", choices=sorted(MOVEMENTS))
    parser.add_argument("--conditions", default="plain", choices=sorted(CONDITIONS))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--frames", type=int, default=300)
    parser.add_argument("--cameras", type=int, default=4)
    parser.add_argument("--masks", action="store_true", help="with perfect masks to track by")
    parser.add_argument("--plates", action="store_true", help="with images of the empty room")
    parser.add_argument("--images", default="mp4", choices=("png", "jpg", "mkv", "mp4"))
    parser.add_argument("--other", action="store_true", help="a person built unlike the model")
    parser.add_argument(
        "--keypoints",
        type=float,
        help="to start from, as an estimator off by so many px finds them",
    )
    asked = parser.parse_args()
    body = bundled_body()
    film = make_film(
        asked.seed,
        asked.movement,
        conditions=asked.conditions,
        n_frames=asked.frames,
        n_cameras=asked.cameras,
        masks=asked.masks,
        plates=asked.plates,
        surface=another_person(body, np.random.default_rng(asked.seed)) if asked.other else body,
    )
    path = write_film(film, asked.folder, asked.images)
    if asked.keypoints is not None:
        place = asked.folder / "keypoints"
        write_keypoints(film, place, asked.seed, asked.keypoints, asked.frames)
        path.write_text(path.read_text() + '\n[start]\nkeypoints = "keypoints"\n')
    print(path)


if __name__ == "__main__":
    main()
