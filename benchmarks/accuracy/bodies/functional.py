"""Hips and knees of functional trials: between halves, and against a peer on the same poses.

The peer is biobuddy (MIT), whose SCoRE and SARA follow Ehrig et al. 2006, 2007. Where it is not
installed its columns stay empty.
"""

import logging
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from benchmarks.accuracy.bodies.cases import folder
from kinesphere import read
from kinesphere.data import Recording, Solution, TopologicalModel
from kinesphere.geometry.algebraic_centres import score_centre
from kinesphere.labelling import choose_model
from kinesphere.pipeline import solve

TRIALS = (
    ("Test_func_lhip", "left_hip"),
    ("Test_func_rhip", "right_hip"),
    ("Test_func_lknee", "left_knee"),
    ("Test_func_rknee", "right_knee"),
)


@dataclass(frozen=True)
class Found:
    """A joint in its parent's frame."""

    centre: np.ndarray
    axis: np.ndarray


@dataclass(frozen=True)
class Functional:
    """One joint of one trial; of knees, centres are compared across the axis."""

    trial: str
    joint: str
    observability: str
    halves_mm: float
    along_mm: float
    halves_deg: float
    landmarks_mm: float
    """As ``halves_mm`` where the layout's landmarks have their say."""
    landmarks_deg: float
    """The same where the layout's landmarks have their say, as when a user solves each half."""
    told_mm: float
    """What the uncertainties of the halves' centres lead to expect between them, rms."""
    told_deg: float
    """The same of their axes."""
    blocks_mm: float
    """Between every second eighth of the trial and the rest: the same movements in both."""
    blocks_deg: float
    peer_halves_mm: float
    peer_halves_deg: float
    peer_mm: float
    """Between the peer's centre and ours."""
    score_mm: float
    """Between the peer's centre and the plain SCoRE of this project, same poses."""
    peer_deg: float
    time_ratio: float
    """Processor time of the peer's SCoRE over that of the plain one of this project."""


def functional_rows() -> list[Functional]:
    """Return a row a trial."""
    return [_row(trial, joint) for trial, joint in TRIALS]


def _row(trial: str, name: str) -> Functional:
    recording = read(folder() / "functional" / f"{trial}.c3d")
    chosen = choose_model(recording)
    assert chosen is not None
    # no landmark has a say: everything is from the motion
    model = replace(chosen, joints=tuple(replace(j, landmarks=()) for j in chosen.joints))
    whole = solve(recording, model)
    middle = recording.n_frames // 2
    parts = slice(middle), slice(middle, None)
    halves = [half_of(recording, model, part) for part in parts]
    knee = name.endswith("knee")
    eighth = np.arange(recording.n_frames) * 8 // recording.n_frames % 2
    blocks = [half_of(recording, model, np.flatnonzero(eighth == k)) for k in (0, 1)]
    ours = _compared(halves, name, _ours, knee=knee)
    mixed = _compared(blocks, name, _ours, knee=knee)
    aided = _compared([half_of(recording, chosen, p) for p in parts], name, _ours, knee=knee)
    peer = _compared(halves, name, _peer, knee=knee)
    here, there = _ours(whole, name), _peer(whole, name)
    poses = _relative(whole, name)
    plain = score_centre(*poses, ridge=0.0)[0]
    return Functional(
        trial=trial,
        joint=name,
        observability=whole.skeleton.joint(name).observability,
        halves_mm=ours[0],
        along_mm=ours[1],
        halves_deg=ours[2],
        landmarks_mm=aided[0],
        landmarks_deg=aided[2],
        told_mm=_told(halves, name, knee=knee),
        told_deg=_told_axis(halves, name) if knee else np.nan,
        blocks_mm=mixed[0],
        blocks_deg=mixed[2],
        peer_halves_mm=peer[0],
        peer_halves_deg=peer[2],
        peer_mm=_apart(there.centre - here.centre, there.axis if knee else None)[0],
        score_mm=_apart(there.centre - plain, None)[0],
        peer_deg=_angle(here.axis, there.axis) if knee else np.nan,
        time_ratio=_clocked(lambda: _peer(whole, name)) / _clocked(lambda: score_centre(*poses)),
    )


def half_of(recording: Recording, model: TopologicalModel, part: slice | np.ndarray) -> Solution:
    """Solve some frames of a recording as if they were all of it."""
    outputs = tuple(replace(o, values=o.values[part], residuals=None) for o in recording.outputs)
    return solve(
        replace(
            recording,
            markers=recording.markers[part],
            residuals=None if recording.residuals is None else recording.residuals[part],
            outputs=outputs,
            analog=None,
            details={},
        ),
        model,
    )


def _ours(solution: Solution, name: str) -> Found:
    joint = solution.skeleton.joint(name)
    axes = np.full((1, 3), np.nan) if joint.axes is None else joint.axes
    return Found(joint.centre_in_parent, axes[0])


def _peer(solution: Solution, name: str) -> Found:
    """Return the peer's SCoRE centre and SARA axis from the poses of the two limbs."""
    nothing = Found(np.full(3, np.nan), np.full(3, np.nan))
    try:
        from biobuddy.model_modifiers.joint_center_tool import Sara, Score
        from biobuddy.utils.linear_algebra import RotoTransMatrixTimeSeries
    except ImportError:
        return nothing
    logging.getLogger("biobuddy").setLevel(logging.ERROR)
    motion, joint = solution.motion, solution.skeleton.joint(name)
    series = []
    for limb in (joint.parent, joint.child):
        i = motion.skeleton.limb_names.index(limb)
        matrices = np.zeros((4, 4, motion.n_frames))
        matrices[:3, :3] = np.moveaxis(motion.rotations[:, i], 0, -1)
        matrices[:3, 3] = motion.origins[:, i].T
        matrices[3, 3] = 1.0
        known = np.isfinite(matrices).all(axis=(0, 1))
        series.append((matrices, known))
    both = series[0][1] & series[1][1]
    parent, child = (
        RotoTransMatrixTimeSeries.from_rt_matrix(matrices[:, :, both]) for matrices, _ in series
    )
    _, centre, *_ = Score.perform_algorithm(parent, child)
    _, axis, *_ = Sara.perform_algorithm(parent, child)
    return Found(np.asarray(centre)[:3], np.asarray(axis)[:3])


def _compared(
    halves: list[Solution],
    name: str,
    method: Callable[[Solution, str], Found],
    *,
    knee: bool,
) -> tuple[float, float, float]:
    """Return mm across (of hips: in all), mm along and deg between two halves of a trial."""
    first, second = (method(half, name) for half in halves)
    turn, shift = _laid_on(*(_markers(half, name) for half in halves))
    off = turn @ second.centre + shift - first.centre
    across, along = _apart(off, first.axis if knee else None)
    return across, along, _angle(turn @ second.axis, first.axis) if knee else np.nan


def _told(halves: list[Solution], name: str, *, knee: bool) -> float:
    """Return how far apart centres are to be expected by their covariances, mm rms."""
    total = 0.0
    for half in halves:
        joint = half.skeleton.joint(name)
        across = np.eye(3)
        if knee and joint.axes is not None:
            across -= np.outer(joint.axes[0], joint.axes[0])
        total += float(np.trace(across @ joint.covariance @ across))
    return 1e3 * float(np.sqrt(total))


def _told_axis(halves: list[Solution], name: str) -> float:
    """Return how far apart axes are to be expected by their uncertainties, deg rms."""
    told = [half.skeleton.joint(name).axes_uncertainty for half in halves]
    return float(np.rad2deg(np.linalg.norm([np.nan if t is None else t[0] for t in told])))


def _markers(solution: Solution, name: str) -> dict[str, np.ndarray]:
    limb = solution.skeleton.limb(solution.skeleton.joint(name).parent)
    return dict(zip(limb.markers, limb.marker_positions, strict=True))


def _laid_on(
    first: dict[str, np.ndarray], second: dict[str, np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    """Return the rotation and shift that lay a limb's markers of the second half on the first's."""
    common = [label for label in first if label in second]
    a, b = (np.array([limb[label] for label in common]) for limb in (first, second))
    u, _, vt = np.linalg.svd((a - a.mean(axis=0)).T @ (b - b.mean(axis=0)))
    turn = u @ np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt))]) @ vt
    return turn, a.mean(axis=0) - turn @ b.mean(axis=0)


def _relative(solution: Solution, name: str) -> tuple[np.ndarray, np.ndarray]:
    motion, joint = solution.motion, solution.skeleton.joint(name)
    p, c = (motion.skeleton.limb_names.index(limb) for limb in (joint.parent, joint.child))
    back = np.swapaxes(motion.rotations[:, p], 1, 2)
    shifts = motion.origins[:, c] - motion.origins[:, p]
    return back @ motion.rotations[:, c], (back @ shifts[..., None])[..., 0]


def _apart(off: np.ndarray, axis: np.ndarray | None) -> tuple[float, float]:
    """Return the length in mm of a difference across an axis and along it."""
    along = 0.0 if axis is None else float(off @ axis)
    across = np.sqrt(max(float(off @ off) - along**2, 0.0)) if np.isfinite(off).all() else np.nan
    return 1e3 * float(across), 1e3 * abs(along)


def _angle(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.rad2deg(np.arccos(np.clip(abs(a @ b), 0.0, 1.0))))


def _clocked(work: Callable[[], Any]) -> float:
    work()
    start = time.process_time()
    for _ in range(5):
        work()
    return (time.process_time() - start) / 5
