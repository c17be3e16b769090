"""Limbs without a pose of their own, fitted together with the limbs on either side."""

from typing import NamedTuple

import numpy as np

from kinesphere.data import Array, Mask
from kinesphere.geometry.joint_turns import nearest
from kinesphere.geometry.linkage import Linkage, misfit
from kinesphere.geometry.linkage_fit import LinkageFit, fit_linkage
from kinesphere.geometry.pose_worth import noise_share, overrated
from kinesphere.geometry.range_of_motion import range_of_motion
from kinesphere.geometry.vectors import is_seen, lengths
from kinesphere.skeleton.averages import mean_seen, median_seen
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.landmarks import BETWEEN, STEADY
from kinesphere.skeleton.linked_joint import LinkedJoint
from kinesphere.skeleton.linked_poses import linkage_of, markers_of, parents_in
from kinesphere.skeleton.linked_start import turned_from_beyond
from kinesphere.skeleton.measured import MeasuredJoint
from kinesphere.skeleton.settings import SkeletonSettings
from kinesphere.skeleton.tree import Tree

FEWEST, THREE = 2, 3
"""Markers that a limb between others and a limb beyond it have at least."""
STRAYED = 3.0
"""Spreads off its expectation beyond which a centre says that the group tells nothing."""
WAYS = 41
"""Places tried on a line."""
FEW = 30
"""Frames that show every limb of a group below which it stays as it was measured."""


class GroupFit(NamedTuple):
    """Limbs that were fitted together."""

    joints: dict[str, LinkedJoint]
    """Child limb → its joint."""
    strays: bool
    """Whether a joint is where none of these limbs can be."""
    firm: bool
    """Whether every joint is known in two directions; a hinge is open along its axis."""


def fit_linked(
    tree: Tree,
    bodies: dict[str, Body],
    joints: dict[str, MeasuredJoint],
    sample: dict[str, Array],
    settings: SkeletonSettings,
) -> dict[str, LinkedJoint]:
    """Fit every group of limbs that hang together by limbs without a pose of their own.

    A limb of two markers gets its pose from the joint towards its parent, and hands that joint's
    error on to the next one; a limb whose markers and joint lie on a line cannot even say where
    the next joint is. All of it together can: the next limb's markers tell how this one turns.

    Only joints that no landmark of a model tells: those are placed by people's measures.

    Returns
    -------
    child limb → LinkedJoint
    """
    linked: dict[str, LinkedJoint] = {}
    for group in find_groups(tree, bodies):
        if all(joints[limb].source in (BETWEEN, STEADY) for limb in group[1:]):
            fit = fit_group(group, bodies, joints, sample, settings)
            if fit is not None and fit.firm and not fit.strays:
                linked |= fit.joints
    return linked


def find_groups(tree: Tree, bodies: dict[str, Body]) -> list[tuple[str, ...]]:
    """Return limbs to be fitted together: one with a pose of its own, one without, those beyond.

    Those beyond have three markers at least each: so many tell a pose but for what a line leaves
    open, and that the joint tells. Limbs with fewer, one after another, know too little of each
    other. A limb that may hang elsewhere stays out beside sure ones, for hung wrongly, it would
    bend those; where no joint is sure, limb by limb they would not be surer.
    """
    groups = []
    for joint in tree.joints:
        ends = [other for other in tree.joints if other.parent == joint.child]
        sure = [other for other in ends if not other.doubtful]
        if sure or not joint.doubtful:
            ends = [] if joint.doubtful else sure
        beyond = [other.child for other in ends]
        between = bodies[joint.parent].own_pose and not bodies[joint.child].own_pose
        enough = len(tree.markers[joint.child]) >= FEWEST and all(
            len(tree.markers[limb]) >= THREE for limb in beyond
        )
        if between and enough and beyond:
            groups.append((joint.parent, joint.child, *beyond))
    return groups


def fit_group(
    group: tuple[str, ...],
    bodies: dict[str, Body],
    joints: dict[str, MeasuredJoint],
    sample: dict[str, Array],
    settings: SkeletonSettings,
) -> GroupFit | None:
    """Fit a group of `find_groups`; None where too little of it is seen or moves."""
    limbs = [bodies[limb] for limb in group]
    measured = [joints[limb] for limb in group[1:]]
    rotations = np.stack([body.rotations for body in limbs], axis=1)
    known = np.isfinite(rotations).all(axis=(1, 2, 3)) & is_seen(limbs[0].shifts)
    if known.sum() < FEW or not all(is_seen(body.shape).any() for body in limbs):
        return None
    moved = [
        _moved(rotations[known], parent, child)
        for child, parent in enumerate(parents_in(group, bodies)[1:], start=1)
    ]
    if min(moved) < np.deg2rad(settings.min_range_deg):
        return None  # skin is all that moves there
    start = linkage_of(group, bodies, joints, rotations[known], limbs[0].shifts[known])
    leads = np.array([j.expected - j.fit.centre for j in measured])
    expected = start.centres + np.vstack([np.zeros(3), leads])
    n_poses = [j.fit.n_poses for j in measured]
    points = markers_of(group, bodies, sample)[known]
    fits = [
        fit_linkage(
            begun,
            points,
            expected,
            np.array([0.0, *(1 / j.spread**2 for j in measured)]),
            float(np.mean(n_poses)) / settings.soft_tissue**2,
        )
        # a limb on a line has put the next joint anywhere round it
        for begun in _starts(group, start, expected, bodies, points)
    ]
    fit = min(fits, key=lambda one: one.scale)
    off = np.linalg.norm(fit.linkage.centres - expected, axis=1)[1:]
    near = off < STRAYED * np.array([j.spread for j in measured])  # not so where it is not finite
    told = np.linalg.eigvalsh(fit.information[1:])[:, 1]
    firm = told >= 1 / (settings.undetermined_mm * 1e-3) ** 2
    share = _averaging_share(fit.linkage, points)
    over = [overrated(share, len(points), n, settings.soft_tissue) for n in n_poses]
    return GroupFit(_joints(group, fit, known, n_poses, over), not near.all(), bool(firm.all()))


def _averaging_share(linkage: Linkage, points: Array) -> float:
    """Return the share of the markers' strays that averages out over frames, 0…1."""
    off = misfit(linkage, points, is_seen(points))
    first, others = linkage.rotations[:, :1], linkage.rotations[:, 1:]
    turns = np.swapaxes(first, 2, 3) @ others
    return noise_share(off.reshape(len(off), -1), nearest(turns.reshape(len(turns), -1)))


def _starts(
    group: tuple[str, ...],
    start: Linkage,
    expected: Array,
    bodies: dict[str, Body],
    points: Array,
) -> list[Linkage]:
    """Return what to begin with: as measured, and others where a limb is on a line.

    Nothing is known yet of the turn about that line: joints on it move least with that. Those are
    as expected, and where on the line markers beyond keep their distances best. Joints off it tell
    the turn.
    """
    if not bodies[group[1]].twist_open:
        return [start]
    shape, centres = start.shapes[1], expected.copy()
    far = shape[np.linalg.norm(shape, axis=1).argmax()]
    ways = np.linspace(0.0, 2.0, WAYS)[:, None] * far
    at = start.origins[:, 1, None] + ways @ np.swapaxes(start.rotations[:, 1], 1, 2)
    first = len(start.shapes[0]) + len(shape)
    for body in range(2, len(group)):
        markers = points[:, first : first + len(start.shapes[body])]
        away = lengths(at[:, :, None] - markers[:, None])
        strays = away - np.stack([median_seen(one) for one in np.moveaxis(away, 1, 0)])
        centres[body] = ways[mean_seen(np.abs(strays)).mean(axis=1).argmin()]
        first += len(start.shapes[body])
    placed = [start._replace(centres=one) for one in (expected, centres)]
    turned = turned_from_beyond(start, points)
    return [start, *placed, *([] if turned is None else [turned])]


def _moved(rotations: Array, parent: int, child: int) -> float:
    """Return the range of motion of a joint in rad."""
    relative = np.swapaxes(rotations[:, parent], 1, 2) @ rotations[:, child]
    return range_of_motion(relative)


def _joints(
    group: tuple[str, ...], fit: LinkageFit, known: Mask, n_poses: list[int], over: list[float]
) -> dict[str, LinkedJoint]:
    linked = {}
    origins = fit.linkage.origins
    for i, limb in enumerate(group[1:], start=1):
        world = np.full((len(known), 3), np.nan)
        frames = np.full((len(known), 3, 3), np.nan)
        world[known] = origins[:, i]
        frames[known] = fit.linkage.rotations[:, fit.linkage.parents[i]]
        linked[limb] = LinkedJoint(
            world, frames, fit.information[i], over[i - 1], fit.scale, n_poses[i - 1]
        )
    return linked
