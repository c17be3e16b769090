"""Limbs that were lost: when to look for them anew, and where."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from kinesphere.data import Array, Mask
from kinesphere.markerless.chain import Chain
from kinesphere.markerless.fit import Fitter
from kinesphere.markerless.hypotheses import arm_poses, leg_poses
from kinesphere.markerless.pose import Pose, limited, moved
from kinesphere.markerless.prediction import expectation, rest
from kinesphere.markerless.settings import TrackSettings

LIMBS = {"arm": ("upper_arm", "forearm", "hand"), "leg": ("thigh", "shank", "foot")}
_PATIENCE = 3
"""Frames a limb must be held lost before it is looked for: one bad frame mends itself."""
_PAUSE = 15
"""Frames between two searches for the same limb."""
_MARGIN = 1.02
"""How much more another pose must explain to be taken."""
_REFINED = 4
"""Hypotheses that are fitted."""
_CLIMB = (0.5, 0.25)
"""rad by which each joint of a hypothesis is tried to either side before it is fitted."""


@dataclass(eq=False)
class Watch:
    """How long each arm and leg has been lost, and when it was looked for last."""

    lost_for: dict[str, int] = field(default_factory=dict)
    pause: dict[str, int] = field(default_factory=dict)

    def due(self, chain: Chain, lost: Mask) -> list[str]:
        """Return the arms and legs to look for now, as ``left arm``."""
        due = []
        names = chain.limb_names
        for side in ("left", "right"):
            for which, limbs in LIMBS.items():
                name = f"{side} {which}"
                own = [names.index(f"{side}_{b}") for b in limbs if f"{side}_{b}" in names]
                gone = bool(lost[own].any())
                self.lost_for[name] = self.lost_for.get(name, 0) + 1 if gone else 0
                self.pause[name] = max(0, self.pause.get(name, 0) - 1)
                if self.lost_for[name] >= _PATIENCE and self.pause[name] == 0:
                    self.pause[name] = _PAUSE
                    due.append(name)
        return due


def recovered(fitter: Fitter, pose: Pose, names: list[str], refined: int = _REFINED) -> Pose | None:
    """Return a pose that explains clearly more, with arms or legs elsewhere; None if there is none.

    Every hypothesis is drawn and scored; the best ``refined`` have their joints tried one by one,
    are fitted and scored again; of a pose before and after its fit the better one counts.
    """
    best, best_score = pose, float(fitter.score(pose)[0].sum())
    needed = best_score + (_MARGIN - 1) * abs(best_score)
    chain, settings = fitter.body.chain, fitter.settings
    for name in names:
        tried = sorted(
            _hypotheses(chain, best, name), key=lambda p: -float(fitter.score(p)[0].sum())
        )
        for start in tried[:refined]:
            near = _climbed(fitter, start, name)
            priors = (expectation(chain, near, settings, widen=3.0), rest(chain, settings, near))
            # a fit may slide off what was met: the better of the two counts
            for found in (fitter.fit(near, priors), near):
                score = float(fitter.score(found)[0].sum())
                if score > max(needed, best_score):
                    best, best_score = found, score
    return None if best is pose else best


def _hypotheses(chain: Chain, pose: Pose, name: str) -> Iterator[Pose]:
    side, which = name.split()
    if which == "arm":
        yield from arm_poses(chain, pose, side)
    elif f"{side}_thigh" in chain.limb_names:
        yield from leg_poses(chain, pose, side)


def _climbed(fitter: Fitter, pose: Pose, name: str) -> Pose:
    """Return the pose after a search along one joint of the arm or leg after the other."""
    chain = fitter.body.chain
    side, which = name.split()
    limbs = [f"{side}_{limb}" for limb in LIMBS[which][:2]]
    dofs = [k for k, i in enumerate(chain.dof_limbs) if chain.limb_names[i] in limbs]
    score = float(fitter.score(pose)[0].sum())
    for size in _CLIMB:
        for dof in dofs:
            for way in (size, -size):
                step = np.zeros(chain.n_dofs)
                step[dof] = way
                tried = limited(chain, moved(chain, pose, step))
                other = float(fitter.score(tried)[0].sum())
                if other > score:
                    pose, score = tried, other
                    break
    return pose


def carried(chain: Chain, sums: Array) -> Array:
    """Return sums over what was seen of each limb, (n_limbs,), a hand's with its forearm's.

    A hand is where its forearm ends, whatever the wrist does, so it is lost where both are. By
    itself it is too small to tell: in 8 to 17 % of the frames of real footage a fist where the
    model spreads its fingers, or a hand blurred by its motion, was held lost. Arms put wrong are
    noticed nearly as surely.
    """
    out = sums.copy()
    names = chain.limb_names
    for side in ("left", "right"):
        hand, forearm = f"{side}_hand", f"{side}_forearm"
        if hand in names and forearm in names:
            out[names.index(hand)] += sums[names.index(forearm)]
    return out


def held_lost(support: Array, gain: Array, settings: TrackSettings) -> Mask:
    """Return which limbs are held lost, (n_limbs,): too little speaks for where they are put.

    Both must fall short, the rim and what it encloses: a limb before another one of the same
    colours has a poor rim, one in clutter of its own colours a poor gain. A limb whose rim nobody
    sees is judged by its gain alone; one that is not seen at all is not held lost.

    Parameters
    ----------
    support, gain : (n_limbs,)
        As in `Found`.
    """
    rim = np.nan_to_num(support, nan=0.0) < settings.least_support
    with np.errstate(invalid="ignore"):
        return np.asarray(rim & (gain < settings.least_gain))
