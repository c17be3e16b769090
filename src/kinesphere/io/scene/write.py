"""A scene as a folder: ``SCENE.toml``, calibration, images or videos, masks and plates."""

import json
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

from kinesphere.data import Scene
from kinesphere.errors import BadSetting
from kinesphere.io.atomic import replacing_directory
from kinesphere.io.calibration import write_calibration
from kinesphere.io.images import write_image
from kinesphere.io.video import VideoWriter

KINDS = ("png", "jpg", "mkv", "mp4")
"""How images are kept: files without and with loss, a video without and with loss."""
_VIDEOS = {"mkv": None, "mp4": 16}
"""Quality of the kinds that are videos."""


def write_scene(
    scene: Scene,
    directory: str | Path,
    images: str = "mp4",
    progress: Callable[[str, int, int], None] | None = None,
) -> Path:
    """Write a scene with all its images; return the path of its ``SCENE.toml``.

    Parameters
    ----------
    directory
        A new or empty folder, or one that such a scene was written to before.
    images
        One of ``KINDS``. Masks are always PNG files.
    progress
        Told of frames.

    Raises
    ------
    BadSetting
        If there is no such kind.
    """
    if images not in KINDS:
        raise BadSetting(f"images = {images!r}; known are {', '.join(KINDS)}")
    with replacing_directory(directory, _others) as folder:
        _write_images(scene, folder, images, progress)
        write_calibration(scene.cameras, folder / "calibration.toml")
        (folder / "SCENE.toml").write_text(_scene_toml(scene, folder, images), encoding="utf-8")
    return Path(directory) / "SCENE.toml"


def _others(folder: Path) -> list[str]:
    """Return everything in a folder that is no scene's."""
    ours = (folder / "SCENE.toml").is_file() and (folder / "calibration.toml").is_file()
    return [] if ours else [entry.name for entry in folder.iterdir()]


def _write_images(
    scene: Scene, folder: Path, kind: str, progress: Callable[[str, int, int], None] | None
) -> None:
    video = kind in _VIDEOS
    for camera, plate in zip(scene.cameras, scene.plates, strict=True):
        if not video:
            (folder / camera.name).mkdir()
        if plate is not None:
            write_image(plate, folder / f"{camera.name}_plate.png")
    with ExitStack() as stack:
        films = [
            stack.enter_context(VideoWriter(folder / f"{c.name}.{kind}", scene.rate, _VIDEOS[kind]))
            if video
            else None
            for c in scene.cameras
        ]
        for frame in scene.frames():
            if progress is not None:
                progress("writing", frame.index, scene.n_frames)
            name = f"{frame.index:06d}"
            for c, camera in enumerate(scene.cameras):
                image, film = frame.images[c], films[c]
                if image is not None and film is not None:
                    film.add(image)
                elif image is not None:
                    write_image(image, folder / camera.name / f"{name}.{kind}")
                for what, mask in (
                    ("masks", frame.masks[c]),
                    ("reference_masks", frame.references[c]),
                ):
                    if mask is not None:
                        place = folder / f"{camera.name}_{what}"
                        place.mkdir(exist_ok=True)
                        write_image(mask, place / f"{name}.png")


def _scene_toml(scene: Scene, folder: Path, kind: str) -> str:
    lines = [
        f"name = {json.dumps(scene.name)}",
        'calibration = "calibration.toml"',
        f"rate_hz = {scene.rate!r}",
    ]
    for camera in scene.cameras:
        images = f"{camera.name}.{kind}" if kind in _VIDEOS else camera.name
        lines += [
            "",
            "[[camera]]",
            f"name = {json.dumps(camera.name)}",
            f"images = {json.dumps(images)}",
        ]
        if (folder / f"{camera.name}_plate.png").is_file():
            lines.append(f"plate = {json.dumps(f'{camera.name}_plate.png')}")
        for what in ("masks", "reference_masks"):
            if (folder / f"{camera.name}_{what}").is_dir():
                lines.append(f"{what} = {json.dumps(f'{camera.name}_{what}')}")
        if kind in _VIDEOS:
            lines.append("first_mask = 0")
    body = scene.body
    lines += ["", "[body]", f"model = {json.dumps(body.model)}", f"mesh = {json.dumps(body.mesh)}"]
    if body.height is not None:
        lines.append(f"height_m = {body.height!r}")
    lines.append(f"fit = {json.dumps(body.fit)}")
    return "\n".join(lines) + "\n"
