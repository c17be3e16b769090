"""Normalization, from the search for the default position to the new frames (paper section 3)."""

from dataclasses import replace

import numpy as np

from kinesphere import __version__
from kinesphere.data import Array, Json, Mask, Motion, Step, settings_as_json
from kinesphere.errors import DegenerateMotion
from kinesphere.geometry.rotations import rotation_angle
from kinesphere.normalization.alignment import Alignment, align_limbs
from kinesphere.normalization.averaging import robust_mean_rotations
from kinesphere.normalization.body_frame import TURNED_ROUND
from kinesphere.normalization.default_position import (
    JOINTS_OF_A_PLANE,
    PositionCost,
    joint_speeds,
    paper_cost,
    posture_angles,
    posture_cost,
)
from kinesphere.normalization.doubts import doubts
from kinesphere.normalization.facing import Facing, Verdict, find_facing
from kinesphere.normalization.propagation import propagate
from kinesphere.normalization.proposal import propose_bodies
from kinesphere.normalization.samples import Samples, take_samples
from kinesphere.normalization.settings import NormalizationSettings

_DEFAULTS = NormalizationSettings()
_SHARE, _MOST_SHARED = 0.1, 1.0  # of the best cost: where nothing is good, differences count less
_STRIDE = 0.5  # of the best cost: enough to reach over a whole stride
_WIDE = np.deg2rad(10.0)  # spread of the body frames from which the average is in doubt


def normalize(
    motion: Motion,
    settings: NormalizationSettings = _DEFAULTS,
    facing: Facing | None = None,
) -> Motion:
    """Align the frame of every limb with the body (Sar Dessai et al. 2006, section 3).

    The frames in which the person stands in the default position give the body's own axes; from
    them and from where each limb points follows a frame per limb, which is carried to all frames.
    The motion itself does not change, only the coordinates that tell it: markers, joint centres
    and covariances of the skeleton move into the new frames with it.

    Parameters
    ----------
    motion
        In the world, y up, with limb frames of any orientation.
    settings
    facing
        The world direction the person faces in the default position (``"+x"``…), or the one
        witness to believe (``"feet"``); by default names of left and right decide, else a vote.

    Raises
    ------
    AmbiguousFacing
        If nothing tells front from back.
    DegenerateMotion
        If the joints do not span a body frame in any frame.
    BadSetting
        If ``facing`` is no known word.
    """
    samples = take_samples(motion, settings.sampling, settings.speed_window)
    proposal = propose_bodies(samples, settings, facing)
    position, warnings = _position(samples, settings)
    cost = np.where(np.isfinite(proposal.root_from_body).all(axis=(1, 2)), position.cost, np.inf)
    if not np.isfinite(cost).any():
        raise DegenerateMotion(
            f"no frame shows enough to place the body's axes: {proposal.needs} in one frame"
        )
    best = int(np.argmin(cost))
    chosen = np.arange(len(cost)) == best
    if settings.frames == "many" and not proposal.only_best:
        chosen = cost <= cost[best] + _margin(samples, position, cost[best], settings, best)
    in_root = proposal.root_from_body
    mean_body = robust_mean_rotations(in_root[chosen][:, None])[0]
    carried = samples.rotations[:, 0] @ mean_body
    verdict = find_facing(samples, carried, chosen, best, named=proposal.named, facing=facing)
    turn = TURNED_ROUND if verdict.turn_round else np.eye(3)
    bodies = samples.rotations[:, 0] @ in_root @ turn
    alignment = align_limbs(samples, bodies, chosen, settings.limbs)
    spread = rotation_angle(mean_body.T @ in_root[chosen])
    terms = {name: float(values[best]) for name, values in position.terms.items()}
    angles = {n: float(v[best]) for n, v in posture_angles(samples, settings.template).items()}
    reasons = doubts(terms | angles, settings, samples.anatomy.span)
    warnings += proposal.warnings + verdict.warnings
    warnings += _warnings(samples, best, reasons, spread, alignment)
    findings = _findings(samples, best, chosen, cost, terms | angles, spread, verdict, alignment)
    findings |= {"body_frame": proposal.method, "good_default_position": not reasons}
    return _normalized(samples, alignment, settings, findings, warnings)


def _margin(
    samples: Samples,
    position: PositionCost,
    cost: float,
    settings: NormalizationSettings,
    best: int,
) -> float:
    """Return the cost above the best up to which frames are averaged in.

    Where nothing is good, differences count less. Somebody who never stands still is averaged over
    whole strides: in each half of one, pelvis and shoulders turn the opposite way.
    """
    moves = joint_speeds(samples)[best] > settings.speed * samples.anatomy.span
    if moves and position.absolute:
        return _STRIDE * cost
    return position.margin + min(_SHARE * abs(cost), _MOST_SHARED)


def _position(
    samples: Samples, settings: NormalizationSettings
) -> tuple[PositionCost, tuple[str, ...]]:
    if samples.joints.shape[1] < JOINTS_OF_A_PLANE:
        return posture_cost(samples, settings), ()  # whatever is left of it: speed if nothing else
    if settings.position == "paper":
        return paper_cost(samples, settings), ()
    if posture_angles(samples, settings.template):
        return posture_cost(samples, settings), ()
    return paper_cost(samples, settings), (
        "no limb has a name that a posture could be read from; the default position was sought by "
        "the paper's cost, which takes stretched poses of any kind",
    )


def _normalized(
    samples: Samples,
    alignment: Alignment,
    settings: NormalizationSettings,
    findings: dict[str, Json],
    warnings: tuple[str, ...],
) -> Motion:
    anatomy, motion = samples.anatomy, samples.motion
    shifts = np.array([anatomy.mid_point(i) for i in range(len(anatomy.skeleton.limbs))])
    shifts[[anatomy.limbs[name] for name in alignment.never]] = 0.0
    shifts = np.nan_to_num(shifts)
    lengths = np.linalg.norm(anatomy.distal_ends - anatomy.proximal_ends, axis=1)
    step = Step(
        name="normalization",
        settings=settings_as_json(settings),
        findings=findings,
        warnings=warnings,
        version=__version__,
    )
    moved = propagate(motion, alignment.turns, shifts, alignment.along, lengths)
    return replace(moved, history=(*motion.history, step))


def _warnings(
    samples: Samples,
    best: int,
    reasons: tuple[str, ...],
    spread: Array,
    alignment: Alignment,
) -> tuple[str, ...]:
    said = []
    if reasons:
        frame = samples.motion.first_frame + int(samples.frames[best])
        said.append(
            f"no frame shows a good default position; the best, frame {frame}, was used although "
            + "; ".join(reasons)
        )
    if spread.max() > _WIDE:
        said.append(
            f"body frames of the default position differ by up to {np.rad2deg(spread.max()):.0f} "
            "deg; the pelvis and the shoulders may turn against each other, or joints be off"
        )
    if alignment.elsewhere:
        said.append(
            f"the default position does not fully show {', '.join(alignment.elsewhere)}; aligned "
            "with the limb before it, in the frames that show both"
        )
    if alignment.never:
        said.append(f"{', '.join(alignment.never)} could not be aligned and keeps its frame")
    return tuple(said)


def _findings(
    samples: Samples,
    best: int,
    chosen: Mask,
    cost: Array,
    terms: dict[str, float],
    spread: Array,
    verdict: Verdict,
    alignment: Alignment,
) -> dict[str, Json]:
    first, times = samples.motion.first_frame, samples.motion.times
    used = samples.frames[chosen]
    return {
        "default_frame": int(first + samples.frames[best]),
        "default_time_s": float(times[samples.frames[best]]),
        "cost": float(cost[best]),
        "terms": {name: _json(value) for name, value in terms.items()},
        "n_frames_averaged": len(used),
        "frames_averaged": [int(first + f) for f in used],
        "times_averaged_s": [float(times[used[0]]), float(times[used[-1]])],
        "spread_rms_deg": float(np.rad2deg(np.sqrt(np.mean(spread**2)))),
        "spread_max_deg": float(np.rad2deg(spread.max())),
        "facing": verdict.as_json(),
        "limbs_without_twist": list(alignment.twistless),
        "limbs_off_ideal_deg": {n: float(np.rad2deg(a)) for n, a in alignment.off_ideal.items()},
    }


def _json(value: float) -> float | None:
    return value if np.isfinite(value) else None
