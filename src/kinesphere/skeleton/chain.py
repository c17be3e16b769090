"""Limbs and joint centres measured from the root outward, on a sample of the frames."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from kinesphere.data import Array, JointModel, TopologicalModel
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.limb_axes import find_axes
from kinesphere.skeleton.limb_body import measure_limb, measure_root
from kinesphere.skeleton.limb_joint import FoundJoint, find_joint
from kinesphere.skeleton.link_worth import check_links, no_surer_than
from kinesphere.skeleton.linked import fit_linked
from kinesphere.skeleton.linked_joint import LinkedJoint
from kinesphere.skeleton.measured import MeasuredJoint
from kinesphere.skeleton.settings import SkeletonSettings
from kinesphere.skeleton.symmetry import evened
from kinesphere.skeleton.tree import Tree


def measure_chain(
    tree: Tree, model: TopologicalModel, sample: dict[str, Array], settings: SkeletonSettings
) -> tuple[dict[str, Body], dict[str, MeasuredJoint]]:
    """Measure every limb's shape and joint centre.

    Parameters
    ----------
    sample
        Label → (n_sample, 3) m, every marker of the recording in the sampled frames.

    Returns
    -------
    bodies : limb → Body, root first
    joints : child limb → MeasuredJoint

    Raises
    ------
    DegenerateMotion
        If the root's markers never show an orientation.
    """
    root = measure_root(tree, sample, settings)
    find_axes(root, None, tree, model, sample, settings)
    bodies, joints = _measure_outward({tree.root: root}, {}, tree, model, sample, settings, {})
    if not settings.link_limbs:
        return bodies, joints
    linked = fit_linked(tree, bodies, joints, sample, settings)
    if linked:
        kept, apart = check_links(tree, bodies, joints, linked, sample, settings)
        if kept:
            bodies, joints = _measure_outward(bodies, joints, tree, model, sample, settings, kept)
        for limb, off in apart.items():
            joints[limb] = replace(joints[limb], fit=no_surer_than(joints[limb].fit, off))
    return bodies, joints


def _measure_outward(
    bodies_before: Mapping[str, Body],
    joints_before: Mapping[str, MeasuredJoint],
    tree: Tree,
    model: TopologicalModel,
    sample: dict[str, Array],
    settings: SkeletonSettings,
    linked: Mapping[str, LinkedJoint],
) -> tuple[dict[str, Body], dict[str, MeasuredJoint]]:
    """Measure limb by limb from the root, which is known.

    Joints that groups of limbs told are as those say; what hangs from none of them stays as it was
    before, if it was measured.
    """
    joints: dict[str, MeasuredJoint] = {}
    found: dict[str, FoundJoint] = {}
    bodies = {tree.root: bodies_before[tree.root]}

    def stays(joint: JointModel) -> bool:
        same = bodies[joint.parent] is bodies_before.get(joint.parent)
        return same and joint.child in joints_before and joint.child not in linked

    for joint in tree.joints:
        parent, limb = bodies[joint.parent], joint.child
        if stays(joint):
            bodies[limb], joints[limb] = bodies_before[limb], joints_before[limb]
            continue
        if limb not in found:
            beside = [one for one in tree.joints if one.parent == parent.name and not stays(one)]
            found |= _find_joints(beside, parent, tree, model, sample, settings, linked)
        joints[limb] = found[limb].measured
        bodies[limb] = measure_limb(found[limb], parent, tree, sample, settings, linked)
        find_axes(bodies[limb], parent, tree, model, sample, settings)
    return bodies, joints


def _find_joints(
    beside: Sequence[JointModel],
    parent: Body,
    tree: Tree,
    model: TopologicalModel,
    sample: dict[str, Array],
    settings: SkeletonSettings,
    linked: Mapping[str, LinkedJoint],
) -> dict[str, FoundJoint]:
    """Return a limb's joints towards limbs beyond; two hips have their say about each other.

    Before what hangs from them is measured, or that would have to be measured twice.
    """
    found = {
        joint.child: find_joint(
            joint, parent, tree.markers[joint.child], sample, settings, linked.get(joint.child)
        )
        for joint in beside
    }
    if settings.even_hips_mm:
        alone = {limb: one.measured for limb, one in found.items() if limb not in linked}
        for limb, fit in evened(alone, parent, model, settings.even_hips_mm * 1e-3).items():
            found[limb] = found[limb]._replace(measured=replace(alone[limb], fit=fit))
    return found
