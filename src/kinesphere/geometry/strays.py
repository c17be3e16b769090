"""Markers that are elsewhere for a moment: what of a trajectory cannot be the marker's."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.even_frames import even_frames
from kinesphere.geometry.medians import column_medians
from kinesphere.geometry.vectors import lengths
from kinesphere.kernels.distances import pair_distances_kernel
from kinesphere.kernels.stray_steps import find_steps_kernel
from kinesphere.kernels.strays import judge_runs_kernel

LONGEST = 0.1
"""s; what is away for longer may have moved there and back: a fist does in 0.15 s."""
RUN = (1, 10)
"""Frames that `LONGEST` is at least and at most."""
AT_END = 3
"""Frames at most of a run that the path is known on one side of only: nothing says it came back."""
FASTEST = 400.0
"""Times `least` per second, 20 m/s of a person, that nothing moves by: a run at an end strays only
beyond, as its marker may have stopped there. A kick in the first frame of a cut does 3 m/s."""
STRETCHED = 100.0
"""The same for distances within a body, 2.5 m/s: skin and cloth go there and back by less."""
PASSES = 16
"""Times that paths are looked at again at most: what strays beside other strays shows when these
are gone."""
MATES = 5
"""Nearest markers of its body that a marker is held against: more, of 50, take time only."""
SAMPLED = 100
"""Frames that show which are the nearest."""

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


def find_strays(markers: Array, rate: float, least: float, fastest: float = FASTEST) -> Mask:
    """Return which sightings are off their marker's own path for a moment, (n_frames, n).

    A run of frames strays if the marker steps into and out of it, and is off the cubic between what
    comes before and after in all of it, by more than `least`, than the usual second difference
    around, than its own speed and than what both sides miss each other by: a marker that leaves and
    comes back by steps that its path does not know. Short runs are looked for first. Who leaves and
    stays, or leaves in a movement, does not stray; nor does what the markers beside do matter.

    Parameters
    ----------
    markers : (n_frames, n, 3) m
        NaN where not seen.
    rate
        Hz
    least
        m, above 0; what is nearer to the path is noise.
    fastest
        Times ``least`` per second that nothing moves by; asked at ends of trajectories only.
    """
    strays: Mask = np.zeros(markers.shape[:2], dtype=bool)
    steps: Mask = np.empty_like(strays)
    find_steps_kernel(markers, least, steps)
    starts, columns = np.nonzero(steps)
    longest = int(np.clip(LONGEST * rate + 1e-9, *RUN))
    lengths_of = {False: range(1, longest + 1), True: range(1, AT_END + 1)}
    step = fastest * least / rate if rate > 0 else np.inf
    at_end = False
    for _ in range(PASSES):
        found = 0
        for length in lengths_of[at_end] if len(starts) else ():
            if new := judge_runs_kernel(
                markers, starts, columns, length, least, step, at_end, strays
            ):
                markers = np.where(strays[..., None], np.nan, markers)
                found += new
        if not found and at_end:
            break
        at_end = not found  # ends are judged by what is left
        keep = ~strays[starts, columns]
        starts, columns = starts[keep], columns[keep]
    return strays


def find_strays_of_body(body: Array, rate: float, least: float) -> Mask:
    """Return which sightings stray from the other markers of a rigid body, (n_frames, n).

    Distances to the body's other markers are paths of their own, on which no movement of the body
    shows: there, what strays in a fast movement is found, too. A sighting is off where most of its
    distances stray and most of those of the others do not on its account: of three markers both.

    Parameters
    ----------
    body : (n_frames, n, 3) m
        Markers that keep their distances, more or less.
    rate
        Hz
    least
        m, of distances. What moves across the distance changes it less.
    """
    n = body.shape[1]
    strays: Mask = np.zeros(body.shape[:2], dtype=bool)
    if n < 3:
        return strays
    pairs = _pairs(body)
    apart = np.zeros((len(body), len(pairs), 3))
    pair_distances_kernel(np.ascontiguousarray(body), pairs, apart[..., 0])
    off = find_strays(apart, rate, least, STRETCHED)
    if not off.any():
        return strays
    frames = np.flatnonzero(off.any(axis=1))
    ends = np.zeros((len(pairs), n))
    ends[np.arange(len(pairs)), pairs[:, 0]] = ends[np.arange(len(pairs)), pairs[:, 1]] = 1.0
    seen = np.isfinite(apart[frames, :, 0]) @ ends
    count = off[frames] @ ends
    most = count == count.max(axis=1, keepdims=True)
    strays[frames] = (count >= 2) & (2 * count > seen) & most
    return strays


def _pairs(body: Array) -> NDArray[np.intp]:
    """Return each marker with its nearest others, `MATES` at most, (n_pairs, 2)."""
    few = body[even_frames(len(body), SAMPLED)]
    pairs = set()
    for m in range(body.shape[1]):
        usual = column_medians(off := lengths(few - few[:, m : m + 1]), np.isfinite(off))
        usual[m] = np.nan
        near = np.argsort(usual, kind="stable")[: min(MATES, int(np.isfinite(usual).sum()))]
        pairs |= {(min(m, int(k)), max(m, int(k))) for k in near}
    return np.array(sorted(pairs), dtype=np.intp).reshape(-1, 2)
