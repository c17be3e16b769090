"""Rigs of other programs: read, and given back with a motion on them."""

import base64
import json
import struct
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.data import Motion
from kinesphere.errors import BadModel, KinesphereError, UnknownFormat, UnreadableFile
from kinesphere.io import read_bvh, read_rig, write_bvh, write_on_rig

PRINTED = 2e-6  # m
FLOAT32 = 1e-6  # m


def any_motion(skeleton, rng, n=20):
    """Return poses at random of a skeleton whose joints hold."""
    parents = skeleton.parents
    rotations = np.empty((n, len(parents), 3, 3))
    origins = np.empty((n, len(parents), 3))
    for i, p in enumerate(parents):
        turn = Rotation.from_rotvec(rng.normal(size=3) * np.linspace(0, 2, n)[:, None]).as_matrix()
        if p < 0:
            rotations[:, i], origins[:, i] = (
                turn,
                rng.normal(size=3) * np.linspace(0, 1, n)[:, None],
            )
            continue
        joint = skeleton.joints[i - 1]
        rotations[:, i] = rotations[:, p] @ turn
        origins[:, i] = origins[:, p] + rotations[:, p] @ joint.centre_in_parent
    nothing = np.full((n, len(parents)), np.nan)
    return Motion(skeleton, rotations, origins, nothing, np.ones(nothing.shape), 50.0)


def test_a_bvh_rig_comes_back_to_the_letter(performance, tmp_path, rng):
    rig = tmp_path / "rig.bvh"
    write_bvh(performance.motion, rig, rest="t-pose", channels="zxy", unit="m")
    motion = any_motion(read_rig(rig), rng)
    assert write_on_rig(motion, rig, tmp_path / "out.bvh") == ()
    before, after = ((tmp_path / n).read_text(encoding="utf-8") for n in ("rig.bvh", "out.bvh"))
    assert before.partition("MOTION")[0] == after.partition("MOTION")[0]
    back = read_bvh(tmp_path / "out.bvh", unit="m")
    assert back.rate == 50.0
    assert_allclose(back.origins, motion.origins, atol=PRINTED)
    assert_allclose(back.rotations, motion.rotations, atol=1e-7)


def test_a_bvh_rig_needs_no_motion_of_its_own(performance, tmp_path, rng):
    write_bvh(performance.motion, tmp_path / "a.bvh", unit="m")
    head = (tmp_path / "a.bvh").read_text(encoding="utf-8").partition("MOTION")[0]
    for end in ("", "MOTION\nFrames: 0\nFrame Time: 0.01\n"):
        (tmp_path / "rig.bvh").write_text(head + end, encoding="utf-8")
        motion = any_motion(read_rig(tmp_path / "rig.bvh"), rng)
        write_on_rig(motion, tmp_path / "rig.bvh", tmp_path / "out.bvh")
        back = read_bvh(tmp_path / "out.bvh", unit="m")
        assert_allclose(back.origins, motion.origins, atol=PRINTED)


def test_channels_that_cannot_hold_a_turn_are_named(performance, tmp_path, rng):
    write_bvh(performance.motion, tmp_path / "a.bvh", unit="m")
    text = (tmp_path / "a.bvh").read_text(encoding="utf-8").partition("MOTION")[0]
    text = text.replace("CHANNELS 3 Zrotation Yrotation Xrotation", "CHANNELS 1 Xrotation", 1)
    (tmp_path / "rig.bvh").write_text(text, encoding="utf-8")
    motion = any_motion(read_rig(tmp_path / "rig.bvh"), rng)
    (said,) = write_on_rig(motion, tmp_path / "rig.bvh", tmp_path / "out.bvh")
    assert said == f"{motion.skeleton.limb_names[1]} turns about X alone"


def test_a_motion_of_another_skeleton_is_refused(performance, tmp_path):
    write_bvh(performance.motion, tmp_path / "a.bvh")
    write_bvh(performance.motion, tmp_path / "b.bvh", names="unity")
    motion = read_bvh(tmp_path / "b.bvh")
    with pytest.raises(BadModel, match="not on the skeleton"):
        write_on_rig(motion, tmp_path / "a.bvh", tmp_path / "out.bvh")


NODES = [
    {"name": "Scene", "children": [1, 6], "scale": [0.01, 0.01, 0.01], "translation": [1, 2, 3]},
    {
        "name": "Hips",
        "children": [2, 3],
        "translation": [0, 100, 5],
        "rotation": list(Rotation.from_euler("xyz", [10, 20, 30], degrees=True).as_quat()),
    },
    {"name": "Leg", "children": [4], "translation": [10, -5, 0]},
    {"name": "Arm", "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, -10, 5, 2, 1]},
    {"children": [5], "translation": [0, -40, 0], "rotation": [0.6, 0, 0, 0.8]},
    {"name": "Foot", "translation": [0, -45, 1]},
    {"name": "Mesh", "mesh": 0, "skin": 0},
]


def document(**changes):
    """Return a glTF document with a skeleton and all that should survive."""
    told = {
        "asset": {"version": "2.0", "generator": "by hand"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": NODES,
        "skins": [{"joints": [5, 1, 2, 3, 4]}],
        "meshes": [{"primitives": [{"attributes": {}}], "extras": {"kept": True}}],
        "extensionsUsed": ["VENDOR_odd"],
        "animations": [{"name": "old", "samplers": [], "channels": []}],
    }
    return json.loads(json.dumps({**told, **changes}))


def put_glb(path, told, binary=b"\1\2\3\4"):
    told = {**told, "buffers": [{"byteLength": len(binary)}]} if binary else told
    text = json.dumps(told).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    if binary:
        chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
    return path


def parsed(path):
    """Return the document and a function that gives an accessor's numbers."""
    raw = path.read_bytes()
    if path.suffix == ".gltf":
        told = json.loads(raw)
        buffers = [base64.b64decode(b["uri"].partition(",")[2]) for b in told["buffers"]]
    else:
        assert struct.unpack_from("<I", raw, 8)[0] == len(raw)
        size = struct.unpack_from("<I", raw, 12)[0]
        told = json.loads(raw[20 : 20 + size])
        buffers = [raw[28 + size :]]
        assert told["buffers"][0]["byteLength"] <= len(buffers[0])

    def numbers(accessor):
        one = told["accessors"][accessor]
        view = told["bufferViews"][one["bufferView"]]
        assert view["byteOffset"] % 4 == 0
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[one["type"]]
        raw = buffers[view["buffer"]][view["byteOffset"] :][: view["byteLength"]]
        return np.frombuffer(raw, "<f4").reshape(one["count"], width).astype(float)

    return told, numbers


def played(path):
    """Return node → places (n, 3) and turns (n, 3, 3) in the world, by the specification alone."""
    told, numbers = parsed(path)
    animation = told["animations"][0]
    moved = {}
    for channel in animation["channels"]:
        sampler = animation["samplers"][channel["sampler"]]
        times = numbers(sampler["input"])
        target = channel["target"]
        moved[target["node"], target["path"]] = numbers(sampler["output"])
        assert len(times) == len(moved[target["node"], target["path"]])
    n, found = len(times), {}

    def walk(node, above):
        one = told["nodes"][node]
        local = np.tile(np.eye(4), (n, 1, 1))
        if "matrix" in one:
            local[:] = np.reshape(one["matrix"], (4, 4)).T
        else:
            turn = moved.get((node, "rotation"), np.tile(one.get("rotation", [0, 0, 0, 1]), (n, 1)))
            local[:, :3, :3] = Rotation.from_quat(turn).as_matrix() * one.get("scale", [1, 1, 1])
            local[:, :3, 3] = moved.get((node, "translation"), one.get("translation", [0, 0, 0]))
        world = above @ local
        size = np.cbrt(np.linalg.det(world[:, :3, :3]))[:, None, None]
        found[node] = world[:, :3, 3], world[:, :3, :3] / size
        for child in one.get("children", []):
            walk(child, world)

    for node in told["scenes"][0]["nodes"]:
        walk(node, np.tile(np.eye(4), (n, 1, 1)))
    return found, times[:, 0]


@pytest.mark.parametrize("suffix", [".glb", ".gltf"])
def test_a_gltf_rig_plays_the_motion(tmp_path, rng, suffix):
    rig, out = tmp_path / f"rig{suffix}", tmp_path / f"out{suffix}"
    if suffix == ".glb":
        put_glb(rig, document())
    else:
        rig.write_text(json.dumps(document()), encoding="utf-8")
    skeleton = read_rig(rig)
    assert skeleton.limb_names == ("Hips", "Leg", "joint_2", "Foot", "Arm")
    motion = any_motion(skeleton, rng)
    assert write_on_rig(motion, rig, out) == ()
    found, times = played(out)
    assert_allclose(times, motion.times, atol=1e-6)
    order = [1, 2, 4, 5, 3]
    still, _ = played(with_rest(rig, tmp_path / f"rest{suffix}", skeleton))
    for i, node in enumerate(order):
        places, turns = found[node]
        assert_allclose(places, motion.origins[:, i], atol=FLOAT32)
        # from the rest pose a node turns as its limb does from standing parallel to the body
        rest_turn = still[node][1][0]
        body = np.array([[0, 0, -1], [0, 1, 0], [1, 0, 0.0]])
        assert_allclose(turns, motion.rotations[:, i] @ body.T @ rest_turn, atol=1e-5)
    told, numbers = parsed(out)
    for sampler in told["animations"][0]["samplers"][1:]:
        turns = numbers(sampler["output"])
        assert ((turns[1:] * turns[:-1]).sum(axis=1) > 0).all(), "the shorter way round"
    for key in ("asset", "scene", "scenes", "skins", "meshes", "extensionsUsed"):
        assert told[key] == document()[key]
    assert [a["name"] for a in told["animations"]] == ["kinesphere", "old"]
    if suffix == ".glb":
        assert out.read_bytes().count(b"\1\2\3\4") >= 1


def with_rest(rig, path, skeleton):
    """Write a rig that stands in its rest pose."""
    body = np.array([[0, 0, -1], [0, 1, 0], [1, 0, 0.0]])
    joints = len(skeleton.limbs)
    rotations = np.tile(body, (1, joints, 1, 1))
    origins = np.zeros((1, joints, 3))
    for i, p in enumerate(skeleton.parents):
        if p >= 0:
            origins[:, i] = origins[:, p] + body @ skeleton.joints[i - 1].centre_in_parent
    motion = Motion(skeleton, rotations, origins, np.zeros((1, joints)), np.ones((1, joints)), 1.0)
    write_on_rig(motion, rig, path)
    return path


def test_standing_at_rest_leaves_the_nodes_where_they_were(tmp_path):
    rig = put_glb(tmp_path / "rig.glb", document())
    found, _ = played(with_rest(rig, tmp_path / "out.glb", read_rig(rig)))
    expected = np.eye(4)
    expected[:3, :3] *= 0.01
    expected[:3, 3] = 1, 2, 3
    hips = np.eye(4)
    hips[:3, :3] = Rotation.from_quat(NODES[1]["rotation"]).as_matrix()
    at_hips = expected @ np.array([0, 100, 5, 1])
    leg = expected[:3, :3] @ hips[:3, :3] @ [10, -5, 0]
    assert_allclose(found[2][0][0] - found[1][0][0], leg, atol=FLOAT32)
    assert_allclose(found[1][1][0], hips[:3, :3], atol=1e-6)
    assert at_hips.shape == (4,)


@pytest.mark.parametrize("animated", [True, False])
def test_a_skeleton_needs_no_skin(tmp_path, animated):
    joints = (1, 2, 3, 4, 5)
    channels = [{"sampler": 0, "target": {"node": n, "path": "rotation"}} for n in joints]
    told = document(skins=[], animations=[{"samplers": [], "channels": channels * animated}])
    names = read_rig(put_glb(tmp_path / "rig.glb", told)).limb_names
    own = ("Hips", "Leg", "joint_2", "Foot", "Arm")
    assert names == own if animated else names[0] == "Scene"


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"skins": [], "nodes": [{"mesh": 0}], "scenes": []}, "no skin"),
        ({"skins": [{"joints": [99]}]}, "damaged"),
        ({"skins": [{}]}, "damaged"),
        ({"nodes": [{"children": [0]}], "skins": [{"joints": [0]}]}, "in a circle"),
        ({"nodes": [{"scale": [0, 0, 0]}], "skins": [{"joints": [0]}]}, "no size"),
        ({"nodes": [{}, {}], "skins": [{"joints": [0, 1]}]}, "nothing they share"),
        ({"asset": {"version": "1.0"}}, "version '1.0'"),
        ({"asset": None}, "version None"),
    ],
)
def test_gltf_damage_is_named(tmp_path, changes, said):
    with pytest.raises(UnreadableFile, match=said):
        read_rig(put_glb(tmp_path / "rig.glb", document(**changes)))


def test_any_damage_is_an_error_of_ours(tmp_path, rng):
    raw = put_glb(tmp_path / "rig.glb", document()).read_bytes()
    refused = 0
    for _ in range(200):
        spoilt = bytearray(raw)
        for at in rng.integers(0, len(raw), rng.integers(1, 6)):
            spoilt[at] = rng.integers(0, 256)
        (tmp_path / "b.glb").write_bytes(bytes(spoilt))
        try:
            read_rig(tmp_path / "b.glb")
        except KinesphereError:
            refused += 1
    assert refused > 50


def test_what_is_no_rig_is_refused(tmp_path):
    (tmp_path / "a.txt").write_text("hello", encoding="utf-8")
    with pytest.raises(UnknownFormat, match=r"BVH, \.glb or \.gltf"):
        read_rig(tmp_path / "a.txt")


def test_gaps_are_refused(tmp_path, rng):
    rig = put_glb(tmp_path / "rig.glb", document())
    motion = any_motion(read_rig(rig), rng)
    origins = motion.origins.copy()
    origins[3] = np.nan
    with pytest.raises(BadModel, match="gaps"):
        write_on_rig(replace(motion, origins=origins), rig, tmp_path / "out.glb")
