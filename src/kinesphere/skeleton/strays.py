"""Sightings that cannot be their marker's: gaps for all that is measured, and told."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import Array, Json, Mask, Recording
from kinesphere.geometry.in_words import in_millimetres
from kinesphere.geometry.strays import find_strays, find_strays_of_body
from kinesphere.geometry.vectors import lengths
from kinesphere.skeleton.discovery.size import PERSON

NEAR = 1 / 16
"""Of the subject's size, 50 mm of a person: what is off by less does not stray. Skin leaves 22 mm
of noise at most; 50 mm there and back in 10 ms takes 500 m/s², three times over."""
SLOW = 80.0
"""Hz, below which limbs get as far between frames by themselves, as the square of the time: 50 mm
there and back are 320 m/s² here, more than a kick's. At 20 Hz a hand that waves is so far off its
path. Distances within a body do not ask for it."""
TINIEST = 1 / 20
"""Of a person: what seems smaller has its lengths in another unit. What is truly smaller is moved
as fast as a person moves: fingers tap."""
OF_BODY = 0.5
"""Times that, for distances to markers of the same body, which change by half of it or more in two
thirds of all directions."""
LISTED = 20
"""Runs of frames of a marker that the findings hold."""


@dataclass(frozen=True, eq=False)
class Strays:
    """What of a recording was no sighting of its marker."""

    findings: dict[str, Json]
    """Label → how many sightings, their first frames in the file's own count, the farthest."""
    warnings: tuple[str, ...]
    """One line, or none."""


def without_strays(
    recording: Recording, size: float, bodies: Iterable[Sequence[str]] = ()
) -> tuple[Recording, Strays]:
    """Return the recording with sightings that cannot be the marker's as not seen, and which.

    Those are off the marker's own path, as `kinesphere.geometry.strays.find_strays` tells it, or
    leave the other markers of its body (`find_strays_of_body`); for a tenth of a second at most.

    Parameters
    ----------
    recording
    size
        m, as `kinesphere.skeleton.discovery.size.subject_size` returns it.
    bodies
        Labels of the markers of each body, where they are known.
    """
    rate = recording.rate
    fast = PERSON if TINIEST * PERSON < size < PERSON else size  # whose limbs, how far in a frame
    near = NEAR * max(size, fast * (SLOW / rate) ** 2)
    strays = find_strays(recording.markers, rate, near)
    if strays.any():
        markers = np.where(strays[..., None], np.nan, recording.markers)
    else:
        markers = recording.markers
    for labels in bodies:
        columns = list(recording.columns(tuple(labels)))
        off = find_strays_of_body(np.take(markers, columns, axis=1), rate, OF_BODY * NEAR * size)
        if off.any():
            strays[:, columns] |= off
    if not strays.any():
        return recording, Strays({}, ())
    markers = np.where(strays[..., None], np.nan, recording.markers)
    return replace(recording, markers=markers), _told(recording, strays)


def _told(recording: Recording, strays: Mask) -> Strays:
    findings: dict[str, Json] = {}
    farthest, worst = 0.0, ""
    count = strays.sum(axis=0)
    for c in np.flatnonzero(count):
        at, label = np.flatnonzero(strays[:, c]), recording.labels[c]
        off = _off(recording.markers[:, c], strays[:, c])
        firsts = at[np.diff(at, prepend=-2) > 1]
        i = int(off.argmax())
        if off[i] > farthest:
            farthest = float(off[i])
            worst = f"{label} in frame {recording.first_frame + int(at[i])}"
        findings[label] = {
            "sightings": len(at),
            "first_frames": [recording.first_frame + int(f) for f in firsts[:LISTED]],
            "farthest_mm": round(float(off[i]) * 1e3, 1),
        }
    most = recording.labels[int(count.argmax())]
    n = int(count.sum())
    sightings = "1 sighting is" if n == 1 else f"{n:,} sightings are"
    whose = (
        "" if len(findings) == 1 else f" of {len(findings)} markers (most {most}, {count.max()})"
    )
    told = (
        f"{sightings} off the path{whose} that the marker is on just before and after, by up to "
        f"{in_millimetres(farthest)} ({worst}): taken for missing, and "
        "kept in the files that are written"
    )
    return Strays(findings, (told,))


def _off(path: Array, strays: Mask) -> Array:
    """Return how far strays are from the straight line between the sightings around them, in m."""
    at = np.flatnonzero(strays)
    known = np.flatnonzero(~strays & np.isfinite(path).all(axis=1))
    between = np.stack([np.interp(at, known, path[known, k]) for k in range(3)], axis=1)
    return lengths(path[at] - between)
