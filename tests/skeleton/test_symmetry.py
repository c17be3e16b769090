"""Two hips have their say about each other."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.data import JointModel, Recording, Segment, TopologicalModel
from kinesphere.geometry.centres import with_expectation
from kinesphere.geometry.rotations import rotation_exp
from kinesphere.skeleton import chain, fit_skeleton
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.measured import MeasuredJoint
from kinesphere.skeleton.settings import SkeletonSettings
from kinesphere.skeleton.symmetry import evened, mirror_plane

PELVIS = {
    "LA": (0.10, 0.02, -0.12), "RA": (0.10, 0.02, 0.12),
    "LP": (-0.09, 0.03, -0.05), "RP": (-0.09, 0.03, 0.05),
}  # fmt: skip
LEFT, RIGHT = np.array([0.01, -0.10, -0.09]), np.array([0.01, -0.10, 0.09])
SPREAD = 0.007


def model(mirror=(("LA", "RA"), ("LP", "RP"))):
    segments = (
        Segment("pelvis", tuple(PELVIS)),
        Segment("left_thigh", ("L1",)),
        Segment("right_thigh", ("R1",)),
    )
    joints = tuple(JointModel(f"{s}_hip", "pelvis", f"{s}_thigh") for s in ("left", "right"))
    return TopologicalModel("hips", segments, joints, "pelvis", mirror=mirror)


def pelvis():
    shape = np.array(list(PELVIS.values()))
    return Body("pelvis", None, tuple(PELVIS), shape, np.full(len(shape), 0.001))


def hips(left, right, known=(1e6, 1e6)):
    tree = model()
    fits = [
        with_expectation(np.asarray(c), k * np.eye(3), 0.05, 0.001, 20)
        for c, k in zip((left, right), known, strict=True)
    ]
    return {
        joint.child: MeasuredJoint(joint, fit, fit.centre, 0.05, "")
        for joint, fit in zip(tree.joints, fits, strict=True)
    }


def test_even_hips_stay():
    found = evened(hips(LEFT, RIGHT), pelvis(), model(), SPREAD)
    assert_allclose(found["left_thigh"].centre, LEFT, atol=1e-12)
    assert_allclose(found["right_thigh"].centre, RIGHT, atol=1e-12)


def test_the_better_known_hip_draws_the_other():
    off = np.array([0.02, 0.0, 0.01])
    found = evened(hips(LEFT, RIGHT + off, known=(1e8, 1e2)), pelvis(), model(), SPREAD)
    assert np.linalg.norm(found["left_thigh"].centre - LEFT) < 1e-4
    left_over = np.linalg.norm(found["right_thigh"].centre - RIGHT) / np.linalg.norm(off)
    assert left_over < 0.05


def test_sides_known_for_certain_may_differ():
    off = np.array([0.0, 0.015, 0.0])
    found = evened(hips(LEFT, RIGHT + off, known=(1e12, 1e12)), pelvis(), model(), SPREAD)
    assert_allclose(found["right_thigh"].centre, RIGHT + off, atol=1e-6)


def test_what_both_say_is_surer():
    joints = hips(LEFT, RIGHT, known=(1e4, 1e4))
    found = evened(joints, pelvis(), model(), SPREAD)["left_thigh"]
    before = joints["left_thigh"].fit
    assert np.trace(found.covariance) < np.trace(before.covariance)
    assert_allclose(found.data_covariance, before.data_covariance)


@pytest.mark.parametrize("mirror", [(), (("LA", "RA"),)])
def test_one_pair_tells_no_plane(mirror):
    assert mirror_plane(pelvis(), model(mirror)) is None
    assert evened(hips(LEFT, RIGHT), pelvis(), model(mirror), SPREAD) == {}


def test_one_hip_alone_is_left():
    joints = hips(LEFT, RIGHT)
    del joints["right_thigh"]
    assert evened(joints, pelvis(), model(), SPREAD) == {}


def test_no_joint_is_measured_twice_for_it(rng, monkeypatch):
    places = [np.array(place) for place in PELVIS.values()]
    markers = [np.tile(place, (300, 1)) for place in places]
    tree = model()
    for centre in (LEFT, RIGHT):
        turns = rotation_exp(0.5 * np.cumsum(rng.normal(size=(300, 3)), axis=0) / 17)
        skin = 0.005 * rng.normal(size=(300, 3))
        markers.append(centre + turns @ np.array([0.02, -0.3, 0.0]) + skin)
    labels = (*PELVIS, "L1", "R1")
    recording = Recording(markers=np.stack(markers, axis=1), labels=labels, rate=100.0)
    measured, find = [], chain.find_joint

    def counted(joint, *arguments):
        measured.append(joint.name)
        return find(joint, *arguments)

    monkeypatch.setattr(chain, "find_joint", counted)
    even = fit_skeleton(recording, tree, SkeletonSettings(even_hips_mm=7.0)).skeleton
    assert measured == ["left_hip", "right_hip"]
    apart = fit_skeleton(recording, tree).skeleton
    for hip in measured[:2]:
        assert (even.joint(hip).centre_in_parent != apart.joint(hip).centre_in_parent).any()
