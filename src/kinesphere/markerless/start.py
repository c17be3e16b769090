"""The first pose, from silhouettes alone: where, how large, which way, arms and legs."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.data.surface import Surface
from kinesphere.markerless.body import Body
from kinesphere.markerless.eyes import with_body
from kinesphere.markerless.fit import Fitter
from kinesphere.markerless.hull import visual_hull
from kinesphere.markerless.hypotheses import arm_poses, facing, leg_poses, standing
from kinesphere.markerless.kernels.contour import NOWHERE
from kinesphere.markerless.pose import Pose, posed
from kinesphere.markerless.prediction import rest
from kinesphere.markerless.recovery import recovered
from kinesphere.markerless.shape import FACTORS, shaped
from kinesphere.markerless.shape_fit import Instant, fit_shape
from kinesphere.markerless.stance import Stance, stances_of

_KEPT = 5
"""Coarse starts that are fitted closely."""
_APART = 0.7
"""Cosine between two headings above which they count as one."""
_SHAPE = (((8, 2), (4, 3)), ((4, 2), (2, 3), (1, 3)))
_COARSE = ((8, 6), (4, 3))
_FINER = ((8, 3), (4, 4), (2, 3))


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
    """Find a person who is about upright, by silhouettes of one instant.

    Many coarse starts (headings × sizes × legs) are fitted and the best few kept; of these the
    arms are tried in many places; the best has its proportions fitted.

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
    stances = stances_of(hull, fitter.body, position, heading, sizes=fit)
    tried: list[tuple[float, Pose, Array]] = []
    for stance in stances:
        logs = np.zeros(len(FACTORS))
        logs[0] = stance.log_size
        sized = with_body(fitter, model(shaped(surface, logs)))
        upright = standing(sized.body.chain, arms)
        for pose in _coarse_starts(sized, upright, stance):
            found = sized.fit(pose, (rest(sized.body.chain, sized.settings, pose),), _COARSE)
            tried.append((_mean(overlaps(sized, found, masks)), found, logs))
    tried.sort(key=lambda one: -one[0])
    finer = []
    for _, pose, logs in _unlike(tried, _KEPT):
        sized = with_body(fitter, model(shaped(surface, logs)))
        pose = with_best_arms(sized, pose)
        pose = sized.fit(pose, (rest(sized.body.chain, sized.settings, pose),), _FINER)
        better = recovered(sized, pose, ["left arm", "right arm"])
        pose = pose if better is None else better
        finer.append((_mean(overlaps(sized, pose, masks)), pose, logs))
    finer.sort(key=lambda one: -one[0])
    best = _with_shape(fitter, surface, model, masks, finer[:2]) if fit else finer[0]
    _, pose, logs = best
    sized = with_body(fitter, model(shaped(surface, logs)))
    return Start(pose, logs, overlaps(sized, pose, masks))


def _unlike(tried: Sequence[tuple[float, Pose, Array]], n: int) -> list[tuple[float, Pose, Array]]:
    """Return the best few of sorted candidates: of each heading the best, then the rest."""
    first: list[int] = []
    for i, (_, pose, _) in enumerate(tried):
        ahead = pose.balls[0][:, 0]
        if all(ahead @ tried[j][1].balls[0][:, 0] < _APART for j in first):
            first.append(i)
    rest_of = [i for i in range(len(tried)) if i not in first]
    # one in three places is kept for second bests: of one heading, the other size or legs
    spare = n // 3
    chosen = first[: n - spare] + rest_of[:spare]
    return [tried[i] for i in sorted((chosen + first[n - spare :] + rest_of[spare:])[:n])]


def with_best_arms(fitter: Fitter, pose: Pose) -> Pose:
    """Return the pose with each arm where it explains most, one after the other."""
    for side in ("left", "right", "left"):
        if f"{side}_upper_arm" in fitter.body.chain.limb_names:
            choices = [pose, *arm_poses(fitter.body.chain, pose, side)]
            pose = max(choices, key=lambda p: float(fitter.score(p)[0].sum()))
    return pose


def _coarse_starts(fitter: Fitter, upright: Pose, stance: Stance) -> list[Pose]:
    """Return, for each heading, the leg phase that explains most."""
    chain = fitter.body.chain
    legs = [upright]
    if "left_shank" in chain.limb_names:
        for left, right in ((1, 2), (2, 1), (3, 0), (0, 3)):
            pose = list(leg_poses(chain, upright, "left"))[left]
            legs.append(list(leg_poses(chain, pose, "right"))[right])
    starts = []
    for looks in stance.headings:
        turned = [facing(pose, stance.place, looks, stance.up) for pose in legs]
        starts.append(max(turned, key=lambda p: float(fitter.score(p)[0].sum())))
    return starts


def _with_shape(
    fitter: Fitter,
    surface: Surface,
    model: Callable[[Surface], Body],
    masks: Sequence[NDArray[np.uint8] | None],
    candidates: Sequence[tuple[float, Pose, Array]],
) -> tuple[float, Pose, Array]:
    """Return the best candidate after its proportions have been fitted to the one instant."""
    pictures = tuple(masks)
    done = []
    for _, start, start_logs in candidates:
        pose, logs = start, start_logs
        for schedule in _SHAPE:
            logs, poses = fit_shape(
                fitter,
                surface,
                model,
                logs,
                [Instant(pictures, pose)],
                schedule=schedule,
                tight=3.0,
            )
            pose = poses[0]
            sized = with_body(fitter, model(shaped(surface, logs)))
            for eye, picture in zip(sized.eyes, pictures, strict=True):
                eye.evidence.look(picture)
            pose = sized.fit(pose, (rest(sized.body.chain, sized.settings, pose),), _FINER)
            better = recovered(sized, pose, ["left arm", "right arm"], refined=5)
            pose = pose if better is None else better
        done.append((_mean(overlaps(sized, pose, masks)), pose, logs))
    return max(done, key=lambda one: one[0])


def _mean(values: Array) -> float:
    return float(np.nanmean(values)) if np.isfinite(values).any() else 0.0
