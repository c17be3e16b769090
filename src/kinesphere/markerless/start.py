"""The first pose, from silhouettes alone: where, how large, which way, arms and legs."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.data.surface import Surface
from kinesphere.markerless.body import Body
from kinesphere.markerless.eyes import with_body
from kinesphere.markerless.fit import Fitter
from kinesphere.markerless.hull import visual_hull
from kinesphere.markerless.hypotheses import facing, leg_poses, standing, turned_about
from kinesphere.markerless.kernels.contour import NOWHERE
from kinesphere.markerless.pose import Pose, posed
from kinesphere.markerless.prediction import rest
from kinesphere.markerless.search import shaken, with_arms_found
from kinesphere.markerless.shape import FACTORS, shaped
from kinesphere.markerless.shape_fit import Instant, fit_shape
from kinesphere.markerless.sketch import Sketch, sketch_of
from kinesphere.markerless.stance import Stance, stances_of

_COARSE, _WHOLE, _LAST = 8, 4, 2
"""Candidates whose legs are searched; then their arms; then fitted closely."""
_APART = 0.7
"""Cosine between two headings above which they count as one."""
_LARGE, _SMALL = (0.25, 0.15), (0.12, 0.06)
"""rad by which joints are shaken: of a coarse start, of one that is about right."""
_TRIES = 16
_LOWER = ("pelvis", "trunk", *(f"{s}_{b}" for s in ("left", "right") for b in ("thigh", "shank")))
_SHAPE = (((8, 2), (4, 3)), ((4, 2), (2, 3)), ((2, 3), (1, 3)))
_TIGHT = 3.0
"""How much more tightly the proportions are held than by many instants."""
_FINER = ((4, 2), (2, 4), (1, 3))


@dataclass(frozen=True, eq=False)
class _Tried:
    """A candidate, and how much it explains in nats."""

    worth: float
    pose: Pose
    logs: Array
    sketch: Sketch


@dataclass(frozen=True, eq=False)
class Start:
    """A first pose, and the proportions it was found with."""

    pose: Pose
    logs: Array
    """(n_factors,) logarithms of the factors of `shape`."""
    overlap: Array
    """(n_cameras,) of the model with the silhouettes; NaN where there is none."""


def overlaps(fitter: Fitter, pose: Pose, masks: Sequence[NDArray[np.uint8] | None]) -> Array:
    """Return intersection over union of model and silhouettes, (n_cameras,)."""
    out = np.full(len(masks), np.nan)
    points = fitter.body.skinned(posed(fitter.body.chain, pose))
    for i, (eye, mask) in enumerate(zip(fitter.eyes, masks, strict=True)):
        if mask is not None:
            model, person = eye.canvas.draw(points).limbs != NOWHERE, mask > 127
            union = float((model | person).sum())
            out[i] = (model & person).sum() / union if union else np.nan
    return out


def find_start(
    fitter: Fitter,
    surface: Surface,
    model: Callable[[Surface], Body],
    masks: Sequence[NDArray[np.uint8] | None],
    *,
    position: Array | None = None,
    heading: Array | None = None,
    arms: str = "standing",
    fit: bool = True,
) -> Start:
    """Find a person who stands or lies, by silhouettes of one instant.

    Many coarse starts (headings × sizes × legs) are held against small silhouettes; the best few
    are searched in the large, legs first, then arms wherever they can be, then all joints. The
    last two have their proportions fitted, and the one that explains more wins.

    Parameters
    ----------
    fitter
        Of a body with legs, its evidence being masks.
    masks
        (height, width) 0 to 255 in the views' sizes.
    position, heading
        About where the pelvis is and where the person looks, in the world, if known.
    fit
        Whether the proportions may change.

    Raises
    ------
    BadScene
        If the silhouettes are too few or contradict each other.
    """
    views = [eye.canvas.view for eye in fitter.eyes]
    hull = visual_hull(views, masks)
    for eye, mask in zip(fitter.eyes, masks, strict=True):
        eye.evidence.look(mask)
    sketch = sketch_of(fitter.body, views, masks)
    coarse: list[_Tried] = []
    for stance in stances_of(hull, fitter.body, position, heading, sizes=fit):
        logs = np.zeros(len(FACTORS))
        logs[0] = stance.log_size
        sized = sketch.with_body(model(shaped(surface, logs)))
        coarse += _coarse_starts(sized, stance, logs, arms)
    with_legs = [_searched(one, _with_legs) for one in _unlike(_best(coarse), _COARSE)]
    whole = [_searched(one, _with_arms) for one in _best(with_legs)[:_WHOLE]]
    last = [_closely(fitter, surface, model, masks, one, fit=fit) for one in _best(whole)[:_LAST]]
    if heading is None:  # from behind, a person looks much the same
        other = replace(_best(last)[0], pose=turned_about(fitter.body.chain, _best(last)[0].pose))
        other = _searched(other, _with_legs)
        last.append(_closely(fitter, surface, model, masks, _searched(other, _with_arms), fit=fit))
    best = _best(last)[0]
    whole_body = with_body(fitter, model(shaped(surface, best.logs)))
    return Start(best.pose, best.logs, overlaps(whole_body, best.pose, masks))


def _best(tried: Iterable[_Tried]) -> list[_Tried]:
    return sorted(tried, key=lambda one: -one.worth)


def _unlike(tried: Sequence[_Tried], n: int) -> list[_Tried]:
    """Return the best few of sorted candidates: of each heading the best, then the rest."""
    first: list[int] = []
    for i, one in enumerate(tried):
        ahead = one.pose.balls[0][:, 0]
        if all(ahead @ tried[j].pose.balls[0][:, 0] < _APART for j in first):
            first.append(i)
    rest_of = [i for i in range(len(tried)) if i not in first]
    # one in three places is kept for second bests: of one heading, the other size or legs
    spare = n // 3
    chosen = first[: n - spare] + rest_of[:spare]
    return [tried[i] for i in sorted((chosen + first[n - spare :] + rest_of[spare:])[:n])]


def _coarse_starts(sketch: Sketch, stance: Stance, logs: Array, arms: str) -> list[_Tried]:
    """Return, for each heading, the two leg phases that explain most."""
    chain = sketch.body.chain
    upright = standing(chain, arms)
    legs = [upright]
    for left, right in ((1, 2), (2, 1), (3, 0), (0, 3)):
        pose = list(leg_poses(chain, upright, "left"))[left]
        legs.append(list(leg_poses(chain, pose, "right"))[right])
    starts: list[_Tried] = []
    for looks in stance.headings:
        turned = [facing(pose, stance.place, looks, stance.up) for pose in legs]
        tried = [_Tried(sketch.worth(pose), pose, logs, sketch) for pose in turned]
        starts += _best(tried)[:2]
    return starts


def _searched(one: _Tried, search: Callable[[Sketch, Pose], Pose]) -> _Tried:
    pose = search(one.sketch, one.pose)
    return replace(one, pose=pose, worth=one.sketch.worth(pose))


def _with_legs(sketch: Sketch, pose: Pose) -> Pose:
    pose = with_arms_found(sketch, pose, roughly=True)
    return shaken(sketch, pose, _LARGE, _TRIES, _LOWER)


def _with_arms(sketch: Sketch, pose: Pose) -> Pose:
    return shaken(sketch, with_arms_found(sketch, pose), _SMALL, _TRIES)


def _closely(
    fitter: Fitter,
    surface: Surface,
    model: Callable[[Surface], Body],
    masks: Sequence[NDArray[np.uint8] | None],
    one: _Tried,
    *,
    fit: bool,
) -> _Tried:
    """Return a candidate fitted at full size, and with its proportions if they may change."""
    logs, sketch = one.logs, one.sketch
    body = model(shaped(surface, logs))
    pose = _refined(fitter, body, one.pose)
    for schedule in _SHAPE if fit else ():
        instant = Instant(tuple(masks), pose)
        logs, poses = fit_shape(
            fitter, surface, model, logs, [instant], schedule=schedule, tight=_TIGHT
        )
        body = model(shaped(surface, logs))
        sketch = sketch.with_body(body)
        pose = _refined(fitter, body, shaken(sketch, poses[0], _SMALL, _TRIES))
    # where the rest is right to a pixel, arms stand out: once more, wherever they can be
    pose = _refined(fitter, body, _with_arms(sketch, pose))
    return _Tried(sketch.worth(pose), pose, logs, sketch)


def _refined(fitter: Fitter, body: Body, pose: Pose) -> Pose:
    """Return the pose fitted to the rims, unless it explains less then."""
    sized = with_body(fitter, body)
    found = sized.fit(pose, (rest(sized.body.chain, sized.settings, pose),), _FINER)
    before, after = (float(sized.score(p)[0].sum()) for p in (pose, found))
    return found if after >= before else pose
