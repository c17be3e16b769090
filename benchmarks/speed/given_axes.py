"""Parameterization without its calibration: the stage as it is, axes and rest positions given."""

from collections.abc import Callable
from typing import Any
from unittest.mock import patch

from kinesphere.data import Motion
from kinesphere.parameterization import parameterize, stage
from kinesphere.parameterization.joint_fit import JointFit
from kinesphere.parameterization.view import JointView


def given_axes(motion: Motion, calibration: tuple[float, float]) -> Callable[[], None]:
    """Return what parameterizes a motion but finds no axes: they are found here, once.

    Everything else that the stage does stays: relative rotations, smoothing and movement phases,
    angles and twists, poses rebuilt, flags, deviations and findings.

    Parameters
    ----------
    motion
        Normalized.
    calibration
        As `kinesphere.parameterization.parameterize` takes it.
    """
    fits: dict[str, JointFit] = {}
    find = stage.own_or_reused

    def once(view: JointView, *others: Any, **options: Any) -> JointFit:
        if view.name not in fits:
            fits[view.name] = find(view, *others, **options)
        return fits[view.name]

    def run() -> None:
        with patch.object(stage, "own_or_reused", once):
            parameterize(motion, calibration=calibration)

    run()
    return run
