"""What a glTF file says, read with nothing but struct and json; others read it in tests/gltf."""

import json
import struct

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.data import TwistJoints, default_origins, motion_from_parameters, pivots
from kinesphere.editing import attach_surface
from kinesphere.errors import BadSurface
from kinesphere.io.gltf import write_gltf
from kinesphere.io.gltf.poses import continuous

FLOAT32 = 2e-6  # m


def parts(path):
    raw = path.read_bytes()
    magic, version, length = struct.unpack_from("<III", raw)
    assert (magic, version, length) == (0x46546C67, 2, len(raw))
    size, kind = struct.unpack_from("<II", raw, 12)
    assert kind == 0x4E4F534A
    return json.loads(raw[20 : 20 + size]), raw[20 + size + 8 :]


def accessor(tree, binary, index):
    of = tree["accessors"][index]
    view = tree["bufferViews"][of["bufferView"]]
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[of["type"]]
    kind = {5126: np.float32, 5123: np.uint16, 5121: np.uint8}[of["componentType"]]
    flat = np.frombuffer(binary, kind, of["count"] * width, view["byteOffset"])
    return flat.reshape(of["count"], width)


@pytest.fixture
def motion(performance):
    return motion_from_parameters(performance.parameters)


def test_the_rest_pose_stands_and_looks_along_z(motion, tmp_path):
    surface = attach_surface(motion)
    write_gltf(motion, tmp_path / "a.glb", surface)
    tree, binary = parts(tmp_path / "a.glb")
    nodes = {node["name"]: node for node in tree["nodes"]}
    assert "rotation" not in nodes["head"]  # all limbs turned as the root is
    x, y, z, w = nodes["trunk"]["rotation"]
    assert_allclose([x, y, z, w], [0, -np.sqrt(0.5), 0, np.sqrt(0.5)], atol=1e-6)
    front = np.array([1 - 2 * (y * y + z * z), 0, 2 * (x * z - y * w)])  # of the body's x
    assert_allclose(front, [0, 0, 1], atol=1e-6)
    ground = surface.vertices[:, 1].min() + nodes["trunk"]["translation"][1]
    assert_allclose(ground, pivots(motion.skeleton)[0][1], atol=FLOAT32)
    joints = tree["skins"][0]["joints"]
    names = [tree["nodes"][j]["name"] for j in joints]
    assert names == [*surface.limbs, *TwistJoints(surface).names]
    back = accessor(tree, binary, tree["skins"][0]["inverseBindMatrices"]).reshape(-1, 4, 4)
    places = default_origins(motion.skeleton) + pivots(motion.skeleton)
    places = np.vstack([places, places[TwistJoints(surface).limbs]])
    assert_allclose(back[:, 3, :3], -places, atol=FLOAT32)


def test_conventions_are_said(motion, tmp_path):
    write_gltf(motion, tmp_path / "a.glb")
    asset = parts(tmp_path / "a.glb")[0]["asset"]
    assert asset["version"] == "2.0"
    assert asset["extras"]["length"] == "m"
    assert asset["extras"]["rate_hz"] == motion.rate
    assert "y up" in asset["extras"]["world"]


def test_times_and_quaternions_go_on_without_jumps(motion, tmp_path):
    write_gltf(motion, tmp_path / "a.glb")
    tree, binary = parts(tmp_path / "a.glb")
    animation = tree["animations"][0]
    for channel in animation["channels"]:
        sampler = animation["samplers"][channel["sampler"]]
        times = accessor(tree, binary, sampler["input"])[:, 0]
        assert_allclose(times, np.arange(motion.n_frames) / motion.rate, rtol=1e-6)
        values = accessor(tree, binary, sampler["output"])
        if channel["target"]["path"] == "rotation":
            assert_allclose(np.linalg.norm(values, axis=1), 1, atol=1e-6)
            assert ((values[1:] * values[:-1]).sum(axis=1) > 0).all()


def test_a_quaternion_and_its_negative_are_one_turn():
    turns = np.array([[0, 0, 0, 1.0], [0, 0, 0, -1], [0, 0.6, 0, -0.8], [0, 1, 0, 0]])
    assert_array_equal(
        continuous(turns), [[0, 0, 0, 1], [0, 0, 0, 1], [0, -0.6, 0, 0.8], [0, -1, 0, 0]]
    )


def test_joints_that_hold_are_not_moved(motion, tmp_path):
    """Rebuilt from parameters no joint comes apart: only the root has places."""
    write_gltf(motion, tmp_path / "a.glb")
    tree, _ = parts(tmp_path / "a.glb")
    paths = [c["target"]["path"] for c in tree["animations"][0]["channels"]]
    assert paths.count("rotation") == len(motion.skeleton.limbs)
    assert paths.count("translation") == 1


def test_nodes_that_spread_twist_hang_from_their_limbs(motion, tmp_path):
    surface = attach_surface(motion)
    write_gltf(motion, tmp_path / "a.glb", surface)
    tree, binary = parts(tmp_path / "a.glb")
    nodes = tree["nodes"]
    parents = {c: node["name"] for node in nodes for c in node.get("children", [])}
    extra = [i for i, node in enumerate(nodes) if "_twist_" in node["name"]]
    assert len(extra) == 4 * 6  # upper arms, forearms, thighs
    assert {parents[i] for i in extra} == {nodes[i]["name"].partition("_twist")[0] for i in extra}
    moved = {c["target"]["node"]: c["target"]["path"] for c in tree["animations"][0]["channels"]}
    assert {moved[i] for i in extra} == {"rotation"}
    primitive = tree["meshes"][0]["primitives"][0]["attributes"]
    shares = accessor(tree, binary, primitive["WEIGHTS_0"])
    assert_allclose(shares.sum(axis=1), 1, atol=FLOAT32)
    carried = accessor(tree, binary, primitive["JOINTS_0"])[shares > 0.5]
    assert np.isin(extra, carried).any()


def test_a_surface_of_others_is_refused(motion, tmp_path):
    surface = attach_surface(motion)
    fewer = type(motion)(
        type(motion.skeleton)(motion.skeleton.limbs[:1], ()),
        motion.rotations[:, :1],
        motion.origins[:, :1],
        motion.residuals[:, :1],
        motion.flags[:, :1],
        rate=motion.rate,
    )
    with pytest.raises(BadSurface, match="the motion has trunk"):
        write_gltf(fewer, tmp_path / "a.glb", surface)
    assert not (tmp_path / "a.glb").exists()


def test_text_and_binary_hold_the_same(motion, tmp_path):
    write_gltf(motion, tmp_path / "a.glb")
    write_gltf(motion, tmp_path / "a.gltf")
    binary, _ = parts(tmp_path / "a.glb")
    text = json.loads((tmp_path / "a.gltf").read_text())
    uri = text["buffers"][0].pop("uri")
    assert uri.startswith("data:application/octet-stream;base64,")
    assert text == binary
