"""The frames that show the default position, and the body's axes as they agree on them."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array, Mask
from kinesphere.errors import DegenerateMotion
from kinesphere.geometry.rotations import rotation_angle
from kinesphere.normalization.averaging import robust_mean_rotations
from kinesphere.normalization.default_position import (
    JOINTS_OF_A_PLANE,
    PositionCost,
    paper_cost,
    posture_angles,
    posture_cost,
)
from kinesphere.normalization.doubts import doubts
from kinesphere.normalization.proposal import Proposal
from kinesphere.normalization.samples import Samples
from kinesphere.normalization.settings import NormalizationSettings

_SHARE, _MOST_SHARED = 0.1, 1.0  # of the best cost: where nothing is good, differences count less
_STRIDE = 0.5  # of the best cost: enough to reach over a whole stride
_ROUNDING = 1e-9  # of the cost: less is no difference
_ALIKE, _LEAST = 0.5, 1.0  # share of a stride's frames that serve in the end, if they last so long


@dataclass(frozen=True, eq=False)
class DefaultFrames:
    """Which samples show the default position best, and how well."""

    method: str
    """How the body frame was found."""
    best: int
    """The sample of least cost."""
    chosen: Mask
    """(n,) samples that are averaged."""
    cost: Array
    """(n,) infinite where the body's axes cannot be told."""
    terms: dict[str, float]
    """Name with unit → what the best sample measures."""
    root_from_body: Array
    """(3, 3) mean over the chosen samples, in the root limb's old frame."""
    spread: Array
    """(n_chosen,) rad between the body frame of each and their mean."""
    doubts: tuple[str, ...]
    """Why the best is no good default position."""
    warnings: tuple[str, ...]


def find_default_frames(
    samples: Samples, proposal: Proposal, settings: NormalizationSettings
) -> DefaultFrames:
    """Find the samples that show the default position, many or the best alone.

    Raises
    ------
    DegenerateMotion
        If no sample shows the body's axes.
    """
    angles = posture_angles(samples, settings.template)
    position, warnings = _position(samples, angles, settings)
    bodies = proposal.root_from_body
    cost = np.where(np.isfinite(bodies).all(axis=(1, 2)), position.cost, np.inf)
    if not np.isfinite(cost).any():
        raise DegenerateMotion(
            f"no frame shows enough to place the body's axes: {proposal.needs} in one frame"
        )
    best = _least(cost, samples.speeds)
    chosen = np.arange(len(cost)) == best
    if settings.frames == "many" and not proposal.only_best:
        chosen = cost <= cost[best] + _margin(samples, position, best, cost[best], settings)
    mean = robust_mean_rotations(bodies[chosen][:, None])[0]
    if _strides(samples, position, best, settings) and chosen.sum() >= _LEAST * samples.rate:
        # in the mean of strides pelvis and shoulders face alike: so they do in the nearest half
        apart = np.where(chosen, rotation_angle(mean.T @ bodies), np.inf)
        chosen = apart <= np.quantile(apart[chosen], _ALIKE)
        mean = robust_mean_rotations(bodies[chosen][:, None])[0]
    measured = position.terms | angles
    terms = {name: float(values[best]) for name, values in measured.items()}
    return DefaultFrames(
        method=proposal.method,
        best=best,
        chosen=chosen,
        cost=cost,
        terms=terms,
        root_from_body=mean,
        spread=rotation_angle(mean.T @ bodies[chosen]),
        doubts=doubts(terms, settings, samples.anatomy.span),
        warnings=warnings + proposal.warnings,
    )


def _least(cost: Array, speeds: Array) -> int:
    """Return the sample of least cost; where rounding alone parts several, the slowest of them.

    Terms have a ceiling and are averaged over a window, so that a stretch may cost the same
    throughout: sums in another order, of other markers first, must not choose in it.
    """
    least = float(np.min(cost))
    alike = cost <= least + _ROUNDING * max(abs(least), 1.0)
    return int(np.argmin(np.where(alike, speeds, np.inf)))


def _margin(
    samples: Samples,
    position: PositionCost,
    best: int,
    cost: float,
    settings: NormalizationSettings,
) -> float:
    """Return the cost above the best up to which frames are averaged in.

    Where nothing is good, differences count less. Somebody who never stands still is averaged over
    whole strides: in each half of one, pelvis and shoulders turn the opposite way.
    """
    if _strides(samples, position, best, settings):
        return _STRIDE * cost
    return position.margin + min(_SHARE * abs(cost), _MOST_SHARED)


def _strides(
    samples: Samples, position: PositionCost, best: int, settings: NormalizationSettings
) -> bool:
    """Return whether even the best sample is one of somebody on the move."""
    moves = samples.speeds[best] > settings.speed * samples.anatomy.span
    return bool(moves and position.absolute)


def _position(
    samples: Samples, angles: dict[str, Array], settings: NormalizationSettings
) -> tuple[PositionCost, tuple[str, ...]]:
    if samples.joints.shape[1] < JOINTS_OF_A_PLANE:
        # whatever is left of it: speed if nothing else
        return posture_cost(samples, settings, angles), ()
    if settings.position == "paper":
        return paper_cost(samples, settings), ()
    if angles:
        return posture_cost(samples, settings, angles), ()
    return paper_cost(samples, settings), (
        "no limb has a name that a posture could be read from; the default position was sought by "
        "the paper's cost, which takes stretched poses of any kind",
    )
