"""Where a scene begins with an empty room: the first frame that shows the person."""

from dataclasses import replace

import numpy as np

from kinesphere import __version__
from kinesphere.data import Scene, Step
from kinesphere.markerless.checks import silhouettes

_LOOKS = 50
"""Frames looked at, evenly spread."""
_WHOLE = 0.8
"""Share of the usual size of silhouettes from which on a person has come in wholly."""


def with_person_in_view(scene: Scene) -> Scene:
    """Return the scene with its start moved to where the person is seen, if it is not there.

    Told by masks or plates; without them, and where the start's pose or keypoints are given, the
    scene comes back as it is. What was done is a step of its history.
    """
    start = scene.start
    known = start.pose == "given" or start.keypoints is not None
    if known or not (scene.has_masks or any(p is not None for p in scene.plates)):
        return scene
    if sum(mask is not None for mask in silhouettes(scene, scene.frame(start.frame))) > 1:
        return scene
    every = max(1, scene.n_frames // _LOOKS)
    seen = []
    for frame in scene.frames(0, None, every):
        masks = [mask for mask in silhouettes(scene, frame) if mask is not None]
        seen.append((frame.index, len(masks), float(sum(mask.mean() for mask in masks))))
    most = max(cameras for _, cameras, _ in seen)
    if most < 2:
        return scene  # the start says why nobody is found
    usual = np.median([size for _, cameras, size in seen if cameras == most])
    found = next(i for i, cameras, size in seen if cameras == most and size >= _WHOLE * usual)
    first = scene.first_frame + 1
    step = Step(
        "entrance",
        findings={"start_frame": found},
        warnings=(
            f"frame {start.frame + first} shows nobody in two cameras; the start was looked for in "
            f"frame {found + first}",
        ),
        version=__version__,
    )
    moved = replace(start, frame=found)
    return replace(scene, start=moved, history=(*scene.history, step))
