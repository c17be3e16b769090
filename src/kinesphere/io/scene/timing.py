"""At what rate the cameras of a scene ran, and which frames all of them cover."""

from collections.abc import Sequence
from pathlib import Path

from kinesphere.errors import BadScene
from kinesphere.io.scene.opened import OpenedCamera
from kinesphere.io.scene.spec import SceneSpec

_SAME_RATE = 0.005
"""Cameras whose rates differ by less run at one rate: 59.94 and 60 Hz do."""


def common_rate(
    spec: SceneSpec, opened: Sequence[OpenedCamera], path: Path
) -> tuple[float, list[str]]:
    """Return the rate, Hz, and what is said of it; BadScene where cameras differ or nothing says.

    ``rate_hz`` goes before what videos say: slow motion is often saved at the rate it is played.
    """
    told = {o.spec.name: o.stream.rate for o in opened if o.stream.rate is not None}
    if told:
        low, high = min(told, key=lambda n: told[n]), max(told, key=lambda n: told[n])
        if told[high] > told[low] * (1 + _SAME_RATE):
            raise BadScene(
                f"{path}: {low} runs at {told[low]:g} Hz and {high} at {told[high]:g} Hz; cameras "
                "must run at one rate"
            )
    if (rate := spec.rate_hz) is not None:
        other = next((n for n, r in told.items() if abs(r - rate) > _SAME_RATE * rate), None)
        if other is None:
            return rate, []
        return rate, [
            f"rate_hz = {rate:g} is used, but {other} says {told[other]:g} Hz: right if it was "
            "saved to be played slower or faster than it happened; otherwise leave rate_hz out"
        ]
    if told:
        return float(told[next(iter(told))]), []
    if min(o.stream.n_frames for o in opened) == 1:
        return 1.0, []  # one instant has no rate
    raise BadScene(f"{path}: images alone have no rate; write rate_hz = 60")


def common_span(
    spec: SceneSpec, opened: Sequence[OpenedCamera], path: Path
) -> tuple[int, int, list[str]]:
    """Return the first frame used, how many there are, and what is said of uneven streams.

    Raises
    ------
    BadScene
        If no instant is covered by every camera, or not those that the scene asks for.
    """
    begin = max(0, *(-o.spec.offset for o in opened))
    ends = {o.spec.name: o.stream.n_frames - o.spec.offset for o in opened}
    n = min(ends.values())
    if n <= begin:
        short = min(ends, key=lambda name: ends[name])
        raise BadScene(
            f"{path}: no instant is covered by every camera: after its offset {short} has "
            f"{max(0, ends[short])} frames, and the scene begins at {begin}"
        )
    warnings = []
    if len(set(ends.values())) > 1:
        counts = ", ".join(f"{name} {count}" for name, count in ends.items())
        warnings.append(
            f"the cameras cover unequal numbers of frames ({counts}); the scene ends after {n}, "
            "and unequal counts may mean that one camera dropped frames or began earlier"
        )
    first, last = begin, n - 1
    if spec.frames is not None:
        first, last = spec.frames
        if not begin <= first <= last < n:
            raise BadScene(
                f"{path}: frames = [{first}, {last}], but the cameras cover frames {begin} to "
                f"{n - 1}"
            )
    return first, last - first + 1, warnings
