"""What normalization tells of itself: findings for the history, warnings for a person."""

import numpy as np

from kinesphere.data import Json
from kinesphere.normalization.alignment import Alignment
from kinesphere.normalization.anatomy import without_side
from kinesphere.normalization.default_frames import DefaultFrames
from kinesphere.normalization.facing import Verdict
from kinesphere.normalization.samples import Samples

_WIDE = np.deg2rad(10.0)  # spread of the body frames from which their mean is in doubt

MIRRORED, BY_ONE, ASIDE = 10, 20, 20
"""deg by which a foot may be off that is the other's mirror image, by a single marker of it, and
whose markers are at its outer edge: 0.7 to 9.1° (4 of 80: 10 to 19°), 0.9 to 25° and 6 to 19° where
markers of a real foot were left out."""

_CROOKED = np.deg2rad(45.0)
"""rad, from where a limb points in the ideal default position, from which on that is said."""
ARM = ("upper_arm", "forearm", "hand")


def warnings_of(
    samples: Samples, default: DefaultFrames, alignment: Alignment, template: str
) -> tuple[str, ...]:
    """Return what was doubtful, each a sentence for a person."""
    said = list(default.warnings)
    if default.doubts:
        frame = samples.motion.first_frame + int(samples.frames[default.best])
        said.append(
            f"no frame shows a good default position; the best, frame {frame}, was used although "
            + "; ".join(default.doubts)
        )
    elif crooked := _crooked(alignment, template):
        said.append(
            "the body stands in the default position, but some limbs do not hang as they would; "
            "turned into place by the shortest way, their twist may be off: " + ", ".join(crooked)
        )
    widest = float(default.spread.max())
    if widest > _WIDE:
        said.append(
            f"body frames of the default position differ by up to {np.rad2deg(widest):.0f} deg; "
            "the pelvis and the shoulders may turn against each other, or joints be off"
        )
    if alignment.elsewhere:
        said.append(
            f"the default position does not fully show {', '.join(alignment.elsewhere)}; aligned "
            "with the limb before it, in the frames that show both"
        )
    said += _feet(alignment)
    if alignment.never:
        said.append(f"{', '.join(alignment.never)} could not be aligned and keeps its frame")
    return tuple(said)


def _feet(alignment: Alignment) -> list[str]:
    """Return what the frames of feet rest on that lack a heel, or markers of the other foot."""
    levelled: list[str] = []
    lines: list[str] = []
    heels: list[str] = []
    aside: list[str] = []
    said: list[str] = []
    for name, foot in alignment.feet.items():
        on = f"{name} ({', '.join(foot.on)})"
        if foot.lender:
            said.append(
                f"{name} has no marker like {', '.join(foot.missing)} of {foot.lender}: its long "
                f"axis is that foot's, mirrored onto {', '.join(foot.on)}, and may be "
                f"{MIRRORED if len(foot.on) > 1 else BY_ONE} deg off"
            )
        elif foot.backward:
            heels.append(on)
        elif foot.aside:
            aside.append(on)
        elif foot.bare:
            (lines if foot.pitch is None else levelled).append(on)
    if heels:
        said.append(
            "the long axis of a foot is told by markers at its heel alone; it is level, from them "
            f"past the ankle, and may be 30 deg off: {', '.join(heels)}"
        )
    if aside:
        said.append(
            "the long axis of a foot runs to markers at its outer edge, none is at the toes; its "
            f"frame may be {ASIDE} deg off, turned out: {', '.join(aside)}"
        )
    ahead = "the long axis of a foot is told by markers ahead of its ankle alone, none is at the "
    if levelled:
        said.append(
            f"{ahead}heel; its pitch is from where it rests flat on the floor, and the ankle's "
            f"angles may be 10 deg off: {', '.join(levelled)}"
        )
    if lines:
        said.append(
            f"{ahead}heel; its frame and the ankle's angles may be 20 deg off: {', '.join(lines)}"
        )
    return said


def _crooked(alignment: Alignment, template: str) -> list[str]:
    """Return the limbs that point far from where the template has them, with the angle."""
    apart = ARM if template == "t-pose" else ()  # where arms point sideways, that is no fault
    return [
        f"{name} ({np.rad2deg(off):.0f} deg off)"
        for name, off in alignment.off_ideal.items()
        if off > _CROOKED and without_side(name) not in apart
    ]


def findings_of(
    samples: Samples, default: DefaultFrames, verdict: Verdict, alignment: Alignment
) -> dict[str, Json]:
    """Return what was found and how good it is."""
    first, times = samples.motion.first_frame, samples.motion.times
    used = samples.frames[default.chosen]
    spread = np.rad2deg(default.spread)
    return {
        "body_frame": default.method,
        "default_frame": int(first + samples.frames[default.best]),
        "default_time_s": float(times[samples.frames[default.best]]),
        "good_default_position": not default.doubts,
        "cost": float(default.cost[default.best]),
        "terms": {n: v if np.isfinite(v) else None for n, v in default.terms.items()},
        "n_frames_averaged": len(used),
        "frames_averaged": [int(first + f) for f in used],
        "times_averaged_s": [float(times[used[0]]), float(times[used[-1]])],
        "spread_rms_deg": float(np.sqrt(np.mean(spread**2))),
        "spread_max_deg": float(spread.max()),
        "facing": verdict.as_json(),
        "limbs_without_twist": list(alignment.twistless),
        "feet_without_heel": [name for name, foot in alignment.feet.items() if foot.bare],
        "feet_without_toes": [name for name, foot in alignment.feet.items() if foot.aside],
        "feet_levelled_deg": {
            name: float(np.rad2deg(foot.pitch))
            for name, foot in alignment.feet.items()
            if foot.pitch is not None
        },
        "feet_by_the_other": {
            name: list(foot.missing) for name, foot in alignment.feet.items() if foot.lender
        },
        "limbs_off_ideal_deg": {n: float(np.rad2deg(a)) for n, a in alignment.off_ideal.items()},
    }
