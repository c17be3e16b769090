"""Every limb's pose in every frame: outward from the root, then inward for what is still open."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Codes, PoseFlag
from kinesphere.geometry.poses import misfits
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.body_axes import unit
from kinesphere.skeleton.linked import find_groups
from kinesphere.skeleton.linked_poses import pose_linked
from kinesphere.skeleton.measured import MeasuredJoint
from kinesphere.skeleton.neighbours import cloud, next_normals
from kinesphere.skeleton.poses import Neighbour, Poses, aim, bridge, fit_poses
from kinesphere.skeleton.settings import SkeletonSettings
from kinesphere.skeleton.spanned import span
from kinesphere.skeleton.tree import Tree


class PoseArrays(NamedTuple):
    """The poses of all limbs side by side, as a motion holds them."""

    rotations: Array
    """(n_frames, n_limbs, 3, 3) ``world_from_limb``; NaN where unseen."""
    shifts: Array
    """(n_frames, n_limbs, 3) m."""
    flags: Codes
    """(n_frames, n_limbs) PoseFlag."""
    residuals: Array
    """(n_frames, n_limbs) m, rms distance of the markers from where the pose puts them."""

    def of(self, limb: int) -> Poses:
        """Return one limb's poses, as views."""
        return Poses(self.rotations[:, limb], self.shifts[:, limb], self.flags[:, limb])


def solve_poses(
    tree: Tree,
    bodies: dict[str, Body],
    joints: dict[str, MeasuredJoint],
    markers: dict[str, Array],
    rate: float,
    settings: SkeletonSettings,
    frames: NDArray[np.intp],
) -> PoseArrays:
    """Return the poses of every limb in every frame; limbs in the tree's order.

    Parameters
    ----------
    markers
        Label → (n_frames, 3) m in the world.
    rate
        Hz.
    frames
        Those that bodies were measured in.
    """
    n_frames, n_limbs = len(next(iter(markers.values()))), len(tree.limbs)
    arrays = PoseArrays(
        np.full((n_frames, n_limbs, 3, 3), np.nan),
        np.full((n_frames, n_limbs, 3), np.nan),
        np.full((n_frames, n_limbs), PoseFlag.UNSEEN, dtype=np.uint8),
        np.full((n_frames, n_limbs), np.nan),
    )
    measured = _Measured(tree, bodies, joints, markers)
    groups = {group[1]: group for group in find_groups(tree, bodies)}
    for i, limb in enumerate(tree.limbs):
        if limb in groups and bodies[limb].linked:
            group = groups[limb]
            at = {name: tree.limbs.index(name) for name in group}
            open_ = {name: arrays.of(at[name]) for name in group[1:] if bodies[name].linked}
            first = arrays.of(at[group[0]])
            pose_linked(group, bodies, joints, markers, frames, first, open_)
        body, poses = bodies[limb], arrays.of(i)
        own = cloud(tree.markers[limb], markers)
        parent = None if body.parent is None else arrays.of(tree.limbs.index(body.parent))
        _solve_limb(body, own, parent, measured, poses, rate, settings)
        arrays.residuals[:, i] = misfits(poses.rotations, poses.shifts, body.shape, own)
    return arrays


class _Measured(NamedTuple):
    """What is known before any pose in the whole recording is."""

    tree: Tree
    bodies: dict[str, Body]
    joints: dict[str, MeasuredJoint]
    markers: dict[str, Array]


def _solve_limb(
    body: Body,
    own: Array,
    parent: Poses | None,
    measured: _Measured,
    poses: Poses,
    rate: float,
    settings: SkeletonSettings,
) -> None:
    """Find one limb's poses, in place; every way only where those before it left a frame open."""
    longest = int(settings.fill_gap_s * rate)
    min_spread = settings.min_spread_mm * 1e-3
    centre = None if parent is None else parent.carry(measured.joints[body.name].fit.centre)
    if not body.twist_open:
        near = () if centre is None else (Neighbour(_centre(body), centre, body.centre_noise),)
        fit_poses(body, own, near, min_spread, poses)
        if helpers := _helpers(body.name, measured, min_spread, poses):
            fit_poses(body, own, (*near, *helpers), min_spread, poses)
            if parent is not None and centre is not None:
                span(poses, body, parent, centre, helpers[0], longest)
        bridge(poses, body, parent, centre, longest)
    if parent is None or centre is None or (poses.flags != PoseFlag.UNSEEN).all():
        return
    reach = np.linalg.norm(body.shape - _centre(body), axis=1)
    end = own[:, int(np.nan_to_num(reach, nan=-1.0).argmax())]
    normals = next_normals(body.name, unit(end - centre), end, measured.tree, measured.markers)
    aim(body, own, centre, parent, normals, np.deg2rad(settings.flexed_deg), poses)
    if body.twist_open:
        bridge(poses, body, parent, centre, longest)


def _helpers(
    limb: str, measured: _Measured, min_spread: float, poses: Poses
) -> tuple[Neighbour, ...]:
    """Return where the limbs beyond see the joints they share with a limb that is still unseen."""
    tree, bodies, joints, markers = measured
    open_ = np.flatnonzero(poses.flags == PoseFlag.UNSEEN)
    helpers = []
    for child in tree.children(limb) if len(open_) else ():
        if bodies[child].twist_open:
            continue
        own = cloud(tree.markers[child], {m: markers[m][open_] for m in tree.markers[child]})
        alone = fit_poses(bodies[child], own, (), min_spread)
        if (alone.flags == PoseFlag.UNSEEN).all():
            continue
        world = np.full((len(poses.flags), 3), np.nan)
        world[open_] = alone.carry(_centre(bodies[child]))
        helpers.append(Neighbour(joints[child].fit.centre, world, bodies[child].centre_noise))
    return tuple(helpers)


def _centre(body: Body) -> Array:
    return np.full(3, np.nan) if body.centre is None else body.centre
