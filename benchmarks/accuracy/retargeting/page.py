"""Retargeting as a page: what is kept, what slid and no longer does, what bends and what leaps."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from benchmarks.accuracy.retargeting.contacts import Matched
from benchmarks.accuracy.retargeting.measure import Row

EXACT = 1e-9
STILL_MM = 0.1
KEPT_DEG = 1e-6
LEAP = 1.1
"""The largest turn between frames, and its largest change, by the source's."""
ADDED_DEG = 1.5
"""By which a limb's turn may change more between frames than the source's nearby."""

_INTRODUCTION = """\
# Retargeting

Written by `python -m benchmarks.accuracy.retargeting`; every number is in
`benchmarks/results/retargeting.json`.

Real recordings, solved, then put on other skeletons: the person's own 20 % shorter and taller,
with other proportions (thigh × 0.85, shank × 1.1, foot × 0.8, pelvis × 1.3, upper arm × 1.15,
forearm × 0.9), a character named as Mixamo names its own in T pose, the same in A pose with legs
× 1.2 and hips × 1.4, and the rig of CMU's BVH files (legs 20° apart at rest). Solved skeletons
keep the limb frames, and so every joint parameter but the legs'; rigs keep the directions of
bones.

Onto its own skeleton a motion comes back within {itself:.1e} (m, and entries of rotation
matrices).
"""
_KEPT = """\
## What is kept

*arms*: the largest angle between a bone of the arms (a limb's frame, on solved skeletons) and the
source's. *legs*: the same of thighs and shanks, which reach for the ground: median and largest.
*knees*: frames in which a knee bent by more than 10° bends the wrong way. *turn*: the largest
turn of pelvis, thigh, shank or foot between two frames, and *change*, of that turn from one frame
to the next, each by the source's: 1 means that nothing leaps that did not leap before. *added*:
by how much a limb's turn changes more from frame to frame than the same limb's of the source does
within two frames.
"""
_FEET = """\
## Feet

Heels and balls stand where they are slow and low (`kinesphere settings`: `retargeting`). *slide*:
how far a held point strays along the floor from its middle while it stands, with feet left free
(as the bones' directions have them) and planted. *heel*: the same of a heel while the ball of its
foot, which then is the point that is held, stands too; it turns about the ball as in the
recording. *height*: mean distance of standing points to the scaled height of the source's.
*pelvis*: how far it goes down at most where legs are too short for their steps.
"""
_EVENTS = """\
## Contacts against the gait lab's events

How much later than the events in the file a contact begins and ends (negative: earlier). A foot's
contact ends when its ball rises, the lab's when the toes leave the floor.
"""


def page(rows: Sequence[Row], events: Mapping[str, Sequence[Matched]], itself: float) -> str:
    """Return the results as Markdown."""
    parts = [_INTRODUCTION.format(itself=itself), _KEPT]
    head = ("recording", "rig", "legs ×", "arms", "legs", "knees", "turn", "change", "added")
    parts.append(
        _table(
            head,
            (
                (
                    *(row.motion, row.rig, f"{row.scale:.2f}", f"{row.arms_deg:.1e}°"),
                    f"{row.legs_deg:.1f}°, {row.legs_most_deg:.1f}°",
                    f"{row.wrong_knees:.1%}",
                    f"{row.turn_deg / row.turn_source_deg:.2f}",
                    f"{row.jerk_deg / row.jerk_source_deg:.2f}",
                    f"{row.added_deg:.1f}°",
                )
                for row in rows
            ),
        )
    )
    parts.append(_FEET)
    head = ("recording", "rig", "contacts", "slide, free", "planted", "heel", "height", "pelvis")
    parts.append(
        _table(
            head,
            (
                (
                    *(row.motion, row.rig, str(row.n_contacts)),
                    f"{row.slide_free_mm:.1f}, at most {row.slide_free_most_mm:.1f} mm",
                    f"{row.slide_most_mm:.1e} mm",
                    f"{row.heel_most_mm:.1f} mm",
                    f"{row.height_mm:.1f} mm",
                    f"{row.lowered_mm:.0f} mm",
                )
                for row in rows
            ),
        )
    )
    if events:
        parts.append(_EVENTS)
        parts.append(_table(("recording", "event", "how many", "median", "range"), _late(events)))
    return "\n".join(parts)


def missed(rows: Sequence[Row], itself: float) -> list[str]:
    """Return what misses its bar, each as a sentence."""
    found = [] if itself <= EXACT else [f"a motion onto its own skeleton is off by {itself:.1e}"]
    for row in rows:
        where = f"{row.motion} on {row.rig}"
        if not row.slide_most_mm <= STILL_MM:
            found.append(f"{where}: planted feet slide by {row.slide_most_mm:.2f} mm")
        if not row.arms_deg <= KEPT_DEG:
            found.append(f"{where}: arms turn by {row.arms_deg:.1e}°")
        if row.wrong_knees > 0:
            found.append(f"{where}: {row.wrong_knees:.1%} of bent knees bend the wrong way")
        if not row.turn_deg <= LEAP * row.turn_source_deg:
            found.append(f"{where}: a limb turns by {row.turn_deg:.1f}° between frames")
        if not row.jerk_deg <= LEAP * row.jerk_source_deg:
            found.append(f"{where}: a turn changes by {row.jerk_deg:.1f}° between frames")
        if not row.added_deg <= ADDED_DEG:
            found.append(f"{where}: a turn changes by {row.added_deg:.1f}° more than the source's")
    return found


def _late(events: Mapping[str, Sequence[Matched]]) -> Iterable[tuple[str, ...]]:
    for name, rows in events.items():
        for what in ("Foot Strike", "Foot Off"):
            late = np.array([row.late_s for row in rows if row.what == what]) * 1e3
            if len(late):
                span = f"{late.min():+.0f} … {late.max():+.0f} ms"
                yield name, what, str(len(late)), f"{np.median(late):+.0f} ms", span


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"
