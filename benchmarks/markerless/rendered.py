"""Films whose truth is known, tracked: the paper's two sequences and what goes beyond them."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.markerless.given_start import disturbed_start
from benchmarks.markerless.measures import Errors, errors_of
from kinesphere.data import BodyChoice, Footage, Frame, Surface, bundled_body
from kinesphere.errors import KinesphereError
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.tracker import track
from kinesphere.synthetic.film import another_person, make_film

TURN_FRAMES = 300
"""Of one whole turn: with fewer frames it is cut short, not hurried."""


@dataclass(frozen=True)
class Case:
    """One film and how it is tracked."""

    name: str
    movement: str
    conditions: str = "plain"
    method: str = "region"
    n_cameras: int = 4
    other: bool = False
    """A person built 3 to 8 % unlike the model, whose shape is fitted; else the true shape."""
    mesh: bool = False
    """Whether that person is made from another body than the model, too: of the other sex, or more
    so of the same, of other weight, muscles and build."""
    masks: bool = False
    given: bool = False
    """Whether the first pose is given but for 2° and 8 mm; else it is found."""
    by: str = ""
    """What a start that is found is found by: the images alone; ``plates`` of the empty room; or
    ``masks`` of the first frame, perfect ones."""
    seeds: tuple[int, ...] = (1,)
    mean: float | None = None
    """deg, what the mean absolute error of the elbows is to stay below."""
    rms: float | None = None
    joints: float | None = None
    """mm."""
    whole: bool = False
    """Whether no limb may be lost, where no other limit is set."""
    to_fail: bool = False
    """Whether the row is there to show that the limits are passed."""

    @property
    def limited(self) -> bool:
        """Whether the case can be missed."""
        return self.whole or any(x is not None for x in (self.mean, self.rms, self.joints))


CASES = (
    Case("arms, true shape", "arms", rms=1.2, joints=10),
    Case("push-ups, true shape", "push-ups", given=True, rms=1.2, joints=10),
    Case("arms, shape fitted", "arms", other=True, mean=1.7, rms=2.3, joints=10),
    Case(
        "push-ups, shape fitted", "push-ups", other=True, given=True, mean=1.7, rms=2.3, joints=10
    ),
    Case(
        "push-ups, shape fitted, by plates",
        "push-ups",
        other=True,
        by="plates",
        mean=1.7,
        rms=2.3,
        joints=10,
    ),
    Case(
        "arms, another mesh, shape fitted",
        "arms",
        other=True,
        mesh=True,
        seeds=(1, 2, 3),
        mean=1.7,
        rms=2.3,
        joints=10,
    ),
    Case(
        "arms, partly hidden, shape fitted",
        "arms",
        "hidden",
        other=True,
        given=True,
        mean=1.7,
        rms=2.3,
        joints=10,
    ),
    Case(
        "push-ups, partly hidden, shape fitted",
        "push-ups",
        "hidden",
        other=True,
        given=True,
        mean=1.7,
        rms=2.3,
        joints=10,
    ),
    Case("turn, three cameras", "turn", n_cameras=3, other=True, whole=True),
    Case("whole body", "body", other=True),
    Case("arms, perfect masks", "arms", masks=True, rms=0.7, joints=3),
    Case(
        "arms in clutter, region",
        "arms",
        "clutter",
        other=True,
        given=True,
        seeds=(1, 2, 3, 4, 5),
        rms=4.0,
    ),
    Case(
        "arms in clutter, region, by masks",
        "arms",
        "clutter",
        other=True,
        by="masks",
        seeds=(1, 2, 3, 4, 5),
        rms=4.0,
    ),
    Case(
        "arms in clutter, plain level set",
        "arms",
        "clutter",
        "level-set",
        other=True,
        given=True,
        seeds=(1, 2, 3, 4, 5),
        rms=4.0,
        to_fail=True,
    ),
    Case(
        "arms in clutter, coupled",
        "arms",
        "clutter",
        "coupled",
        other=True,
        given=True,
        seeds=(1, 2, 3, 4, 5),
        rms=4.0,
    ),
    Case("arms, level set", "arms", method="level-set"),
)


@dataclass(frozen=True)
class Outcome:
    """What a case gave with one seed."""

    case: Case
    seed: int
    n_frames: int
    errors: Errors | None
    failed: str = ""
    """Why there is nothing to measure."""

    @property
    def missed(self) -> bool:
        """Whether it fails and is not there to show that."""
        return self.fails and not self.case.to_fail

    @property
    def fails(self) -> bool:
        """Whether a limit of the case is passed, or a limb lost."""
        if self.errors is None:
            return True
        e, c = self.errors, self.case
        pairs = ((e.elbow_mean, c.mean), (e.elbow_rms, c.rms), (e.joints_mean, c.joints))
        return any(limit is not None and value > limit for value, limit in pairs) or (
            c.limited and e.frames_astray + e.frames_unsolved > 0
        )


def another_mesh(model: Surface, seed: int) -> Surface:
    """Return a body with the model's joints but another skin, and joints elsewhere below it."""
    rng = np.random.default_rng([seed, 78])
    build = {name: float(rng.uniform(-1, 1)) for name in ("weight", "muscle", "proportions")}
    return model.shaped({"sex": float(rng.choice([-1.0, 1.0])), **build})


@dataclass(frozen=True, eq=False)
class MasksOnce:
    """Footage of which somebody has masked the first frame, and no other."""

    footage: Footage

    def frames(self, start: int, stop: int, step: int = 1) -> Iterator[Frame]:
        """Yield frames."""
        for frame in self.footage.frames(start, stop, step):
            none = (None,) * len(frame.masks)
            masks = none if frame.index else frame.masks
            yield replace(frame, masks=masks, references=frame.masks)


def outcomes(
    only: str = "", n_frames: int = 300, only_seed: int | None = None
) -> Iterator[Outcome]:
    """Yield the outcome of every case whose name holds ``only``, seed after seed."""
    for case in CASES:
        if only in case.name:
            for seed in case.seeds:
                if only_seed in (None, seed):
                    yield _outcome(case, seed, n_frames)


def _outcome(case: Case, seed: int, n_frames: int) -> Outcome:
    model = bundled_body()
    person = another_mesh(model, seed) if case.mesh else model
    if case.other:
        person = another_person(person, np.random.default_rng([seed, 77]))
    film = make_film(
        seed,
        case.movement,
        conditions=case.conditions,
        n_frames=max(n_frames, TURN_FRAMES) if case.movement == "turn" else n_frames,
        n_cameras=case.n_cameras,
        surface=person,
        masks=case.masks,
        plates=case.by == "plates",
    )
    scene = replace(film.scene, n_frames=n_frames, body=BodyChoice(fit=case.other))
    if case.by == "masks":
        scene = replace(scene, footage=MasksOnce(film.footage), has_masks=True)
    try:
        start = disturbed_start(film, model, seed) if case.given else None
        tracked = track(scene, model, TrackSettings(method=case.method), start=start)
    except KinesphereError as error:
        return Outcome(case, seed, n_frames, None, str(error))
    return Outcome(case, seed, n_frames, errors_of(tracked, film))
