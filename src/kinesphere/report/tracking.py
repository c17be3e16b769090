"""The part of a report that shows tracking without markers: pictures, overlap, support of limbs."""

import base64
import csv
import io
from collections.abc import Callable

import numpy as np
from markupsafe import Markup

from kinesphere.data import Array, Camera, Image, Scene
from kinesphere.markerless import TrackedMotion
from kinesphere.markerless.drawing import overlay
from kinesphere.report.assets_of import asset, environment

STRIP_FRAMES = 5
"""Rows of the strip of pictures."""
_PANEL = 340.0
"""px, longest side of one picture of the strip; nothing is enlarged."""
_GAP = 4


def overlay_strip(
    scene: Scene,
    tracked: TrackedMotion,
    n_frames: int = STRIP_FRAMES,
    progress: Callable[[str, int, int], None] | None = None,
) -> tuple[Image, list[int]]:
    """Return pictures of every camera with the model over them, a row a frame, and which frames.

    Frames are spread evenly over the scene; the frame with the least support of a limb is among
    them, as it shows where to look.
    """
    frames = shown_frames(tracked, n_frames)
    skins = {i: tracked.body.vertices(tracked.parameters[i]) for i in frames if tracked.solved[i]}
    boxes = [_box(camera, list(skins.values())) for camera in scene.cameras]
    rows = []
    for i, index in enumerate(frames):
        if progress is not None:
            progress("pictures", i, len(frames))
        rows.append(_row(scene, tracked, index, skins.get(index), boxes))
    width = max(row.shape[1] for row in rows)
    padded = [np.pad(row, ((0, _GAP), (0, width - row.shape[1]), (0, 0))) for row in rows]
    return np.vstack(padded)[:-_GAP], frames


def shown_frames(tracked: TrackedMotion, n_frames: int) -> list[int]:
    """Return the frames that a strip shows, in their order."""
    last = tracked.n_frames - 1
    chosen = set(np.linspace(0, last, min(n_frames, tracked.n_frames)).round().astype(int).tolist())
    known = np.isfinite(tracked.support)
    worst = np.where(known, tracked.support, np.inf).min(axis=1)
    if np.isfinite(worst).any():
        chosen.add(int(np.argmin(worst)))
    return sorted(chosen)


def _box(camera: Camera, skins: list[Array]) -> tuple[int, int, int, int]:
    """Return left, top, right, bottom of what is shown of a camera: the body and some room."""
    whole = (0, 0, camera.width, camera.height)
    if not skins:
        return whole
    pixels = camera.project(np.concatenate(skins))
    pixels = pixels[np.isfinite(pixels).all(axis=1)]
    if not len(pixels):
        return whole
    low, high = pixels.min(axis=0), pixels.max(axis=0)
    room = 0.12 * (high - low).max()
    left, top = np.clip(low - room, 0, [camera.width - 2, camera.height - 2]).astype(int)
    right, bottom = np.clip(high + room, [left + 2, top + 2], [camera.width, camera.height])
    return int(left), int(top), int(right), int(bottom)


def _row(
    scene: Scene,
    tracked: TrackedMotion,
    index: int,
    skin: Array | None,
    boxes: list[tuple[int, int, int, int]],
) -> Image:
    body = tracked.body
    vertices = np.full((int(body.faces.max()) + 1, 3), np.nan) if skin is None else skin
    panels = []
    height = 0
    images = scene.frame(index).images
    for camera, image, (left, top, right, bottom) in zip(scene.cameras, images, boxes, strict=True):
        scale = min(1.0, _PANEL / max(right - left, bottom - top))
        if image is None:
            image = np.zeros((camera.height, camera.width, 3), dtype=np.uint8)
        drawn = overlay(
            image,
            camera,
            vertices,
            body.faces,
            body.limb_of_face,
            tracked.limb_names,
            tracked.lost[index],
            scale,
        )
        x0, y0, x1, y1 = (round(edge * scale) for edge in (left, top, right, bottom))
        panels.append(drawn[y0:y1, x0:x1])
        height = max(height, panels[-1].shape[0])
    padded = [np.pad(p, ((0, height - len(p)), (0, _GAP), (0, 0))) for p in panels]
    return np.hstack(padded)[:, :-_GAP]


def tracking_section(
    scene: Scene, tracked: TrackedMotion, strip: bytes, frames: list[int]
) -> Markup:
    """Return the HTML of the section.

    Parameters
    ----------
    strip
        A JPEG.
    frames
        Which frames are its rows.
    """
    names = [camera.name for camera in scene.cameras]
    template = environment().from_string(asset("tracking.html.j2"))
    return Markup(
        template.render(
            strip=base64.b64encode(strip).decode(),
            frames=", ".join(str(f + scene.first_frame + 1) for f in frames),
            cameras=[
                {"name": name, "mean": _share(o), "least": _share(o, least=True)}
                for name, o in zip(names, tracked.overlap.T, strict=True)
            ],
            overlap=_curves(tracked.overlap),
            limbs=[
                {
                    "name": name,
                    "support": _share(tracked.support[:, i]),
                    "least": _share(tracked.support[:, i], least=True),
                    "judged": f"{np.isfinite(tracked.support[:, i]).mean():.0%}",
                    "lost": int(tracked.lost[:, i].sum()),
                    "bar": _bar(tracked, i),
                }
                for i, name in enumerate(tracked.limb_names)
            ],
            n_frames=tracked.n_frames,
            n_solved=int(tracked.solved.sum()),
            seconds=[(k, f"{v:.1f}") for k, v in tracked.seconds.items()],
        )
    )


def tracking_table(scene: Scene, tracked: TrackedMotion) -> str:
    """Return a CSV table: a row a frame, overlap of each camera, support of each limb, lost limbs.

    Columns: ``time_s``, ``overlap.CAMERA``, ``support.LIMB``, ``lost`` (names, blanks between).
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    cameras = [f"overlap.{camera.name}" for camera in scene.cameras]
    limbs = [f"support.{name}" for name in tracked.limb_names]
    writer.writerow(["time_s", *cameras, *limbs, "lost"])
    for i in range(tracked.n_frames):
        lost = [n for n, gone in zip(tracked.limb_names, tracked.lost[i], strict=True) if gone]
        values = [*tracked.overlap[i], *tracked.support[i]]
        told = ["" if np.isnan(v) else f"{v:.4f}" for v in values]
        writer.writerow([f"{i / tracked.rate:.6f}", *told, " ".join(lost)])
    return text.getvalue()


def _share(values: Array, *, least: bool = False) -> str:
    known = values[np.isfinite(values)]
    if not len(known):
        return "–"
    return f"{known.min() if least else known.mean():.2f}"


def _curves(overlap: Array, width: int = 900, height: int = 140) -> list[str]:
    """Return a polyline's points for each camera, 0 to 1 upward; breaks where there is no image."""
    n = len(overlap)
    x = np.linspace(0, width, n) if n > 1 else np.array([width / 2])
    curves = []
    for column in overlap.T:
        y = height * (1 - column)
        path, pen = [], "M"
        for a, b in zip(x, y, strict=True):
            if np.isfinite(b):
                path.append(f"{pen}{a:.1f} {b:.1f}")
                pen = "L"
            else:
                pen = "M"
        # a frame between gaps is a dot, not nothing
        curves.append(" ".join(f"{step}h0.1" if step[0] == "M" else step for step in path))
    return curves


def _bar(tracked: TrackedMotion, limb: int, cells: int = 120) -> list[str]:
    """Return a class for each stretch of time: ``lost``, ``weak``, ``fair``, ``good``, ``none``."""
    classes = []
    for part in np.array_split(np.arange(tracked.n_frames), min(cells, tracked.n_frames)):
        support = tracked.support[part, limb]
        known = support[np.isfinite(support)]
        if tracked.lost[part, limb].any():
            classes.append("lost")
        elif not len(known):
            classes.append("none")
        else:
            low = float(known.min())
            classes.append("good" if low >= 0.7 else "fair" if low >= 0.5 else "weak")
    return classes
