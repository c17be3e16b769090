"""The part of a report that shows tracking without markers: overlap, support of limbs."""

import base64
import csv
import io

import numpy as np
from markupsafe import Markup

from kinesphere.data import Array, Scene
from kinesphere.markerless import TrackedMotion
from kinesphere.report.assets_of import asset, environment


def tracking_section(
    scene: Scene,
    tracked: TrackedMotion,
    strip: bytes,
    frames: list[int],
    video: str | None = None,
    poster: bytes = b"",
) -> Markup:
    """Return the HTML of the section.

    Parameters
    ----------
    strip
        A JPEG.
    frames
        Which frames are its rows.
    video
        Name of the file beside the report that shows all frames.
    poster
        A JPEG of its first one.
    """
    names = [camera.name for camera in scene.cameras]
    template = environment().from_string(asset("tracking.html.j2"))
    return Markup(
        template.render(
            video=video,
            poster=base64.b64encode(poster).decode(),
            strip=base64.b64encode(strip).decode(),
            frames=", ".join(str(f + scene.first_frame + 1) for f in frames),
            cameras=[
                {
                    "name": name,
                    "mean": _share(o),
                    "least": _share(o, least=True),
                    "masks": _share(m),
                    "n_masks": int(np.isfinite(m).sum()),
                }
                for name, o, m in zip(
                    names, tracked.overlap.T, tracked.overlap_with_masks.T, strict=True
                )
            ],
            masks_given=bool(np.isfinite(tracked.overlap_with_masks).any()),
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
            doubt=tracked.start_doubt,
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
