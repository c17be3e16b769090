"""Ways to spoil what cameras see. Each leaves its input as it is and is remembered in the history.

What a spoiler adds to one marker or frame it draws from the generator; where a marker is not seen,
it stays not seen.
"""

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from kinesphere import __version__
from kinesphere.data import History, Json, Mask, Recording, Step, UpAxis
from kinesphere.errors import BadSetting


def spoil_with_noise(
    recording: Recording, rng: np.random.Generator, *, deviation: float = 0.001
) -> Recording:
    """Add independent Gaussian noise of ``deviation`` m to every coordinate of every sample."""
    check_range("deviation", deviation, low=0)
    noise = rng.normal(scale=deviation, size=recording.markers.shape)
    return replace(
        recording,
        markers=recording.markers + noise,
        history=remembered(recording, "noise", {"deviation_mm": deviation * 1e3}),
    )


def spoil_with_gaps(
    recording: Recording, rng: np.random.Generator, *, share: float = 0.1, gap_s: float = 0.3
) -> Recording:
    """Hide markers for a while, each on its own.

    Seen and hidden runs follow each other, their lengths exponential with means that make
    ``gap_s`` s the mean gap and ``share`` the expected share hidden.
    """
    check_range("share", share, low=0, high=0.95)
    check_range("gap_s", gap_s, low=1 / recording.rate)
    hidden = np.zeros((recording.n_frames, recording.n_markers), dtype=np.bool_)
    if share > 0:
        for m in range(recording.n_markers):
            hidden[:, m] = _runs(rng, recording.n_frames, share, gap_s * recording.rate)
    residuals = recording.residuals
    return replace(
        recording,
        markers=np.where(hidden[..., None], np.nan, recording.markers),
        residuals=None if residuals is None else np.where(hidden, np.nan, residuals),
        history=remembered(
            recording,
            "gaps",
            {"share": share, "gap_s": gap_s},
            {"hidden_percent": 100 * float(hidden.mean())},
        ),
    )


def spoil_with_swaps(
    recording: Recording, rng: np.random.Generator, *, n_swaps: int = 5, swap_s: float = 1.0
) -> Recording:
    """Exchange two neighbouring markers' trajectories, ``n_swaps`` times for ``swap_s`` s each.

    Each swap starts at a random frame, with a random marker seen there and the marker closest to
    it then: what a tracker confuses.
    """
    check_range("n_swaps", n_swaps, low=0)
    markers = recording.markers.copy()
    residuals = None if recording.residuals is None else recording.residuals.copy()
    length = max(1, round(swap_s * recording.rate))
    swaps: list[Json] = []
    for _ in range(n_swaps):
        start = int(rng.integers(recording.n_frames))
        seen = np.flatnonzero(recording.seen[start])
        if len(seen) < 2:
            continue
        one = int(rng.choice(seen))
        distances = np.linalg.norm(recording.markers[start] - recording.markers[start, one], axis=1)
        distances[one] = np.nan
        other = int(np.nanargmin(distances))
        now = slice(start, start + length)
        markers[now, [one, other]] = markers[now, [other, one]]
        if residuals is not None:
            residuals[now, [one, other]] = residuals[now, [other, one]]
        end_s = min(start + length, recording.n_frames) / recording.rate
        labels = recording.labels
        swaps.append(
            {
                "markers": [labels[one], labels[other]],
                "start_s": start / recording.rate,
                "end_s": end_s,
            }
        )
    return replace(
        recording,
        markers=markers,
        residuals=residuals,
        history=remembered(
            recording, "swaps", {"n_swaps": n_swaps, "swap_s": swap_s}, {"swaps": swaps}
        ),
    )


def spoil_with_ghosts(
    recording: Recording,
    rng: np.random.Generator,
    *,
    n_ghosts: int = 10,
    ghost_s: float = 0.3,
    speed: float = 1.0,
) -> Recording:
    """Add unlabelled markers that are none: reflections seen for about ``ghost_s`` s.

    Each appears at a random frame within 0.3 m of a random marker, drifts straight at up to
    ``speed`` m/s and vanishes. Their labels continue the ``*0``, ``*1``… of the recording.
    """
    check_range("n_ghosts", n_ghosts, low=0)
    check_range("ghost_s", ghost_s, low=0)
    ghosts = np.full((recording.n_frames, n_ghosts, 3), np.nan)
    sighted = np.argwhere(recording.seen)
    for g in range(n_ghosts if len(sighted) else 0):
        start, marker = sighted[rng.integers(len(sighted))]
        length = 1 + int(rng.exponential(ghost_s * recording.rate))
        end = min(start + length, recording.n_frames)
        offset, drift = rng.normal(size=(2, 3))
        offset *= 0.3 * rng.uniform(0.1, 1) / np.linalg.norm(offset)
        drift *= speed * rng.uniform() / np.linalg.norm(drift)
        seconds = np.arange(end - start)[:, None] / recording.rate
        ghosts[start:end, g] = recording.markers[start, marker] + offset + seconds * drift
    taken = set(recording.labels)
    free = (f"*{k}" for k in range(len(taken) + n_ghosts) if f"*{k}" not in taken)
    labels = recording.labels + tuple(next(free) for _ in range(n_ghosts))
    residuals = recording.residuals
    if residuals is not None:
        residuals = np.c_[residuals, np.full((len(residuals), n_ghosts), np.nan)]
    settings: dict[str, Json] = {"n_ghosts": n_ghosts, "ghost_s": ghost_s, "speed_m_per_s": speed}
    return replace(
        recording,
        markers=np.concatenate([recording.markers, ghosts], axis=1),
        labels=labels,
        residuals=residuals,
        history=remembered(recording, "ghosts", settings),
    )


def spoil_with_turned_camera(
    recording: Recording,
    rng: np.random.Generator,
    *,
    claimed_up: UpAxis | None = None,
    mirrored: bool = False,
) -> Recording:
    """Give the positions in another frame: turned about up, moved by metres, axes permuted.

    The permutation is a proper one with signs, drawn from all 24; ``mirrored`` negates its last
    axis, as a left-handed export does. What the new frame says of up is ``claimed_up``, which may
    be wrong or nothing at all.
    """
    angle = rng.uniform(-np.pi, np.pi)
    heading = Rotation.from_rotvec([0, angle, 0]).as_matrix()
    permuted = Rotation.create_group("O").as_matrix()[rng.integers(24)].round()
    flip = np.diag([1.0, 1.0, -1.0 if mirrored else 1.0])
    turn, shift = flip @ permuted @ heading, rng.uniform(-3, 3, 3)
    findings: dict[str, Json] = {"turn": turn.tolist(), "shift_m": shift.tolist()}
    return replace(
        recording,
        markers=recording.markers @ turn.T + shift,
        up=claimed_up,
        history=remembered(
            recording,
            "turned camera",
            {"claimed_up": claimed_up, "mirrored": mirrored},
            findings,
        ),
    )


def spoil_with_wrong_unit(recording: Recording, *, factor: float = 1000.0) -> Recording:
    """Multiply every position by ``factor``: millimetres that pass for metres."""
    check_range("factor", factor, low=1e-9)
    residuals = recording.residuals
    return replace(
        recording,
        markers=recording.markers * factor,
        residuals=None if residuals is None else residuals * factor,
        history=remembered(recording, "wrong unit", {"factor": factor}),
    )


def _runs(rng: np.random.Generator, n_frames: int, share: float, gap: float) -> Mask:
    """Draw a mask of (n_frames,) whose True runs take ``gap`` frames and ``share`` on average."""
    seen = gap * (1 - share) / share
    n_runs = 2 * (2 + int(2 * n_frames / (gap + seen)))
    first = bool(rng.random() < share)
    means = np.where(np.arange(n_runs) % 2 == (0 if first else 1), gap, seen)
    ends = np.cumsum(rng.exponential(means))
    while ends[-1] < n_frames:  # short runs in a row: draw more of them
        ends = np.r_[ends, ends[-1] + np.cumsum(rng.exponential(means))]
    run = np.searchsorted(ends, np.arange(n_frames) + 0.5)
    return np.asarray((run % 2 == 0) == first)


def remembered(
    recording: Recording,
    what: str,
    settings: dict[str, Json],
    findings: dict[str, Json] | None = None,
) -> History:
    """Return the recording's history and one more step."""
    step = Step(f"spoil: {what}", settings, findings or {}, version=__version__)
    return (*recording.history, step)


def check_range(name: str, value: float, *, low: float, high: float = np.inf) -> None:
    """Raise BadSetting unless ``value`` lies in a closed range."""
    if not low <= value <= high:
        upper = "" if high == np.inf else f" and at most {high}"
        raise BadSetting(f"{name} is {value}; it must be at least {low}{upper}")
