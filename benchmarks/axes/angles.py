"""Section 3: angles and twist, once axes are there (the paper's sections 4.4 and 4.5)."""

import time
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.axes import prototype
from benchmarks.axes.bars import Bar, number
from benchmarks.axes.generator import (
    CONES,
    NOISES,
    Cones,
    Noise,
    TrueJoint,
    make_calibration,
    make_free_motion,
)
from benchmarks.axes.measures import matched, rms, wrapped
from kinesphere.data import JointFlag, Parameters, Skeleton
from kinesphere.parameterization import (
    AngleSettings,
    AxesSettings,
    ParameterizationSettings,
    TwistSettings,
    parameterize,
)
from kinesphere.synthetic import make_performance

SEEDS = 30
BRANCHES = {
    "viterbi": AngleSettings(),
    "viterbi, angles.unwrap": AngleSettings(unwrap=True),
    "smallest-twist": AngleSettings(branch="smallest-twist"),
    "default-sign": AngleSettings(branch="default-sign"),
}
SWINGS = {
    "60°, no noise": (60.0, Noise()),
    "100°, 1°": (100.0, Noise(independent=1.0)),
    "140°, no noise": (140.0, Noise()),
    "140°, 1°": (140.0, Noise(independent=1.0)),
    "140°, 3°": (140.0, Noise(independent=3.0)),
    "140°, OU 3°": (140.0, Noise(correlated=3.0)),
    "140°, tissue": (140.0, NOISES["tissue"]),
}
WRONG = np.deg2rad(30.0)
FOLLOWING = ", following"  # the part of cross-talk that follows the moving angle
NEARLY_SQUARE = Cones((65.0, 90.0), (76.0, 104.0))
REACHES = ("clean", "iid 1°", "iid 3°", "OU 3°")
TWO = ParameterizationSettings(axes=AxesSettings(counts="joint_01=2"))


def reused(joint: TrueJoint, skeleton: Skeleton, **changes: Any) -> Parameters:
    """Solve a joint with axes that are given."""
    return parameterize(joint.motion, replace(TWO, **changes), reuse=skeleton)


def run_round_trip(seed: int) -> dict[str, float]:
    """Parameters → poses → parameters on an actor with known axes, largest difference in rad."""
    true = make_performance(np.random.default_rng(seed), free_s=10.0, cone_deg=(60.0, 120.0))
    again = parameterize(true.motion, reuse=true.skeleton)
    regular = (again.flags & JointFlag.SINGULAR) == 0
    off = np.concatenate(
        [
            np.abs(wrapped(again.angles - true.parameters.angles))[regular].ravel(),
            np.abs(wrapped(again.twists - true.parameters.twists))[regular],
        ]
    )
    return {"rad": float(np.nanmax(off)), "regular_percent": 100 * float(regular.mean())}


def run_branches(swing: str, seed: int) -> dict[str, float]:
    """Return branch rule → percent of seen frames with an angle more than 30° off."""
    reach, noise = SWINGS[swing]
    rng = np.random.default_rng([11, seed])
    joint = make_free_motion(
        rng, NEARLY_SQUARE, noise, amplitudes=(reach, 60.0), twist=30.0, seconds=24.0
    )
    wrong = {}
    for branch, settings in BRANCHES.items():
        found = reused(joint, joint.skeleton, angles=settings)
        off = np.abs(wrapped(found.angles[:, 0, :2] - joint.angles[:, :2])).max(axis=1)
        wrong[branch] = 100 * float((off > WRONG).mean())
    return wrong


def run_cross_talk(seed: int) -> dict[str, float]:
    """Return how much the other angle moves while one axis alone does, and follows it, deg rms."""
    joint = make_calibration(np.random.default_rng(1000 + seed), CONES["60–120°"], NOISES["OU 1°"])
    found = parameterize(joint.motion, TWO)
    still = found.skeleton
    cases = {
        "delivered": (joint, found),
        "true axes": (joint, reused(joint, joint.skeleton)),
        "by the axes": (joint.clean, reused(joint.clean, still)),
        "sway alone": (joint.clean, reused(joint.clean, joint.skeleton)),
    }
    told = {name: _cross_talk(*case) for name, case in cases.items()}
    return {
        f"{name}{ending}": value
        for name, pair in told.items()
        for ending, value in zip(("", FOLLOWING), pair, strict=True)
    }


def _cross_talk(joint: TrueJoint, found: Parameters) -> tuple[float, float]:
    """Return the rms in deg of the still angles, and of that part which follows the moving ones.

    What follows is a parabola of the true moving angle, fitted to each main movement's frames: all
    that an axis which is a little off makes of a turn about another (to second order).
    """
    order = matched(np.asarray(found.skeleton.joints[0].axes), joint.axes)
    angles = np.rad2deg(np.unwrap(found.angles[:, 0, order], axis=0))
    angles -= np.median(angles[~joint.moving], axis=0)  # where zero is, is a convention
    still, follows = [], []
    for moving, other in ((0, 1), (1, 0)):
        at = joint.about[:, moving]
        turn = joint.angles[at, moving]
        terms = np.column_stack([turn, turn**2])
        still.append(angles[at, other])
        follows.append(terms @ np.linalg.lstsq(terms, still[-1], rcond=None)[0])
    return rms(np.concatenate(still)), rms(np.concatenate(follows))


def run_reach(noise: str, seed: int) -> dict[str, float]:
    """Return percent of frames that axes cannot reach, and that the program flags."""
    rng = np.random.default_rng([5, seed])
    joint = make_free_motion(rng, NEARLY_SQUARE, NOISES[noise], amplitudes=(100.0, 60.0))
    found = reused(joint, joint.skeleton)
    return {
        "missed": 100 * float((found.residuals[:, 0] > 1e-6).mean()),
        "flagged": 100 * float(((found.flags[:, 0] & JointFlag.UNREACHABLE) > 0).mean()),
        "mean_mm": 1e3 * float(found.residuals[:, 0].mean()),
    }


def run_twist(seed: int) -> dict[str, float]:
    """Compare the closed form with sampling every degree on one long motion of one joint."""
    rng = np.random.default_rng([7, seed])
    joint = make_free_motion(rng, NEARLY_SQUARE, NOISES["iid 3°"], twist=30.0, seconds=480.0)
    motion, solved, seconds = joint.motion, {}, {}
    for method in ("closed-form", "sampled"):
        settings = replace(TWO, twist=TwistSettings(method=method))
        start = time.perf_counter()
        solved[method] = parameterize(motion, settings, reuse=joint.skeleton)
        seconds[method] = time.perf_counter() - start
    apart = np.abs(wrapped(solved["closed-form"].twists - solved["sampled"].twists))
    findings: dict[str, Any] = {name: dict(p.history[-1].findings) for name, p in solved.items()}
    rows = {name: found["joints"]["joint_01"] for name, found in findings.items()}
    n = motion.n_frames
    return {
        "apart_max_deg": float(np.rad2deg(apart.max())),
        "closed_sum_deg": rows["closed-form"]["twist_deviation_sum_mean_deg"],
        "sampled_sum_deg": rows["sampled"]["twist_deviation_sum_mean_deg"],
        "extra_us": 1e6 * (seconds["sampled"] - seconds["closed-form"]) / n,
        "closed_us": 1e6 * seconds["closed-form"] / n,
    }


TRIP_TASKS = [(seed,) for seed in range(5)]
BRANCH_TASKS = [(swing, seed) for swing in SWINGS for seed in range(20)]
CROSS_TASKS = [(seed,) for seed in range(SEEDS)]
REACH_TASKS = [(noise, seed) for noise in REACHES for seed in range(20)]
TWIST_TASKS = [(0,)]


def summary(
    trips: list[dict[str, float]],
    branches: list[dict[str, float]],
    cross: list[dict[str, float]],
    reach: list[dict[str, float]],
    twist: list[dict[str, float]],
) -> dict[str, Any]:
    """Return all figures of the section."""

    def mean(tasks: list[Any], results: list[dict[str, float]], key: str) -> dict[str, float]:
        mine = [r for t, r in zip(tasks, results, strict=True) if t[0] == key]
        return {name: float(np.mean([r[name] for r in mine])) for name in mine[0]}

    return {
        "round_trip_rad": max(t["rad"] for t in trips),
        "regular_percent": float(np.mean([t["regular_percent"] for t in trips])),
        "branches_percent": {key: mean(BRANCH_TASKS, branches, key) for key in SWINGS},
        "branches_worst_percent": {
            key: {
                name: max(
                    r[name] for t, r in zip(BRANCH_TASKS, branches, strict=True) if t[0] == key
                )
                for name in BRANCHES
            }
            for key in SWINGS
        },
        "cross_talk_deg": {
            name: {
                "median": float(np.median([c[name] for c in cross])),
                "worst": max(c[name] for c in cross),
            }
            for name in cross[0]
        },
        "reach_percent": {key: mean(REACH_TASKS, reach, key) for key in REACHES},
        "twist": twist[0],
    }


def bars(found: dict[str, Any]) -> list[Bar]:
    """Return what is asked of the angles."""
    cross = found["cross_talk_deg"]
    wrong = found["branches_percent"]["140°, 1°"]["viterbi"]
    return [
        Bar("Angles", "round trip, away from singularities", found["round_trip_rad"], "rad", 1e-9),
        Bar("Angles", "frames on the wrong branch, 140° swings, 1°, ±30° twist", wrong, "%", 1.0),
        Bar(
            "Angles",
            "cross-talk at OU 1°, as delivered: what of an angle follows the other, median",
            cross["delivered" + FOLLOWING]["median"],
            "deg",
            1.0,
        ),
        Bar(
            "Angles",
            "cross-talk at OU 1°, as delivered: what of an angle follows the other, worst joint",
            cross["delivered" + FOLLOWING]["worst"],
            "deg",
            1.0,
            beside=True,
        ),
        Bar(
            "Angles",
            "cross-talk at OU 1°, by the axes alone: found axes on poses without noise, median",
            cross["by the axes"]["median"],
            "deg",
            1.0,
            beside=True,
        ),
        Bar(
            "Angles",
            "whole error of the angle at rest at OU 1°, cross-talk and noise: median",
            cross["delivered"]["median"],
            "deg",
            1.0,
            beside=True,
        ),
    ]


_TRIP = """\
## 3 Angles and twist

Parameters → poses → parameters on five actors in calibration and free motion: at most {trip} rad
off, in the {regular:.1f} % of all poses that are not flagged as singular.

Branches: percent of frames with an angle more than 30° off, true axes given. The limb swings about
the first axis as far as the column says, ±60° about the second and twists by ±30° at the same time;
independent noise but where it says OU or tissue, nothing smoothed. In brackets the worst of 20
joints.
With `angles.unwrap` a twist is a movement like the other angles: its size tells less.
"""
_CROSS = """
**Cross-talk** is the leak of one rotation into another: what an angle shows, while the limb moves
about the other axis alone, *because* of that movement. Cones 60–120°, 1° of correlated noise.

- *Asked*: at most 1°. *Measured*: **{follows}°** in the median, {worst}° in the worst.
- How: the part of the resting angle that goes with the moving one, by a parabola in it fitted to
  the frames of each axis' movements, rms (*follows*).
- *rms* is the whole resting angle, {whole}° in the median. It holds the noise of the poses, which
  does not follow anything and which no axes can take out: true axes show {noise}° of it. Angles are
  never smoothed.
- The figure held to 1° was the whole of it at first: it is held to it still, and misses.

| | rms: median | worst | follows: median | worst |
|---|---:|---:|---:|---:|"""
_REACH = """
Noise carries the limb to where the axes cannot take it (free motion, ±100° about the
first axis and ±60° about the second, true axes):
"""
_TWIST = """
Twist: the closed form against the paper's sampling, every degree. The two differ by {apart}° at
most, half a step; a summed deviation of {closed}° is left against {sampled}°. Sampling costs
{extra} µs more a joint and frame, where the whole stage takes {stage} µs.
"""
_CROSS_ROWS = {
    "delivered": "as delivered: found axes, noisy poses",
    "true axes": "true axes, noisy poses: what noise alone does",
    "by the axes": "found axes, poses without noise: what wrong axes do",
    "sway alone": "true axes, poses without noise: the actor's own sway",
}
_REACH_ROWS = {
    "missed": "out of reach, %",
    "flagged": "by more than 2° and flagged, %",
    "mean_mm": "mean distance, mm",
}


def page(found: dict[str, Any]) -> str:
    """Return the section."""
    twist = found["twist"]
    lines = [
        _TRIP.format(trip=f"{found['round_trip_rad']:.0e}", regular=found["regular_percent"]),
        "| branch | " + " | ".join(SWINGS) + " |",
        "|---|" + "---:|" * len(SWINGS),
    ]
    for branch in BRANCHES:
        cells = (
            f"{found['branches_percent'][swing][branch]:.2f} % "
            f"({found['branches_worst_percent'][swing][branch]:.1f})"
            for swing in SWINGS
        )
        name = f"**{branch}** (default)" if branch == "viterbi" else branch
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
        if branch in prototype.BRANCHES:
            before = (*prototype.BRANCHES[branch], *["–"] * len(SWINGS))[: len(SWINGS)]
            lines.append(f"| *{branch}, prototype* | " + " | ".join(before) + " |")
    cross = found["cross_talk_deg"]
    lines.append(
        _CROSS.format(
            follows=number(cross["delivered" + FOLLOWING]["median"]),
            worst=number(cross["delivered" + FOLLOWING]["worst"]),
            whole=number(cross["delivered"]["median"]),
            noise=number(cross["true axes"]["median"]),
        )
    )
    for name, meaning in _CROSS_ROWS.items():
        both = (found["cross_talk_deg"][name + ending] for ending in ("", FOLLOWING))
        cells = (f"{number(row[which])}°" for row in both for which in ("median", "worst"))
        lines.append(f"| {meaning} | " + " | ".join(cells) + " |")
    lines += [_REACH, "| | " + " | ".join(REACHES) + " |", "|---|" + "---:|" * len(REACHES)]
    for key, what in _REACH_ROWS.items():
        cells = (number(row[key]) for row in found["reach_percent"].values())
        lines.append(f"| {what} | " + " | ".join(cells) + " |")
    lines.append(
        _TWIST.format(
            apart=number(twist["apart_max_deg"]),
            closed=number(twist["closed_sum_deg"]),
            sampled=number(twist["sampled_sum_deg"]),
            extra=number(twist["extra_us"]),
            stage=number(twist["closed_us"]),
        )
    )
    return "\n".join(lines)
