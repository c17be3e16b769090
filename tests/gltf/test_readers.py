"""motion.glb in the hands of others: Khronos' validator, and three.js in a browser."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere import attach_surface, read, skin, solve
from kinesphere.data import Motion, PoseFlag, motion_from_parameters
from kinesphere.io.gltf import write_gltf
from kinesphere.synthetic import make_performance

NEAR = 1e-4  # m


@pytest.fixture
def performance(rng):
    """Return an actor of three seconds at 25 Hz, whose markers come and go."""
    made = make_performance(rng, rate=25.0, calibration_s=2.0, free_s=1.0)
    markers = made.recording.markers.copy()
    markers[20:30, 4] = np.nan
    return replace(made, recording=replace(made.recording, markers=markers))


def gappy(motion):
    """Return the motion with an arm that is not seen for a while, nor the root at the start."""
    rotations, origins, flags = (
        np.array(array) for array in (motion.rotations, motion.origins, motion.flags)
    )
    for frames, limb in ((slice(0, 5), 0), (slice(30, 40), 3)):
        rotations[frames, limb], origins[frames, limb] = np.nan, np.nan
        flags[frames, limb] = PoseFlag.UNSEEN
    return replace(motion, rotations=rotations, origins=origins, flags=flags)


def agrees(page, motion, surface, markers, frames):
    """Compare joints, skinned vertices and markers in three.js with ours."""
    names = list(motion.skeleton.limb_names)
    vertices = np.arange(0, surface.n_vertices, 97)
    ours = skin(surface, motion, frames=np.asarray(frames), blend="twist-joints")[:, vertices]
    joints = [joint.centre_in_child for joint in motion.skeleton.joints]
    labels = list(markers.labels)
    for k, frame in enumerate(frames):
        found = page.evaluate(
            "([time, nodes, vertices]) => places(time, nodes, vertices)",
            [frame / motion.rate, [*names, *labels], vertices.tolist()],
        )
        assert_allclose(found["vertices"], ours[k], atol=NEAR)
        nodes = np.array(found["nodes"])
        rotations, origins = motion.rotations[frame, 1:], motion.origins[frame, 1:]
        centres = (rotations @ np.array(joints)[:, :, None])[..., 0] + origins
        seen = np.isfinite(centres).all(axis=1)
        assert_allclose(nodes[1 : len(names), :3][seen], centres[seen], atol=NEAR)
        shown = nodes[len(names) :]
        there = np.isfinite(markers.markers[frame]).all(axis=1)
        assert_allclose(shown[there, :3], markers.markers[frame][there], atol=NEAR)
        assert_array_equal(shown[:, 3] > 0.5, there)  # an unseen marker has no size


def test_an_actor_opens_as_it_moves(performance, tmp_path, issues_of, in_three):
    motion = gappy(motion_from_parameters(performance.parameters))
    surface = attach_surface(motion)
    path = tmp_path / "motion.glb"
    write_gltf(motion, path, surface, performance.recording)
    issues = issues_of(path)
    assert issues["numErrors"] == issues["numWarnings"] == 0, issues["messages"]
    agrees(in_three(path), motion, surface, performance.recording, [0, 25, 35, 74])


@pytest.mark.parametrize("suffix", [".glb", ".gltf"])
@pytest.mark.parametrize("frames", [0, 1, 3])
def test_short_motions_without_a_body_are_valid(performance, tmp_path, issues_of, suffix, frames):
    whole = motion_from_parameters(performance.parameters)
    short = Motion(
        whole.skeleton,
        *(getattr(whole, name)[:frames] for name in ("rotations", "origins", "residuals", "flags")),
        rate=whole.rate,
    )
    path = tmp_path / f"short{suffix}"
    write_gltf(short, path)
    assert issues_of(path)["numErrors"] == 0, issues_of(path)["messages"]


@pytest.mark.real
@pytest.mark.parametrize("name", ["06_01", "85_02"])
def test_real_recordings_open_as_they_were_solved(recordings, name, tmp_path, issues_of, in_three):
    solution = solve(read(recordings / f"cmu41/{name}.c3d"))
    path = tmp_path / "motion.glb"
    write_gltf(solution.motion, path, solution.surface, solution.recording)
    assert issues_of(path)["numErrors"] == 0
    page = in_three(path)
    agrees(page, solution.motion, solution.surface, solution.recording, [0, 111, 222, 400])
