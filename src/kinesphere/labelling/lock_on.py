"""Labels live from the first frame on: wait for some motion, recognise the body, follow it.

Recognition takes some seconds of another thread, 6 to 46 on a machine with other work, while frames
come in and get no labels. Those that came meanwhile are made up for in slices: each frame that
comes takes some of them along.
"""

from concurrent.futures import Future, ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, TopologicalModel
from kinesphere.errors import BadSetting
from kinesphere.labelling.crowd import followed, taken
from kinesphere.labelling.live import LiveLabels
from kinesphere.labelling.pair_statistics import match_pair_statistics
from kinesphere.labelling.runs import runs_of
from kinesphere.labelling.settings import LabellingSettings
from kinesphere.labelling.template import template_of, usual_deviations
from kinesphere.labelling.through_time import label_through_time

LONGEST = 3
"""Times the wanted motion that is kept while the body is not recognised."""
SHORTEST_S = 0.1
"""s, shortest trajectory that the body is recognised by: shorter ones are mostly flicker."""
HELD = 0.5
"""Share of the labels that were found, below which a body is lost..."""
LOST_S = 2.0
"""s, ...when it lasts so long: it has left, and is recognised anew when it is back."""
SLICE = 16
"""Frames followed in one call while those that came during recognition are made up for: 5 ms."""


class LiveLabeller:
    """A stream of points that is labelled as soon as the body has moved enough.

    Parameters
    ----------
    model
        With statistics; built-in ones have them.
    rate
        Hz, frames that will come a second.
    seconds
        s of motion to recognise the body by. Two are enough by a model of several people.
    settings
        Of labelling; only ``least_confidence`` is used.
    background
        Whether frames go on while the body is recognised. If not, the frame that completes the
        motion takes as long as that does, and the same frames give the same labels.

    Raises
    ------
    BadSetting
        If rate or seconds are not positive.
    BadModel
        If the model has no statistics.
    """

    def __init__(
        self,
        model: TopologicalModel,
        rate: float,
        seconds: float = 5.0,
        settings: LabellingSettings | None = None,
        *,
        background: bool = True,
    ) -> None:
        if not (rate > 0 and np.isfinite(rate)) or not (seconds > 0 and np.isfinite(seconds)):
            raise BadSetting(f"rate {rate} Hz and {seconds} s: both must be more than nothing")
        self._usual = usual_deviations(model)
        self.labels = model.labels
        """Names of the labels that indices stand for."""
        self.note = f"waiting for {seconds:g} s of motion"
        """Why nothing is labelled; empty once the body is."""
        self._model, self._rate = model, rate
        self._least = (settings or LabellingSettings()).least_confidence
        self._wanted = max(2, round(seconds * rate))
        self._executor = ThreadPoolExecutor(max_workers=1) if background else None
        self._pending: Future[LiveLabels | str] | None = None
        self._live: LiveLabels | None = None
        self._frames: list[Array] = []
        self._behind: list[Array] = []
        self._next = self._wanted
        self._found = 0
        self._poor = 0

    @property
    def locked_on(self) -> bool:
        """Whether the body is recognised and followed."""
        return self._live is not None

    def label(self, points: Array) -> NDArray[np.int64]:
        """Return the index of each point's label, (n_points,), −1 for none.

        Parameters
        ----------
        points : (n_points, 3) m
            Of one frame, in any order, as many as there are; NaN is no point.
        """
        points = np.asarray(points, dtype=np.float64).reshape(-1, 3)
        if self._live is not None and self._behind:
            self._behind.append(points)
            return self._catch_up(self._live)
        if self._live is not None:
            return self._follow(self._live, points)
        self._frames.append(points)
        if self._pending is None and len(self._frames) >= self._next:
            self._start()
        if self._pending is not None and self._pending.done():
            return self._end(self._pending.result())
        return np.full(len(points), -1, dtype=np.int64)

    def close(self) -> None:
        """Stop recognising."""
        if self._executor is not None:
            self._executor.shutdown(cancel_futures=True)

    def _start(self) -> None:
        del self._frames[: -LONGEST * self._wanted]
        self._next = len(self._frames)
        frames = list(self._frames)
        if self._executor is not None:
            self._pending = self._executor.submit(self._recognised, frames)
        else:
            self._pending = Future()
            self._pending.set_result(self._recognised(frames))

    def _recognised(self, frames: list[Array]) -> LiveLabels | str:
        """Return the body to follow from the last of these frames on, or why there is none."""
        points = taken(frames, followed(frames, self._rate))
        for run in runs_of(np.isfinite(points[:, :, 0])):
            if run.end - run.start < SHORTEST_S * self._rate:
                points[run.start : run.end, run.column] = np.nan
        points = points[:, np.isfinite(points[:, :, 0]).any(axis=0)]
        if not points.shape[1]:
            return "no point is seen"
        state = label_through_time(
            points,
            self._rate,
            self._model,
            match_pair_statistics,
            keep_columns=False,
            least_confidence=self._least,
        )
        found = np.isfinite(state.points[-1, :, 0]).sum()
        if 2 * found < len(template_of(self._model).labels):
            return state.notes[0] if state.notes else "less than half of the body is recognised"
        return LiveLabels(state.points, self.labels, self._rate, self._usual)

    def _end(self, result: LiveLabels | str) -> NDArray[np.int64]:
        """Take over what was recognised, and begin to make up for the frames since."""
        self._pending = None
        if isinstance(result, str):
            self.note = result
            self._next = len(self._frames) + max(1, self._wanted // 2)
            return np.full(len(self._frames[-1]), -1, dtype=np.int64)
        last, since = self._frames[self._next - 1], self._frames[self._next :]
        self._live, self.note, self._frames = result, "", []
        self._found = self._poor = 0
        if not since:
            return result.placed(last)
        self._behind = since
        return self._catch_up(result)

    def _catch_up(self, live: LiveLabels) -> NDArray[np.int64]:
        """Follow some of the frames that came meanwhile; return labels of the newest one."""
        newest = self._behind[-1]
        some, self._behind = self._behind[:SLICE], self._behind[SLICE:]
        for points in some:
            given = self._follow(live, points)
            if self._live is None:
                self._behind = []
        return np.full(len(newest), -1, dtype=np.int64) if self._behind else given

    def _follow(self, live: LiveLabels, points: Array) -> NDArray[np.int64]:
        given = live.label(points)
        count = int((given >= 0).sum())
        self._found = max(self._found, count)
        self._poor = self._poor + 1 if count < HELD * self._found else 0
        if self._poor > LOST_S * self._rate:
            self._live, self._next = None, self._wanted
            self.note = "the body was lost; waiting for it to be back"
        return given
