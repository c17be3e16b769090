"""What can be told before any work that bodies cannot be found, or not so many."""

import numpy as np

from kinesphere.data import Recording
from kinesphere.errors import BadRecording

FARTHEST = 1e9
"""m, in whatever unit lengths really are: beyond, sums of squares lose what is nearer."""


def check_places(recording: Recording) -> None:
    """Raise BadRecording where a marker is too far away for any sum over markers."""
    far = (np.abs(recording.markers) > FARTHEST).any(axis=2)
    if far.any():
        frame, column = np.argwhere(far)[0]
        away = np.abs(recording.markers[frame, column]).max()
        raise BadRecording(
            f"{recording.labels[column]} is {away:.3g} m from the origin in frame "
            f"{recording.first_frame + frame}: no camera sees so far; leave such positions out "
            "as not seen"
        )


def check_bodies(n_markers: int, bodies: int | None) -> None:
    """Raise BadRecording where so many bodies leave none the three markers that a root needs."""
    if bodies is not None and bodies > n_markers - 2:
        raise BadRecording(
            f"discovery.bodies asks for {bodies} bodies of {n_markers} markers; at most "
            f"{n_markers // 3} can have three each, {n_markers - 2} if one has three and every "
            "other a single one"
        )


def check_tree(there: int, number: int) -> None:
    """Raise BadRecording where there are fewer trees than the one that was asked for."""
    if number > there:
        raise BadRecording(f"tree {number} was asked for; {there} move independently here")
