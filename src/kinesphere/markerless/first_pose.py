"""The first pose: given, found by a pose estimator's keypoints, or by silhouettes."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array, Frame, Scene
from kinesphere.data.surface import Surface
from kinesphere.errors import BadScene
from kinesphere.markerless.anatomy import full_body
from kinesphere.markerless.body import Body
from kinesphere.markerless.doubt import Evidence, doubt_of, evidence_of
from kinesphere.markerless.eyes import fitter_for, with_body
from kinesphere.markerless.keypoint_start import UnusableKeypoints, pose_from_keypoints
from kinesphere.markerless.pose import Pose
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.shape import FACTORS, shaped
from kinesphere.markerless.silhouettes import start_masks
from kinesphere.markerless.start import find_start
from kinesphere.markerless.transfer import taken_over


@dataclass(frozen=True, eq=False)
class FirstPose:
    """Where tracking begins."""

    pose: Pose
    logs: Array
    """(n_factors,) logarithms of the factors of `shape`."""
    overlap: float
    """Mean over cameras, of the model with the silhouettes; NaN for a given pose."""
    how: str
    """``given``, ``keypoints`` or ``silhouettes``."""
    warnings: tuple[str, ...] = ()
    """What is to be said about it, a sentence each."""
    evidence: Evidence | None = None
    """What speaks for it, where it was found by silhouettes."""
    doubt: str = ""
    """Why it may be wrong; nothing where it is to be believed."""


def first_pose(
    scene: Scene,
    surface: Surface,
    model: Callable[[Surface], Body],
    settings: TrackSettings,
    frame: Frame,
) -> FirstPose:
    """Return the pose in the first frame, of the model at the proportions returned.

    Raises
    ------
    BadScene
        If given values name no parameter of the model, the silhouettes show nobody, or next to
        nothing speaks for what was found in them.
    """
    logs = np.zeros(len(FACTORS))
    if scene.body.height is not None:
        logs[0] = np.log(scene.body.height / np.ptp(surface.vertices[:, 1]))
    start = scene.start
    if start.pose == "given":
        body = model(shaped(surface, logs))
        values = np.zeros(body.chain.n_dofs)
        names = {name: i for i, name in enumerate(body.parameter_names)}
        if unknown := sorted(set(start.values) - set(names)):
            raise BadScene(
                f"the body has no parameter {', '.join(unknown)}; there are {', '.join(names)}"
            )
        for name, value in start.values.items():
            values[names[name]] = value
        return FirstPose(body.pose(values), logs, float("nan"), "given")
    fit = scene.body.fit and scene.body.height is None
    doubts: tuple[str, ...] = ()
    if start.keypoints is not None:
        try:
            seen = pose_from_keypoints(scene, surface, logs, settings, sizes=fit)
        except UnusableKeypoints as error:
            doubts = (f"the keypoints are not used, but the images: {error}",)
        else:
            pose = seen.pose
            if model is not full_body:
                source = full_body(shaped(surface, seen.logs)).chain
                pose = taken_over(source, pose, model(shaped(surface, seen.logs)).chain)
            return FirstPose(pose, seen.logs, float("nan"), "keypoints", seen.warnings)
    whole = fitter_for(full_body(shaped(surface, logs)), scene.cameras, settings, masks=True)
    views = [eye.canvas.view for eye in whole.eyes]
    shown = start_masks(scene, views, frame)
    found = find_start(
        whole,
        surface,
        full_body,
        shown.masks,
        position=None if start.position is None else np.array(start.position),
        heading=None if start.facing is None else np.array(start.facing),
        arms="standing" if start.pose == "auto" else start.pose,
        fit=fit,
    )
    source = full_body(shaped(surface, found.logs)).chain
    target = model(shaped(surface, found.logs)).chain
    pose = found.pose if model is full_body else taken_over(source, found.pose, target)
    overlap = float(np.nanmean(found.overlap))
    pictures = [
        None if picture is None else view.image(picture)
        for view, picture in zip(views, frame.images, strict=True)
    ]
    body = full_body(shaped(surface, found.logs))
    evidence = evidence_of(with_body(whole, body), found.pose, pictures, shown, overlap)
    doubt = doubt_of(evidence, frame.index + scene.first_frame + 1)
    return FirstPose(pose, found.logs, overlap, "silhouettes", doubts, evidence, doubt)
