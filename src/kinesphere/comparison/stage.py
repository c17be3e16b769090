"""Compare two solutions of one motion: align in time, world and limb frames, then measure."""

import numpy as np

from kinesphere.comparison.alignment import LimbAlignment, fit_limb, fit_world, same_world
from kinesphere.comparison.angles import JointPoses, bend, clinical, own_axes, own_before
from kinesphere.comparison.doubts import warnings_of
from kinesphere.comparison.kinship import Kinship, find_kinship
from kinesphere.comparison.matching import called_alike
from kinesphere.comparison.refinement import common_times, joint_centres, time_offset
from kinesphere.comparison.result import Comparison, JointComparison, ParameterComparison
from kinesphere.comparison.sides import Side, relative, sampled, side_from
from kinesphere.data import Array, Motion, Parameters, Solution
from kinesphere.data.isb import IsbJoint, isb_joint
from kinesphere.data.isb_conventions import ROOT_CONVENTION, ROOTS
from kinesphere.errors import DegenerateMotion
from kinesphere.geometry.rotations import rotation_angle
from kinesphere.geometry.vectors import lengths


def compare(
    first: Solution | Motion | Parameters,
    second: Solution | Motion | Parameters,
    *,
    offset: float | None = None,
) -> Comparison:
    """Compare two solutions of one motion.

    What differs by definition is found and taken out first: the time offset, the world, and the
    constant turn between the two frames of every limb, for much of the published difference
    between systems is the definition of frames. Differences before and after are both told. What
    both have from one source needs no alignment, and nothing is taken out that was changed on
    purpose: an edited motion and its source have one clock, one world, one set of limb frames.
    Limbs and joints are matched by name, joints also by their child limbs, as BVH calls them, and
    limbs by what other programs' names mean.

    Parameters
    ----------
    first, second
        Solved, by markers or without; their rates may differ.
    offset
        s: what is at time t of the first is at ``t + offset`` of the second. None to find it; it is
        0 where both have the frames of one recording.

    Returns
    -------
    Comparison
        Differences are the second minus the first.

    Raises
    ------
    DegenerateMotion
        If no joint is common to both, they have no moment in common, or, without a given offset,
        their limbs do not turn at the same speeds.
    BadRecording, BadSetting
        If one of them has no pose at all; if the offset is not finite.
    """
    a, b = called_alike(side_from(first), side_from(second))
    names = [n for n in a.skeleton.joint_names if n in b.skeleton.joint_names]
    if not names:
        raise DegenerateMotion(
            "no joint is the same on both sides by its name or its limb's: "
            f"{', '.join(a.skeleton.joint_names[:4]) or 'none'} here, "
            f"{', '.join(b.skeleton.joint_names[:4]) or 'none'} there"
        )
    kin = find_kinship(a, b)
    at = time_offset(a, b, names, offset, shared=kin.clock)
    times = common_times(a, b, at.seconds)
    a, b = sampled(a, times), sampled(b, times + at.seconds)
    centres = [joint_centres(side, names) for side in (a, b)]
    world = same_world(*centres) if kin.world else fit_world(*centres)
    turn = np.eye(3) if world is None else world.rotation
    moved = turn @ b.motion.rotations
    frames = _Frames(a, b, moved, kin)
    parameters: list[ParameterComparison] = list(_root(a, b, moved, frames))
    joints = []
    for j, name in enumerate(names):
        poses = frames.joint(name)
        if poses is None:
            continue
        parameters += _parameters(a, b, name, poses)
        apart = centres[1][:, j] if world is None else centres[1][:, j] @ turn.T + world.shift
        parent = a.motion.rotations[:, a.skeleton.limb_names.index(a.skeleton.joint(name).parent)]
        joints.append(_joint(name, poses, apart - centres[0][:, j], parent))
    if not joints:
        raise DegenerateMotion("no common joint is seen on both sides at the same time")
    limbs = tuple(frames.found.values())
    return Comparison(
        times=times,
        rate=a.motion.rate,
        kinship=kin,
        offset=at,
        world=world,
        limbs=limbs,
        joints=tuple(joints),
        parameters=tuple(parameters),
        limbs_only_first=_only(a.skeleton.limb_names, b.skeleton.limb_names),
        limbs_only_second=_only(b.skeleton.limb_names, a.skeleton.limb_names),
        joints_only_first=_only(a.skeleton.joint_names, b.skeleton.joint_names),
        joints_only_second=_only(b.skeleton.joint_names, a.skeleton.joint_names),
        warnings=at.warnings + warnings_of(a, b, world, parameters, names, joints),
    )


class _Frames:
    """The limb frames of both sides; constant turns between them are found once each."""

    def __init__(self, first: Side, second: Side, moved: Array, kin: Kinship) -> None:
        self.first, self.second, self.moved, self.same = first, second, moved, kin.limbs
        self.found: dict[tuple[str, str], LimbAlignment] = {}

    def limb(self, name: str, other: str) -> LimbAlignment | None:
        if (name, other) not in self.found:
            mine = self.first.motion.rotations[:, self.first.skeleton.limb_names.index(name)]
            theirs = self.moved[:, self.second.skeleton.limb_names.index(other)]
            fit = fit_limb(name, other, mine, theirs, same=self.same)
            if fit is None:
                return None
            self.found[name, other] = fit
        return self.found[name, other]

    def joint(self, name: str) -> JointPoses | None:
        mine, theirs = self.first.skeleton.joint(name), self.second.skeleton.joint(name)
        parent = self.limb(mine.parent, theirs.parent)
        child = self.limb(mine.child, theirs.child)
        if parent is None or child is None:
            return None
        first = relative(self.first, mine.parent, mine.child)
        second = relative(self.second, theirs.parent, theirs.child)
        if not (np.isfinite(first[:, 0, 0]) & np.isfinite(second[:, 0, 0])).any():
            return None
        return JointPoses(first, second, parent.rotation.T @ second @ child.rotation)


def _root(a: Side, b: Side, moved: Array, frames: _Frames) -> list[ParameterComparison]:
    """Compare how the root stands in the laboratory, where both have one of that name."""
    name = a.skeleton.limb_names[0]
    if name not in ROOTS or name not in b.skeleton.limb_names:
        return []
    fit = frames.limb(name, name)
    if fit is None:
        return []
    column = b.skeleton.limb_names.index(name)
    read = IsbJoint(name, ROOT_CONVENTION, 0.0, "body")
    poses = JointPoses(
        a.motion.rotations[:, 0], b.motion.rotations[:, column], moved[:, column] @ fit.rotation
    )
    return clinical(poses, read, read)


def _parameters(a: Side, b: Side, name: str, poses: JointPoses) -> list[ParameterComparison]:
    mine, theirs = a.skeleton.joint(name), b.skeleton.joint(name)
    parents = (a.skeleton.limb(mine.parent), b.skeleton.limb(theirs.parent))
    children = (a.skeleton.limb(mine.child), b.skeleton.limb(theirs.child))
    found = []
    if (read := isb_joint(mine)) is not None:
        found += clinical(poses, read, isb_joint(theirs))
    found.append(bend(poses, parents, children, name))
    return found + own_axes(poses, mine, children[0], own_before(b, mine))


def _joint(name: str, poses: JointPoses, apart: Array, parent: Array) -> JointComparison:
    """Return how far apart the two are at one joint.

    Parameters
    ----------
    apart : (n, 3) m
        Second minus first centre, in the first's world.
    parent : (n, 3, 3)
        ``world_from_parent`` of the first side.
    """
    in_parent = (np.swapaxes(parent, -1, -2) @ apart[..., None])[..., 0]
    known = np.isfinite(in_parent).all(axis=1)
    constant = in_parent[known].mean(axis=0) if known.any() else np.full(3, np.nan)
    return JointComparison(
        name=name,
        orientation_before=_rms(rotation_angle(_between(poses.first, poses.second))),
        orientation_after=_rms(rotation_angle(_between(poses.first, poses.aligned))),
        centre=_rms(lengths(apart)),
        centre_constant=float(np.linalg.norm(constant)),
        centre_after=_rms(lengths(in_parent - constant)),
    )


def _between(first: Array, second: Array) -> Array:
    return np.asarray(np.swapaxes(first, -1, -2) @ second)


def _rms(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if len(known) else float("nan")


def _only(mine: tuple[str, ...], theirs: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(name for name in mine if name not in theirs)
