"""What tracking without markers found, as tables and as one object for machines."""

from typing import Any

import numpy as np

from kinesphere.cli.console import print_table, print_title, stdout
from kinesphere.markerless import TrackedMotion

_OVERLAPS = ("overlap_mean", "overlap_least", "overlap_with_masks")


def describe_tracking(tracked: TrackedMotion, cameras: list[str]) -> dict[str, Any]:
    """Return overlap by camera, and support and lost frames by limb."""

    def mean(values: Any) -> float:
        known = values[np.isfinite(values)]
        return float(known.mean()) if len(known) else float("nan")

    def least(values: Any) -> float:
        known = values[np.isfinite(values)]
        return float(known.min()) if len(known) else float("nan")

    return {
        "n_frames": tracked.n_frames,
        "n_solved": int(tracked.solved.sum()),
        "overlap_mean": mean(tracked.overlap),
        "cameras": [
            {
                "name": name,
                "overlap_mean": mean(o),
                "overlap_least": least(o),
                "overlap_with_masks": mean(m),
                "n_masks": int(np.isfinite(m).sum()),
            }
            for name, o, m in zip(
                cameras, tracked.overlap.T, tracked.overlap_with_masks.T, strict=True
            )
        ],
        "limbs": [
            {
                "name": name,
                "support_mean": mean(tracked.support[:, i]),
                "support_least": least(tracked.support[:, i]),
                "frames_lost": int(tracked.lost[:, i].sum()),
            }
            for i, name in enumerate(tracked.limb_names)
        ],
        "seconds": dict(tracked.seconds),
    }


def show_tracking(found: dict[str, Any]) -> None:
    """Print overlap by camera, and the limbs that were lost or hardly supported."""
    console = stdout()
    print_title(console, "Cameras", f"{found['n_solved']} of {found['n_frames']} frames solved")
    rows = [
        (c["name"], *(_share(c[key]) for key in _OVERLAPS), str(c["n_masks"] or ""))
        for c in found["cameras"]
    ]
    header = ("camera", "overlap, mean", "least", "with given masks", "masks")
    shown = len(header) if any(c["n_masks"] for c in found["cameras"]) else 3
    print_table(console, header[:shown], [row[:shown] for row in rows], "lrrrr")
    print_title(console, "Limbs", "support: share of the visible rim that speaks for the pose")
    limbs = [
        (
            limb["name"],
            _share(limb["support_mean"]),
            _share(limb["support_least"]),
            str(limb["frames_lost"] or ""),
        )
        for limb in found["limbs"]
    ]
    print_table(console, ("limb", "support, mean", "least", "frames lost"), limbs, "lrrr")


def _share(value: float) -> str:
    return "–" if value != value else f"{value:.2f}"
