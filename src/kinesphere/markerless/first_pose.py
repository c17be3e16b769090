"""The first pose: given, or found by silhouettes."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array, Frame, Scene
from kinesphere.data.surface import Surface
from kinesphere.errors import BadScene
from kinesphere.markerless.anatomy import full_body
from kinesphere.markerless.body import Body
from kinesphere.markerless.eyes import fitter_for
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
    """``given`` or ``silhouettes``."""


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
        If given values name no parameter of the model, or the silhouettes show nobody.
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
    whole = fitter_for(full_body(shaped(surface, logs)), scene.cameras, settings, masks=True)
    views = [eye.canvas.view for eye in whole.eyes]
    found = find_start(
        whole,
        surface,
        full_body,
        start_masks(scene, views, frame),
        position=None if start.position is None else np.array(start.position),
        heading=None if start.facing is None else np.array(start.facing),
        arms="standing" if start.pose == "auto" else start.pose,
        fit=scene.body.fit and scene.body.height is None,
    )
    source = full_body(shaped(surface, found.logs)).chain
    target = model(shaped(surface, found.logs)).chain
    pose = found.pose if model is full_body else taken_over(source, found.pose, target)
    overlap = float(np.nanmean(found.overlap))
    return FirstPose(pose, found.logs, overlap, "silhouettes")
