"""What becomes of markers while a whole limb is hidden, bodies and joints from motion alone."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import CubicSpline

from benchmarks.accuracy.bodies.cases import hidden as unlabelled
from kinesphere.skeleton import discover, fill_markers, fit_skeleton
from kinesphere.synthetic import make_performance

LIMBS = ("left_thigh", "right_shank", "left_upper_arm", "trunk", "right_foot")
SECONDS = (0.1, 0.3, 1.0, 2.0)


@dataclass(frozen=True)
class Hiding:
    """A limb hidden again and again for so long, in free motion."""

    limb: str
    seconds: float
    placed: float
    """Share of its hidden marker samples that were placed."""
    median_mm: float
    p95_mm: float
    spline_mm: float
    """Median error of a cubic spline through each marker by itself."""


def hiding_rows() -> list[Hiding]:
    """Return a row a limb and length of the gap."""
    performance = make_performance(np.random.default_rng(3))
    recording, rate = performance.recording, performance.recording.rate
    rows = []
    for limb in LIMBS:
        columns = recording.columns(performance.skeleton.limb(limb).markers)
        for seconds in SECONDS:
            n = round(seconds * rate)
            hidden = np.zeros(recording.n_frames, dtype=bool)
            for start in range(3100, 3900 - n, max(2 * n, 60)):
                hidden[start : start + n] = True
            markers = np.array(recording.markers)
            markers[np.ix_(np.flatnonzero(hidden), columns)] = np.nan
            spoilt = unlabelled(replace(recording, markers=markers))
            filled = fill_markers(spoilt, fit_skeleton(spoilt, discover(spoilt).model))
            truth = recording.markers[hidden][:, columns]
            off = np.linalg.norm(filled.markers[hidden][:, columns] - truth, axis=2)
            known = off[np.isfinite(off)]
            seen = np.flatnonzero(~hidden)
            splined = CubicSpline(seen, markers[seen][:, columns])(np.flatnonzero(hidden))
            rows.append(
                Hiding(
                    limb=limb,
                    seconds=seconds,
                    placed=len(known) / off.size,
                    median_mm=1e3 * float(np.median(known)) if len(known) else np.nan,
                    p95_mm=1e3 * float(np.percentile(known, 95)) if len(known) else np.nan,
                    spline_mm=1e3 * float(np.median(np.linalg.norm(splined - truth, axis=2))),
                )
            )
    return rows
