"""Real footage from its automatic start: overlap with given masks, wrists beside keypoints."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.markerless.real_scenes import DATA, write_parsec_scene, write_pose2sim_scene
from kinesphere.data import Array, Scene, bundled_body
from kinesphere.errors import KinesphereError
from kinesphere.geometry.raster import silhouette
from kinesphere.io import read_trc
from kinesphere.io.scene import read_scene
from kinesphere.markerless import TrackedMotion
from kinesphere.markerless.tracker import track

NEAR = 0.15
"""m; a wrist nearer to the keypoints' than this is held found."""


@dataclass(frozen=True)
class RealOutcome:
    """What one recording gave."""

    name: str
    overlap: float = float("nan")
    """With the masks that came with it."""
    wrists_near: float = float("nan")
    """Share of the frames in which both wrists lie within ``NEAR`` of the keypoint solution."""
    n_frames: int = 0
    frames_lost: int = 0
    """Frames in which the tracker itself holds a limb lost."""
    frames_per_s: float = float("nan")
    failed: str = ""


def pose2sim(folder: Path, data: Path = DATA) -> RealOutcome:
    """Track the balancing person before clutter."""
    name = "pose2sim, full body, automatic start"
    scene = read_scene(write_pose2sim_scene(folder, data))
    try:
        tracked = track(scene, bundled_body())
    except KinesphereError as error:
        return RealOutcome(name, failed=str(error))
    keypoints = read_trc(data / "video" / "pose2sim" / "Balancing_for_IK.trc")
    near = np.ones(tracked.n_frames, dtype=bool)
    for side, label in (("left", "LWrist"), ("right", "RWrist")):
        column = keypoints.columns((label,))[0]
        # the calibration's world is (Z, X, Y) of the keypoints'
        there = (
            keypoints.markers[: tracked.n_frames, column][:, [2, 0, 1]] @ scene.world_from_file.T
        )
        here = tracked.origins[:, tracked.limb_names.index(f"{side}_hand")]
        near &= np.linalg.norm(here - there, axis=-1) < NEAR
    return _outcome(name, scene, tracked, near.mean())


def parsec(folder: Path, data: Path = DATA) -> RealOutcome:
    """Fit the single instant that four grey cameras saw."""
    name = "parsec, one instant, automatic start"
    scene = read_scene(write_parsec_scene(folder, data))
    try:
        tracked = track(scene, bundled_body())
    except KinesphereError as error:
        return RealOutcome(name, failed=str(error))
    return _outcome(name, scene, tracked, float("nan"))


def _outcome(name: str, scene: Scene, tracked: TrackedMotion, near: float) -> RealOutcome:
    overlaps = []
    for frame in scene.frames():
        given = [
            r if r is not None else m for r, m in zip(frame.references, frame.masks, strict=True)
        ]
        if not tracked.solved[frame.index] or all(mask is None for mask in given):
            continue
        skin = tracked.body.vertices(tracked.parameters[frame.index])
        overlaps.append(_overlap(scene, skin, tracked.body.faces, given))
    return RealOutcome(
        name,
        overlap=float(np.mean(overlaps)) if overlaps else float("nan"),
        wrists_near=float(near),
        n_frames=tracked.n_frames,
        frames_lost=int(tracked.lost.any(axis=1).sum()),
        frames_per_s=tracked.n_frames / tracked.seconds.get("tracking", np.nan),
    )


def _overlap(scene: Scene, skin: Array, faces: Array, masks: list[Array | None]) -> float:
    shares = []
    for camera, mask in zip(scene.cameras, masks, strict=True):
        if mask is not None:
            body = silhouette(camera.project(skin), faces, camera.width, camera.height)
            shares.append((body & mask).sum() / (body | mask).sum())
    return float(np.mean(shares))
