"""What a person is told about the parameterization of all joints: few sentences, not many."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from kinesphere.data import Array, Codes, JointFlag, Json
from kinesphere.parameterization.anatomy import room
from kinesphere.parameterization.joined import doubted as doubted_of
from kinesphere.parameterization.joint_fit import JointFit, said_of
from kinesphere.parameterization.measures import number
from kinesphere.parameterization.view import JointView

INSTEAD = "the body frame's serve instead"
ADVICE = (
    " (to have them measured, move each of these joints about one axis at a time, twice and by 20° "
    "or more, or name such a recording with --calibration-from)"
)


class Told(NamedTuple):
    """What the movement of one joint tells, once its frames may be forgotten."""

    threshold: float
    """rad/s, between movement and rest."""
    valley: bool
    """Whether the speeds have a valley to put it in."""
    moves: bool
    """Whether there is any movement phase."""
    slow: bool
    """Whether hardly anything passes the usual limit, and the threshold is one of noise."""
    twist: bool
    """Whether any frame tells the twist; True too where none is seen."""


def told(view: JointView) -> Told:
    """Return what a joint's view tells, without its arrays."""
    seen = np.isfinite(view.rotations[:, 0, 0])
    return Told(
        threshold=view.movement.threshold,
        valley=view.movement.valley,
        moves=bool(view.samples.phases),
        slow=view.movement.slow,
        twist=bool(view.twist_known[seen].any() or not seen.any()),
    )


def stage_warnings(
    seen: Mapping[str, Told], fits: Mapping[str, JointFit], method: str, *, reuse: bool = False
) -> tuple[str, ...]:
    """Return what was guessed or is doubtful, joints of one complaint in one sentence.

    Parameters
    ----------
    seen, fits
        By joint name.
    method
        The axis method asked for; body axes that were asked for are no complaint.
    reuse
        Whether another recording was named to take axes from: who did so needs no advice to.
    """
    warnings: list[str] = []
    if method != "body":
        for source, sentence in (
            (
                "body",
                f"the main movements do not tell these axes, {INSTEAD}{'' if reuse else ADVICE}",
            ),
            ("movement", "these axes are doubtful, kept because that was asked for"),
        ):
            doubted = [
                f"{name} ({'; '.join(fit.doubts)})"
                for name, fit in fits.items()
                if fit.source == source and fit.doubts and not fit.kept and not fit.half_told
            ]
            if doubted:
                warnings.append(f"{sentence}: {', '.join(doubted)}")
        halved = [
            f"{name} ({said_of(fit)})"
            for name, fit in fits.items()
            if fit.source == "movement" and fit.half_told
        ]
        if halved:
            warnings.append(
                "the main movements tell only one of two axes; the other was put across it, "
                f"nearest the body frame's: {', '.join(halved)}"
            )
        kept = [
            f"{name} ({'; '.join((fit.kept, *fit.doubts))})"
            for name, fit in fits.items()
            if fit.kept
        ]
        if kept:
            warnings.append(
                "no main movement tells these axes, but all movement together foretells where the "
                f"limb goes clearly better than the body frame's axis: {', '.join(kept)}"
            )
        warnings += _loose_warnings(fits)
    added = [f"{name} ({fit.added})" for name, fit in fits.items() if fit.added]
    if added:
        warnings.append(
            "one axis leaves the limb so far off that a second, across it, was added to rebuild "
            f"its poses: {', '.join(added)}"
        )
    doubted = [
        f"{name} ({said})"
        for name, fit in fits.items()
        if fit.source == "reused" and (said := _said_of_reused(fit))
    ]
    if doubted:
        warnings.append(f"reused axes are doubtful where they come from: {', '.join(doubted)}")
    missing = [f"{name} ({fit.misfit})" for name, fit in fits.items() if fit.misfit]
    if missing:
        warnings.append(
            "reused axes do not fit this recording, so these limbs are not rebuilt where they were "
            f"seen: {', '.join(missing)}"
        )
    given_way = [f"{name} ({fit.gave_way})" for name, fit in fits.items() if fit.gave_way]
    if given_way:
        warnings.append(
            "axes to be reused that are doubtful or do not fit this recording give way to its own: "
            f"{', '.join(given_way)}"
        )
    no_valley = [
        name
        for name, joint in seen.items()
        if joint.moves and not (joint.valley or joint.slow) and fits[name].source == "movement"
    ]
    if no_valley:
        threshold = np.rad2deg(seen[no_valley[0]].threshold)
        warnings.append(
            f"nothing parts movement from rest at {', '.join(no_valley)}: "
            f"{threshold:.1f} deg/s was taken as the limit"
        )
    slow = [
        f"{name} ({np.rad2deg(joint.threshold):.1f} deg/s)"
        for name, joint in seen.items()
        if joint.moves and joint.slow and fits[name].source != "reused"
    ]
    if slow:
        warnings.append(
            "movement so slow that the limit between it and rest came down to three times the "
            f"speed of noise: {', '.join(slow)}"
        )
    one_only = [
        name
        for name, fit in fits.items()
        if fit.source == "movement"
        and not fit.assumed
        and len(fit.axes) == 2
        and fit.findings.get("n_axes_by_data") == 1
    ]
    if one_only:
        warnings.append(f"two axes were asked for, one is seen to move, at {', '.join(one_only)}")
    three = [
        f"{name} ({fit.n_told} from movement)"
        for name, fit in fits.items()
        if fit.source == "movement" and len(fit.axes) == 3 and any(fit.assumed[:1])
    ]
    if three:
        warnings.append(
            "three axes were asked for, less is seen to move; what was measured stays, the limb's "
            f"own line and axes across were put beside it: {', '.join(three)}"
        )
    untwisted = [name for name, joint in seen.items() if not joint.twist]
    if untwisted:
        warnings.append(f"nothing tells the twist at {', '.join(untwisted)}")
    return tuple(warnings)


def _said_of_reused(fit: JointFit) -> str:
    """Return what is doubted of the axes that another recording told; the others are from here."""
    reused = [k for k, source in enumerate(fit.sources) if source == "reused"]
    if len(reused) == len(fit.axes) and not fit.half_told:
        return "; ".join(fit.doubts)
    return "; ".join(f"axis {k + 1}: {doubt}" for k in reused for doubt in doubted_of(fit, k))


def _loose_warnings(fits: Mapping[str, JointFit]) -> list[str]:
    """Return which axes are kept although halves contradict them, and why where that is known."""
    sentence = (
        "halves of their movement put these axes more than 10° apart, or they are uncertain by more"
    )
    farther_off = "; they are kept, for the body frame's are usually farther off at such joints"
    warnings = []
    for roomy, clause in ((False, ""), (True, farther_off)):
        loose = [
            f"{name} ({fit.loose})"
            for name, fit in fits.items()
            if fit.loose and (room(name) > 1) == roomy
        ]
        if loose:
            warnings.append(f"{sentence}{clause}: {', '.join(loose)}")
    return warnings


def result_findings(residuals: Array, twists: Array, flags: Codes) -> dict[str, Json]:
    """Return residuals, twist and flagged shares of one joint, arrays (n_frames,), m and rad."""
    seen = (flags & JointFlag.UNSEEN) == 0

    def share(flag: JointFlag) -> float | None:
        return float(((flags[seen] & flag) > 0).mean()) if seen.any() else None

    return {
        "seen": float(seen.mean()) if len(seen) else None,
        "residual_mean_mm": number(residuals * 1e3, np.mean),
        "residual_median_mm": number(residuals * 1e3, np.median),
        "residual_95_mm": number(residuals * 1e3, lambda v: float(np.percentile(v, 95))),
        "twist_rms_deg": number(np.rad2deg(twists) ** 2, lambda v: float(np.sqrt(v.mean()))),
        "unreachable": share(JointFlag.UNREACHABLE),
        "singular": share(JointFlag.SINGULAR),
    }
