"""Whether limbs fitted together are known better than limb by limb: halves of the time tell."""

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.centres import CentreFit
from kinesphere.geometry.rigid import into_frame, out_of_frame
from kinesphere.geometry.vectors import is_seen
from kinesphere.skeleton.averages import median_seen
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.limb_body import measure_limb
from kinesphere.skeleton.limb_joint import find_joint
from kinesphere.skeleton.linked import find_groups, fit_group
from kinesphere.skeleton.linked_joint import LinkedJoint
from kinesphere.skeleton.measured import MeasuredJoint
from kinesphere.skeleton.settings import SkeletonSettings
from kinesphere.skeleton.tree import Tree

WORSE = 2.07
"""Times farther apart than limb by limb that halves may have a group's centres, fitted together.

Of two joints, chance goes beyond it once in twenty times where both ways are as good (F of 6, 6);
where the truth is known, together is better by far."""

Group = tuple[str, ...]


def check_links(
    tree: Tree,
    bodies: dict[str, Body],
    joints: dict[str, MeasuredJoint],
    linked: Mapping[str, LinkedJoint],
    sample: dict[str, Array],
    settings: SkeletonSettings,
) -> tuple[dict[str, LinkedJoint], dict[str, float]]:
    """Leave out groups that are measured limb by limb as well or better.

    Both ways are gone on each half of the time. Limbs stay apart where a half has linked joints
    stray, or where halves have them farther apart than limb by limb by `WORSE`. A half that moves
    too little to tell them says nothing.

    Parameters
    ----------
    linked
        Child limb → its joint as `kinesphere.skeleton.linked.fit_linked` gives it.

    Returns
    -------
    linked : those of the groups that stay
    apart : child limb → m, how far apart the halves have its joint, in the way that is gone
    """
    kept: dict[str, LinkedJoint] = {}
    apart: dict[str, float] = {}
    middle = len(next(iter(sample.values()))) // 2
    for group in find_groups(tree, bodies):
        if not all(limb in linked for limb in group[1:]):
            continue
        halves = [
            _half(group, tree, bodies, joints, sample, settings, part)
            for part in (slice(middle), slice(middle, None))
        ]
        alone, together = np.linalg.norm(halves[1].centres - halves[0].centres, axis=2)
        worse = np.linalg.norm(together) > WORSE * np.linalg.norm(alone)  # silent ones are not
        if worse or any(half.strays for half in halves):
            together = alone
        else:
            kept |= {limb: linked[limb] for limb in group[1:]}
        told = zip(group[1:], np.where(np.isfinite(together), together, alone), strict=True)
        apart |= {limb: float(off) for limb, off in told if np.isfinite(off)}
    return kept, apart


def no_surer_than(fit: CentreFit, apart: float) -> CentreFit:
    """Return a centre as unsure at least as each of two halves that are so far, in m, apart."""
    return replace(
        fit,
        covariance=_widened(fit.covariance, apart),
        data_covariance=_widened(fit.data_covariance, apart),
    )


def _widened(covariance: Array, apart: float) -> Array:
    missing: float = max(apart**2 / 2 - float(np.trace(covariance)), 0.0)
    return covariance + missing / 3 * np.eye(3)


class _Half(NamedTuple):
    centres: Array
    """(2, n_joints, 3) m, limb by limb and fitted together; NaN where that is not told."""
    strays: bool
    """Whether fitted together they are where no joint can be."""


def _half(
    group: Group,
    tree: Tree,
    bodies: dict[str, Body],
    joints: dict[str, MeasuredJoint],
    sample: dict[str, Array],
    settings: SkeletonSettings,
    part: slice,
) -> _Half:
    """Return the joints of a group by a part of the sample.

    They are in the limb beside that has a pose of its own, as it is in the whole sample.
    """
    some = {label: markers[part] for label, markers in sample.items()}
    limbs, found = {group[0]: _part_of(bodies[group[0]], part)}, {}
    for limb in group[1:]:
        model = joints[limb].model
        joint = find_joint(model, limbs[model.parent], tree.markers[limb], some, settings)
        found[limb] = joint.measured
        limbs[limb] = measure_limb(joint, limbs[model.parent], tree, some, settings, {})
    fit = fit_group(group, limbs, found, some, settings)
    centres = np.full((2, len(group) - 1, 3), np.nan)
    for i, (limb, measured) in enumerate(found.items()):
        parent = limbs[measured.model.parent]
        alone = out_of_frame(parent.rotations, parent.shifts, measured.fit.centre[None])[:, 0]
        by = _part_of(bodies[group[0] if parent.name == group[0] else limb], part)
        centres[0, i] = _usual(by, alone)
        if fit is not None and fit.firm:
            centres[1, i] = _usual(by, fit.joints[limb].world)
    return _Half(centres, fit is not None and fit.strays)


def _part_of(body: Body, part: slice) -> Body:
    return replace(body, rotations=body.rotations[part], shifts=body.shifts[part])


def _usual(body: Body, world: Array) -> Array:
    """Return where a limb usually sees a point, (3,) m; NaN where it never does."""
    local = into_frame(body.rotations, body.shifts, world[:, None])[:, 0]
    return median_seen(local) if is_seen(local).any() else np.full(3, np.nan)
