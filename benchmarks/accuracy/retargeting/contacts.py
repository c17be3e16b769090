"""Feet on the ground as retargeting finds them, against what the gait lab marked."""

from typing import NamedTuple

import numpy as np

from kinesphere.data import Event, Motion, Recording
from kinesphere.data.figure import SIDES, find_figure
from kinesphere.editing import RetargetSettings
from kinesphere.editing.foot_contacts import find_contacts, find_ground, runs, soles
from kinesphere.editing.retarget_gaps import without_gaps
from kinesphere.editing.retarget_rest import rest_pose

_WHAT = ("Foot Strike", "Foot Off")


class Matched(NamedTuple):
    """An event of the lab and the nearest end of a contact."""

    side: str
    what: str
    late_s: float
    """How much later the contact begins or ends."""


def events_of(recording: Recording) -> list[Event]:
    """Return the lab's foot strikes and foot offs."""
    return [event for event in recording.events if event.label in _WHAT]


def matched(motion: Motion, events: list[Event]) -> list[Matched]:
    """Return each event with the contact nearest to it, but for those cut off by the recording."""
    motion, _ = without_gaps(motion)
    rest = rest_pose(motion.skeleton, find_figure(motion.skeleton))
    places = np.concatenate([motion.origins[:, :1], motion.joint_centres()], axis=1)
    feet = [rest.figure.parts[f"{side}_foot"] for side in SIDES]
    ground = find_ground(places[:, feet], rest.leg)
    points = soles(rest, motion.skeleton, motion.rotations, places, ground.ankle, 0.2)
    standing = find_contacts(points, motion.rate, rest.leg, RetargetSettings()).any(axis=2)
    found = []
    for f, side in enumerate(SIDES):
        stances = runs(np.asarray(standing[:, f]))
        ends = {
            "Foot Strike": [a for a, _ in stances if a > 0],
            "Foot Off": [b for _, b in stances if b < motion.n_frames],
        }
        for event in events:
            if event.context.lower() != side:
                continue
            off = [end / motion.rate - event.time for end in ends[event.label]]
            if off and abs(late := min(off, key=abs)) < 0.3:
                found.append(Matched(side, event.label, late))
    return found
