"""How much later one side has it: by how fast limbs turn, which no choice of frame changes."""

import numpy as np
from scipy.signal import correlate

from kinesphere.comparison.offset import TimeOffset
from kinesphere.comparison.sides import Side, told_rotations
from kinesphere.data import Array
from kinesphere.errors import DegenerateMotion
from kinesphere.geometry.rotations import rotation_angle

WINDOW = 0.2
"""s over which a limb's turn is taken: noise averages out, a step does not. With noise of 3° about
each axis in every frame, 0.1 s finds no offset any more, 0.2 s one to a tenth of a frame."""
LEAST_OVERLAP = 0.5
"""Share of the shorter side that both must have in common."""
LEAST_CORRELATION = 0.6
"""Below it the two are not taken for one motion; recordings of different people came to 0.56."""
SURE_CORRELATION = 0.8
"""Below it a warning says to look."""
STILL = np.deg2rad(2.0)
"""rad/s, standard deviation of the speeds below which nothing moves enough to find an offset."""
RIVAL = 0.98
"""Share of the best correlation from which another peak, more than RIVAL_APART away, is said."""
RIVAL_APART = 0.3
"""s."""


def find_offset(first: Side, second: Side) -> TimeOffset:
    """Find the offset at which the limbs of both sides turn at the same speeds.

    The speed at which a limb turns is the same in every world and in every frame fixed to the limb.
    Speeds of all limbs with one name are correlated together, gaps left out (Padfield 2012,
    doi:10.1109/TIP.2011.2181402), at every lag at which half of the shorter side overlaps; the peak
    is refined by a parabola; `refined` makes it better still.

    Raises
    ------
    DegenerateMotion
        If no limb has the same name, or the best correlation is below LEAST_CORRELATION.
    """
    names = [n for n in first.motion.skeleton.limb_names if n in second.motion.skeleton.limb_names]
    if not names:
        raise DegenerateMotion(
            "no limb has the same name on both sides: "
            f"{_some(first.motion.skeleton.limb_names)} here, "
            f"{_some(second.motion.skeleton.limb_names)} there"
        )
    rate = max(first.motion.rate, second.motion.rate)
    speeds = [limb_speeds(side, names, rate) for side in (first, second)]
    spread = [
        float(np.nanmax(np.nanstd(s, axis=0), initial=0.0)) if _any(s) else 0.0 for s in speeds
    ]
    if min(spread) < STILL:
        shared = min(first.duration, second.duration)
        return TimeOffset(
            0.0,
            float("nan"),
            shared,
            given=False,
            warnings=("hardly anything moves: no time offset can be found, 0 s was taken",),
        )
    lags, correlations = pooled_correlation(*speeds)
    if not np.isfinite(correlations).any():
        raise DegenerateMotion(
            "no offset has both sides seen together for half of the shorter one; "
            "--offset says how much later the second is"
        )
    peak = int(np.nanargmax(correlations))
    best = float(correlations[peak])
    if best < LEAST_CORRELATION:
        raise DegenerateMotion(
            f"these are not two records of one motion: the speeds of {len(names)} limbs "
            f"correlate by {best:.2f} at best, {LEAST_CORRELATION} is the least; "
            "--offset compares them anyway"
        )
    fine = _parabola(correlations, peak)
    seconds = -(float(lags[0]) + fine) / rate
    return TimeOffset(
        seconds + 0.0,
        best,
        overlap_of(first, second, seconds),
        given=False,
        warnings=_doubts(lags / rate, correlations, peak),
    )


def overlap_of(first: Side, second: Side, offset: float) -> float:
    """Return how many seconds both sides have in common; negative where they have none."""
    return min(first.duration, second.duration - offset) - max(0.0, -offset)


def limb_speeds(side: Side, names: list[str], rate: float) -> Array:
    """Return how fast limbs turn, (n, n_limbs) rad/s from time 0 on, at a rate of at least theirs.

    Each is a turn over about WINDOW, put to the middle of it; the fastest hundredth is cut off, for
    that is where poses leap. NaN where unseen.
    """
    motion = side.motion
    columns = [motion.skeleton.limb_names.index(name) for name in names]
    step = max(1, round(WINDOW * motion.rate))
    n = max(round(side.duration * rate) + 1, 1)
    if motion.n_frames <= step:
        return np.full((n, len(names)), np.nan)
    rotations = told_rotations(side)[:, columns]
    turns = rotation_angle(np.swapaxes(rotations[:-step], -1, -2) @ rotations[step:])
    speeds = turns * motion.rate / step
    for column in speeds.T:
        if np.isfinite(column).any():
            np.minimum(column, np.nanpercentile(column, 99), out=column)
    times = (np.arange(len(speeds)) + step / 2) / motion.rate
    wanted = np.arange(n) / rate
    inside = (wanted >= times[0] - 1e-9) & (wanted <= times[-1] + 1e-9)
    placed = np.full((n, len(names)), np.nan)
    for i, column in enumerate(speeds.T):  # NaN on either side of a time makes it NaN
        placed[inside, i] = np.interp(wanted[inside], times, column)
    return placed


def pooled_correlation(first: Array, second: Array) -> tuple[Array, Array]:
    """Return lags in samples and the correlation of all columns together at each.

    At lag k, ``first[i + k]`` stands against ``second[i]``. NaN where the overlap is less than
    LEAST_OVERLAP of the shorter side.

    Parameters
    ----------
    first, second : (n, n_columns), (m, n_columns)
        NaN is a gap.
    """
    lags = np.arange(-(len(second) - 1), len(first))
    both, a_var, b_var, counts = (np.zeros(len(lags)) for _ in range(4))
    for a, b in zip(first.T, second.T, strict=True):
        known_a, known_b = np.isfinite(a), np.isfinite(b)
        if not (known_a.any() and known_b.any()):
            continue
        a = np.where(known_a, a - a[known_a].mean(), 0.0)
        b = np.where(known_b, b - b[known_b].mean(), 0.0)
        mask_a, mask_b = known_a * 1.0, known_b * 1.0
        n = np.maximum(np.round(_cross(mask_a, mask_b)), 1e-9)
        sum_a, sum_b = _cross(a, mask_b), _cross(mask_a, b)
        both += _cross(a, b) - sum_a * sum_b / n
        a_var += np.maximum(_cross(a**2, mask_b) - sum_a**2 / n, 0.0)
        b_var += np.maximum(_cross(mask_a, b**2) - sum_b**2 / n, 0.0)
        counts = np.maximum(counts, n)
    least = max(3.0, LEAST_OVERLAP * counts.max(initial=0.0))
    scale = np.sqrt(a_var * b_var)
    usable = (counts >= least) & (scale > 1e-9 * scale.max(initial=0.0))
    return lags.astype(np.float64), np.where(usable, both / np.where(usable, scale, 1.0), np.nan)


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(correlate(a, b, mode="full", method="fft"))


def _parabola(values: Array, peak: int) -> float:
    """Return where the parabola through the peak and its neighbours is highest."""
    if not 0 < peak < len(values) - 1:
        return float(peak)
    left, top, right = values[peak - 1 : peak + 2]
    bend = left - 2 * top + right
    return float(peak) if not bend < 0 else peak + 0.5 * float((left - right) / bend)


def _doubts(times: Array, correlations: Array, peak: int) -> tuple[str, ...]:
    best = float(correlations[peak])
    said = []
    if best < SURE_CORRELATION:
        said.append(
            f"the speeds of the limbs correlate by {best:.2f} only: "
            "are these two records of one motion?"
        )
    elsewhere = np.abs(times - times[peak]) > RIVAL_APART
    other = np.where(elsewhere, np.nan_to_num(correlations, nan=-1.0), -1.0)
    rival = int(other.argmax())
    if other[rival] > RIVAL * best:
        said.append(
            f"an offset of {-times[rival]:+.2f} s fits nearly as well ({other[rival]:.3f} against "
            f"{best:.3f}): the motion repeats itself"
        )
    return tuple(said)


def _some(names: tuple[str, ...]) -> str:
    return ", ".join(names[:4]) + (", …" if len(names) > 4 else "")


def _any(values: Array) -> bool:
    return bool(np.isfinite(values).any(axis=0).all()) and values.size > 0
