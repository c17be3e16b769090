"""The eyes of a tracker: one a camera, each with its canvas and its evidence."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Camera
from kinesphere.markerless.body import Body
from kinesphere.markerless.colours import Colours
from kinesphere.markerless.evidence import Evidence
from kinesphere.markerless.fit import Eye, Fitter, near_limbs
from kinesphere.markerless.masks import Masks
from kinesphere.markerless.rim import Canvas
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.views import view_of

_DRESS = (
    ("head",),
    ("trunk", "clavicle"),
    ("upper_arm",),
    ("forearm",),
    ("hand",),
    ("pelvis", "thigh"),
    ("shank",),
    ("foot",),
)
"""Limbs that wear the same: sleeves, trousers, shoes, skin. Left and right count together."""


def colour_groups(limb_names: Sequence[str]) -> NDArray[np.int32]:
    """Return which colours each limb shares, (n_limbs,); a limb unknown here has its own."""
    groups: list[int] = []
    keys: dict[object, int] = {}
    for name in limb_names:
        stem = name.removeprefix("left_").removeprefix("right_")
        key: object = next((dress for dress in _DRESS if stem in dress), name)
        groups.append(keys.setdefault(key, len(keys)))
    return np.array(groups, dtype=np.int32)


def fitter_for(
    body: Body, cameras: Sequence[Camera], settings: TrackSettings, *, masks: bool
) -> Fitter:
    """Return what fits a body to the images, or to the masks, of cameras."""
    near, groups = near_limbs(body), colour_groups(body.chain.limb_names)

    def evidence() -> Evidence:
        return Masks() if masks else Colours(groups, near, settings.local)

    eyes = tuple(
        Eye(Canvas(view_of(camera, settings.largest), body, settings.cell), evidence())
        for camera in cameras
    )
    return Fitter(body, eyes, settings, near)


def with_body(fitter: Fitter, body: Body) -> Fitter:
    """Return the fitter for another body of the same limbs, with what its eyes have learnt."""
    eyes = tuple(
        Eye(Canvas(eye.canvas.view, body, eye.canvas.cell), eye.evidence) for eye in fitter.eyes
    )
    return Fitter(body, eyes, fitter.settings, fitter.near)
