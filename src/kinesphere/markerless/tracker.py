"""Cameras in, motion out: start, proportions, then frame after frame."""

from collections.abc import Callable
from dataclasses import replace
from time import perf_counter
from typing import TypeAlias

import numpy as np

from kinesphere.data import Scene, Step
from kinesphere.data.settings import settings_as_json
from kinesphere.data.surface import Surface
from kinesphere.errors import BadSetting
from kinesphere.markerless.account import Account
from kinesphere.markerless.anatomy import full_body, upper_body
from kinesphere.markerless.body import Body
from kinesphere.markerless.contour_fit import ContourFitter
from kinesphere.markerless.eyes import fitter_for, with_body
from kinesphere.markerless.first_pose import FirstPose, first_pose
from kinesphere.markerless.fit import Fitter
from kinesphere.markerless.following import Following
from kinesphere.markerless.pose import Pose
from kinesphere.markerless.rehearsal import rehearse
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.shape import found_shape, shaped
from kinesphere.markerless.shape_fit import fit_shape
from kinesphere.markerless.sizes import with_best_size
from kinesphere.markerless.tracked import DOUBT, TrackedMotion
from kinesphere.markerless.tracking import Tracking
from kinesphere.markerless.watching import backwards, masks_throughout, pictures_of

MODELS: dict[str, Callable[[Surface], Body]] = {"full": full_body, "upper": upper_body}
"""Body models by name."""

Progress: TypeAlias = Callable[[str, int, int], None]
"""Called with what is being done, how much of it is done, and of how much."""


def track(
    scene: Scene,
    surface: Surface,
    settings: TrackSettings | None = None,
    progress: Progress | None = None,
    start: FirstPose | None = None,
    notice: Callable[[str], None] | None = None,
) -> TrackedMotion:
    """Follow one person through a scene (Rosenhahn et al. 2006, and what came after).

    From the frame in which the person is found first, forward to the end and back to the
    beginning.

    Parameters
    ----------
    scene
        Cameras, images, and what is known of the start.
    surface
        A human body in the bind pose; ``scene.body.model`` says which model it becomes.
    settings
    progress
    start
        The pose in the first frame, if it is known; else it is found.
    notice
        Told at once why a start that was found may be wrong.

    Returns
    -------
    TrackedMotion
        One pose a frame; NaN where no camera has an image, and in frames not reached when an
        interruption (Ctrl-C) ended tracking.

    Raises
    ------
    BadScene
        If the person cannot be found in the first frame.
    BadSetting
        If no body model has that name.
    """
    settings = settings or TrackSettings()
    say: Progress = progress or (lambda *_: None)
    model = MODELS.get(scene.body.model, full_body if "." in scene.body.model else None)
    if model is None:
        raise BadSetting(
            f"no body model is called {scene.body.model!r}; known are {', '.join(MODELS)}"
        )
    first = min(scene.start.frame, scene.n_frames - 1)
    masks = masks_throughout(scene, first)
    seconds: dict[str, float] = {}
    clock = perf_counter()
    say("start", 0, 1)
    opening = scene.frame(first)
    start = start or first_pose(scene, surface, model, settings, opening)
    if start.doubt and notice is not None:
        notice(start.doubt)
    if start.how == "given" and scene.body.fit and scene.body.height is None:
        pictures = pictures_of(opening, masks)
        start = with_best_size(
            start, scene.cameras, surface, model, settings, pictures, masks=masks
        )
    logs, pose = start.logs, start.pose
    chosen = settings.for_masks() if masks else settings
    fitter = fitter_for(model(shaped(surface, logs)), scene.cameras, chosen, masks=masks)
    seconds["start"], clock = perf_counter() - clock, perf_counter()
    if scene.body.fit:
        for i in range(settings.shape_rounds):
            say("proportions", i, settings.shape_rounds)
            tracking = _tracking(fitter, pose, settings, masks)
            instants = rehearse(scene, tracking, first, masks)
            logs, poses = fit_shape(fitter, surface, model, logs, instants)
            fitter, pose = with_body(fitter, model(shaped(surface, logs))), poses[0]
        seconds["proportions"] = perf_counter() - clock
    account = Account(scene, fitter)
    account.seconds.update(seconds)
    try:
        for frames in (scene.frames(first), backwards(scene, first)):
            following = Following(
                _tracking(fitter, pose, settings, masks),
                masks,
                lambda: _tracking(
                    fitter_for(fitter.body, scene.cameras, settings, masks=False),
                    pose,
                    settings,
                    masks=False,
                ),
            )
            for frame in frames:
                clock = perf_counter()
                watch = following.begin if frame.index == first else following.step
                found = watch(frame)
                account.fitter, unmasked = following.fitter, following.without_masks
                account.enter(frame, found, perf_counter() - clock, unmasked=unmasked)
                say("tracking", account.n_entered, scene.n_frames)
    except KeyboardInterrupt:
        if not account.n_entered:
            raise  # nothing to keep
    step = Step(
        "track",
        settings={"model": scene.body.model, "start": start.how, **settings_as_json(settings)},
        findings={
            **found_shape(logs),
            "start_overlap": None if np.isnan(start.overlap) else float(start.overlap),
            "start_edges": None if start.evidence is None else start.evidence.edges,
            DOUBT: start.doubt,
        },
        warnings=(*([start.doubt] if start.doubt else []), *start.warnings, *account.warnings()),
    )
    fitted = replace(shaped(surface, logs), shapes=())
    return account.tracked((*scene.history, step), fitted)


def _tracking(fitter: Fitter, pose: Pose, settings: TrackSettings, masks: bool) -> Tracking:
    contours = None if settings.method == "region" else ContourFitter(fitter, masks)
    return Tracking(fitter, pose, contours=contours)
