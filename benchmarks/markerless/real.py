"""Real footage from its automatic start: overlap with given masks, wrists beside keypoints."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchmarks.markerless.given_start import SHIFT, TURN
from benchmarks.markerless.real_scenes import DATA, write_parsec_scene, write_pose2sim_scene
from kinesphere.data import Array, Scene, Surface, bundled_body
from kinesphere.errors import KinesphereError
from kinesphere.geometry.raster import silhouette
from kinesphere.io import read_trc
from kinesphere.io.scene import read_scene
from kinesphere.markerless import TrackedMotion
from kinesphere.markerless.anatomy import full_body
from kinesphere.markerless.chain import SLIDE
from kinesphere.markerless.first_pose import FirstPose, first_pose
from kinesphere.markerless.pose import limited, moved
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.shape import shaped
from kinesphere.markerless.tracker import track

DISTURBED = 5
"""Starts that are tried beside the one found."""
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


def pose2sim(folder: Path, data: Path = DATA) -> list[RealOutcome]:
    """Track the balancing person before clutter: found by the masks of frame 5, then disturbed."""
    scene = read_scene(write_pose2sim_scene(folder, data, masks=True))
    surface, settings = bundled_body(), TrackSettings()
    name = "pose2sim, full body, started from the masks of frame 5"
    try:
        start = first_pose(scene, surface, full_body, settings, scene.frame(scene.start.frame))
    except KinesphereError as error:
        return [RealOutcome(name, failed=str(error))]
    outcomes = []
    for seed in range(DISTURBED + 1):
        tracked = track(scene, surface, settings, start=_disturbed(start, surface, seed))
        near = _wrists_near(scene, tracked, data)
        outcomes.append(_outcome(name, scene, tracked, near))
        name = f"the same, its first pose disturbed by 2° and 8 mm, draw {seed + 1}"
    return outcomes


def _disturbed(start: FirstPose, surface: Surface, seed: int) -> FirstPose:
    """Return the start; with a seed above 0 every joint 2° and the pelvis 8 mm elsewhere."""
    if seed == 0:
        return start
    rng = np.random.default_rng([seed, 6])
    chain = full_body(shaped(surface, start.logs)).chain
    step = rng.normal(scale=TURN, size=chain.n_dofs)
    step[chain.dof_kinds == SLIDE] = rng.normal(scale=SHIFT, size=3)
    return replace(start, pose=limited(chain, moved(chain, start.pose, step)))


def _wrists_near(scene: Scene, tracked: TrackedMotion, data: Path) -> float:
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
    return float(near.mean())


def parsec(folder: Path, data: Path = DATA) -> list[RealOutcome]:
    """Fit the single instant that four grey cameras saw."""
    name = "parsec, one instant, automatic start"
    scene = read_scene(write_parsec_scene(folder, data))
    try:
        tracked = track(scene, bundled_body())
    except KinesphereError as error:
        return [RealOutcome(name, failed=str(error))]
    return [_outcome(name, scene, tracked, float("nan"))]


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
