"""A scene as a folder: ``SCENE.toml``, calibration, images or videos, masks and plates."""

import json
from collections.abc import Callable
from contextlib import ExitStack
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from kinesphere.data import Image, Scene
from kinesphere.errors import BadSetting, MissingExtra
from kinesphere.io.atomic import replacing_directory
from kinesphere.io.calibration import write_calibration
from kinesphere.io.images import write_image

KINDS = ("png", "jpg", "mkv", "mp4")
"""How images are kept: files without and with loss, a video without and with loss."""
_CODECS = {"mkv": ("ffv1", "bgr0", {"g": "1"}), "mp4": ("libx264", "yuv420p", {"crf": "16"})}


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
    with replacing_directory(directory, _is_ours) as folder:
        _write_images(scene, folder, images, progress)
        write_calibration(scene.cameras, folder / "calibration.toml")
        (folder / "SCENE.toml").write_text(_scene_toml(scene, folder, images), encoding="utf-8")
    return Path(directory) / "SCENE.toml"


def _is_ours(folder: Path) -> bool:
    return (folder / "SCENE.toml").is_file() and (folder / "calibration.toml").is_file()


def _write_images(
    scene: Scene, folder: Path, kind: str, progress: Callable[[str, int, int], None] | None
) -> None:
    video = kind in _CODECS
    for camera, plate in zip(scene.cameras, scene.plates, strict=True):
        if not video:
            (folder / camera.name).mkdir()
        if plate is not None:
            write_image(plate, folder / f"{camera.name}_plate.png")
    with ExitStack() as stack:
        films = [
            stack.enter_context(_Film(folder / f"{c.name}.{kind}", kind, scene.rate))
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
        images = f"{camera.name}.{kind}" if kind in _CODECS else camera.name
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
        if kind in _CODECS:
            lines.append("first_mask = 0")
    body = scene.body
    lines += ["", "[body]", f"model = {json.dumps(body.model)}", f"mesh = {json.dumps(body.mesh)}"]
    if body.height is not None:
        lines.append(f"height_m = {body.height!r}")
    lines.append(f"fit = {json.dumps(body.fit)}")
    return "\n".join(lines) + "\n"


class _Film:
    """A video being written."""

    def __init__(self, path: Path, kind: str, rate: float) -> None:
        try:
            import av
        except ImportError:
            raise MissingExtra(
                "videos need PyAV, which is not installed: pip install 'kinesphere[markerless]'"
            ) from None
        self.av: Any = av
        self.path, self.kind = path, kind
        self.rate = Fraction(rate).limit_denominator(1001)
        self.begun = False

    def __enter__(self) -> "_Film":
        codec, pixels, options = _CODECS[self.kind]
        self.container = self.av.open(str(self.path), "w")
        self.stream = self.container.add_stream(codec, rate=self.rate, options=options)
        self.stream.pix_fmt = pixels
        return self

    def add(self, image: Image) -> None:
        """Write one more frame."""
        if not self.begun:
            self.stream.height, self.stream.width = image.shape[:2]
            if any(side % 2 for side in image.shape[:2]) and self.kind == "mp4":
                self.stream.pix_fmt = "yuv444p"  # halved colours need even sides
            self.begun = True
        frame = self.av.VideoFrame.from_ndarray(np.ascontiguousarray(image), format="rgb24")
        for packet in self.stream.encode(frame):
            self.container.mux(packet)

    def __exit__(self, *_: object) -> None:
        if self.begun:
            for packet in self.stream.encode():
                self.container.mux(packet)
        self.container.close()
