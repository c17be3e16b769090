"""Real footage from its automatic start: overlap with given masks, wrists beside keypoints."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchmarks.markerless.given_start import SHIFT, TURN
from benchmarks.markerless.real_scenes import (
    DATA,
    write_mended_parsec_scene,
    write_pose2sim_scene,
)
from kinesphere.data import Array, Mask, Scene, Surface, bundled_body
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
from kinesphere.markerless.silhouettes import largest_piece
from kinesphere.markerless.tracker import track

DISTURBED = 5
"""Starts that are tried beside the one found."""
NAMES = (
    "pose2sim, start found",
    *(f"pose2sim, start disturbed {i + 1}" for i in range(DISTURBED)),
    "parsec, one instant, start found",
)
"""Of what is tracked: a recording and its start."""
NEAR = 0.15
"""m; a wrist nearer to the keypoints' than this is held found."""


@dataclass(frozen=True)
class RealOutcome:
    """What one recording gave."""

    name: str
    overlap: float = float("nan")
    """With the masks that came with it."""
    overlap_of_all: float = float("nan")
    """The same with specks and all, where only the largest piece of each mask counts."""
    wrists_near: float = float("nan")
    """Share of the frames in which both wrists lie within ``NEAR`` of the keypoint solution."""
    wrists_found: float = float("nan")
    """The same, frames left out in which the tracker itself holds a hand lost: the folder has gaps
    there."""
    n_frames: int = 0
    frames_lost: int = 0
    """Frames in which the tracker itself holds a limb lost."""
    overlap_wanted: float = 0.0
    wrists_wanted: float = 0.0
    failed: str = ""

    @property
    def missed(self) -> bool:
        """Whether overlap or wrists stay below what is wanted; NaN counts where a limit is set."""
        pairs = ((self.overlap, self.overlap_wanted), (self.wrists_found, self.wrists_wanted))
        return any(wanted > 0 and not value >= wanted for value, wanted in pairs)


def outcomes(folder: Path, only: str = "", n_frames: int = 300) -> Iterator[RealOutcome]:
    """Yield the outcome of every recording whose name holds ``only``; none where there is no data.

    ``pose2sim`` is tracked from the start found, then from ``DISTURBED`` others; then ``parsec``.
    """
    if not DATA.is_dir():
        return
    for seed, name in enumerate(NAMES[:-1]):
        if only in name:
            yield pose2sim(name, folder / "pose2sim", seed, n_frames)
    if only in NAMES[-1]:
        yield parsec(NAMES[-1], folder / "parsec")


def pose2sim(name: str, folder: Path, seed: int, n_frames: int, data: Path = DATA) -> RealOutcome:
    """Track the balancing person before clutter: found by the masks of frame 5, then disturbed."""
    scene = read_scene(write_pose2sim_scene(folder, data, masks=True))
    scene = replace(scene, n_frames=min(n_frames, scene.n_frames))
    surface, settings = bundled_body(), TrackSettings()
    try:
        start = first_pose(scene, surface, full_body, settings, scene.frame(scene.start.frame))
        tracked = track(scene, surface, settings, start=_disturbed(start, surface, seed))
    except KinesphereError as error:
        return RealOutcome(name, overlap_wanted=0.83, wrists_wanted=0.95, failed=str(error))
    near, lost = _wrists(scene, tracked, data)
    return replace(
        _outcome(name, scene, tracked),
        wrists_near=float(near.mean()),
        wrists_found=float((near & ~lost).mean()),
        overlap_wanted=0.83,
        wrists_wanted=0.95,
    )


def _disturbed(start: FirstPose, surface: Surface, seed: int) -> FirstPose:
    """Return the start; with a seed above 0 every joint 2° and the pelvis 8 mm elsewhere."""
    if seed == 0:
        return start
    rng = np.random.default_rng([seed, 6])
    chain = full_body(shaped(surface, start.logs)).chain
    step = rng.normal(scale=TURN, size=chain.n_dofs)
    step[chain.dof_kinds == SLIDE] = rng.normal(scale=SHIFT, size=3)
    return replace(start, pose=limited(chain, moved(chain, start.pose, step)))


def _wrists(scene: Scene, tracked: TrackedMotion, data: Path) -> tuple[Mask, Mask]:
    """Return in which frames both wrists are near the keypoints', and a hand is held lost."""
    keypoints = read_trc(data / "video" / "pose2sim" / "Balancing_for_IK.trc")
    near = np.ones(tracked.n_frames, dtype=bool)
    lost = np.zeros(tracked.n_frames, dtype=bool)
    for side, label in (("left", "LWrist"), ("right", "RWrist")):
        column = keypoints.columns((label,))[0]
        # the calibration's world is (Z, X, Y) of the keypoints'
        there = (
            keypoints.markers[: tracked.n_frames, column][:, [2, 0, 1]] @ scene.world_from_file.T
        )
        hand = tracked.limb_names.index(f"{side}_hand")
        near &= np.linalg.norm(tracked.origins[:, hand] - there, axis=-1) < NEAR
        lost |= tracked.lost[:, hand]
    return near, lost


def parsec(name: str, folder: Path, data: Path = DATA) -> RealOutcome:
    """Fit the single instant that four grey cameras saw, their calibration mended as advised."""
    scene = read_scene(write_mended_parsec_scene(folder, data))
    try:
        tracked = track(scene, bundled_body())
    except KinesphereError as error:
        return RealOutcome(name, overlap_wanted=0.8, failed=str(error))
    whole = _outcome(name, scene, tracked)
    person = _outcome(name, scene, tracked, pieces=True)
    return replace(person, overlap_of_all=whole.overlap, overlap_wanted=0.8)


def _outcome(
    name: str, scene: Scene, tracked: TrackedMotion, *, pieces: bool = False
) -> RealOutcome:
    """Return what is said of a recording; with ``pieces`` of each mask's largest piece alone."""
    overlaps = []
    for frame in scene.frames():
        given = [
            r if r is not None else m for r, m in zip(frame.references, frame.masks, strict=True)
        ]
        if pieces:  # raw foreground maps: a mouse and screens that flicker are in them as well
            given = [None if m is None else _largest(m) for m in given]
        if not tracked.solved[frame.index] or all(mask is None for mask in given):
            continue
        skin = tracked.body.vertices(tracked.parameters[frame.index])
        overlaps.append(_overlap(scene, skin, tracked.body.faces, given))
    return RealOutcome(
        name,
        overlap=float(np.mean(overlaps)) if overlaps else float("nan"),
        n_frames=tracked.n_frames,
        frames_lost=int(tracked.lost.any(axis=1).sum()),
    )


def _largest(mask: Mask) -> Mask:
    return np.asarray(largest_piece(mask.astype(np.uint8) * 255) > 0)


def _overlap(scene: Scene, skin: Array, faces: Array, masks: list[Mask | None]) -> float:
    shares = []
    for camera, mask in zip(scene.cameras, masks, strict=True):
        if mask is not None:
            body = silhouette(camera.project(skin), faces, camera.width, camera.height)
            shares.append((body & mask).sum() / (body | mask).sum())
    return float(np.mean(shares))
