"""Meshes out of files, rigged or not, whole or spoilt."""

import json
import struct

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.data import Surface, bundled_body, motion_from_parameters
from kinesphere.editing import attach_surface
from kinesphere.errors import BadSurface, UnreadableFile
from kinesphere.io import read
from kinesphere.io.gltf import write_gltf
from kinesphere.io.meshes.cleaning import MOST_FACES, cleaned

trimesh = pytest.importorskip("trimesh")
FLOAT32 = 1e-6  # m
MIXAMO = {
    "trunk": "mixamorig:Hips",
    "head": "mixamorig:Head",
    **{
        f"{side}_{ours}": f"mixamorig:{side.title()}{theirs}"
        for side in ("left", "right")
        for ours, theirs in (
            ("upper_arm", "Arm"),
            ("forearm", "ForeArm"),
            ("thigh", "UpLeg"),
            ("shank", "Leg"),
            ("foot", "Foot"),
        )
    },
}


def put(path, scale=1.0):
    body = bundled_body()
    trimesh.Trimesh(body.vertices * scale, body.faces, process=False).export(path)
    return path


def parts(raw):
    size = struct.unpack_from("<I", raw, 12)[0]
    return json.loads(raw[20 : 20 + size]), raw[20 + size :]


def joined(tree, rest):
    said = json.dumps(tree).encode()
    said += b" " * (-len(said) % 4)
    return (
        struct.pack("<4sII", b"glTF", 2, 20 + len(said) + len(rest))
        + struct.pack("<II", len(said), 0x4E4F534A)
        + said
        + rest
    )


@pytest.mark.parametrize("kind", ["obj", "ply", "stl", "glb"])
def test_a_mesh_is_read_whatever_its_name(tmp_path, kind):
    path = put(tmp_path / f"a.{kind}", 1000.0).rename(tmp_path / "body.bin")
    surface = read(path)
    assert isinstance(surface, Surface)
    assert not surface.has_limbs
    body = bundled_body()
    assert (surface.n_vertices, len(surface.faces)) == (body.n_vertices, len(body.faces))
    apart = np.abs(np.sort(surface.vertices, axis=0) - np.sort(body.vertices * 1000, axis=0))
    assert apart.max() < 1e-3  # float32, mm
    assert_array_equal(surface.weights, np.ones((body.n_vertices, 1)))


def test_text_stl_and_quads_are_read(tmp_path):
    body = bundled_body()
    mesh = trimesh.Trimesh(body.vertices, body.faces, process=False)
    (tmp_path / "a.stl").write_text(trimesh.exchange.stl.export_stl_ascii(mesh))
    assert len(read(tmp_path / "a.stl").faces) == len(body.faces)
    lines = ["# a cage", "o cage"]
    for i in range(12):
        for j in range(12):
            lines.append(f"v {i} {j} {(i * j) % 3}")
    for i in range(11):
        for j in range(11):
            a = i * 12 + j + 1
            lines.append(f"f {a} {a + 12} {a + 13} {a + 1}")
    (tmp_path / "a.obj").write_text("\n".join(lines))
    assert len(read(tmp_path / "a.obj").faces) == 2 * 11 * 11


def test_inside_out_is_turned(tmp_path):
    body = bundled_body()
    path = tmp_path / "a.ply"
    trimesh.Trimesh(body.vertices, body.faces[:, ::-1], process=False).export(path)
    surface = read(path)
    a, b, c = surface.vertices[surface.faces.T]
    assert np.einsum("fi,fi->", np.cross(a, b), c) > 0


@pytest.mark.parametrize("kind", ["obj", "ply", "stl", "glb"])
def test_damage_is_said_in_one_line(tmp_path, kind):
    """Cut anywhere, or with bytes that are none of its own: an error of ours, or a mesh."""
    raw = put(tmp_path / f"a.{kind}").read_bytes()
    rng = np.random.default_rng(5)
    refused = 0
    for cut in (0, 3, 60, 200, len(raw) // 3, len(raw) - 7):
        path = tmp_path / f"cut.{kind}"
        path.write_bytes(raw[:cut])
        refused += complains(path)
    for _ in range(6):
        spoilt = bytearray(raw)
        at = rng.integers(0, len(raw), 40)
        for k in at:
            spoilt[k] = int(rng.integers(0, 256))
        path = tmp_path / f"spoilt.{kind}"
        path.write_bytes(bytes(spoilt))
        complains(path)
    assert refused >= 3


def complains(path):
    try:
        found, said = read(path), None
    except (UnreadableFile, BadSurface) as error:
        found, said = None, str(error)
    if found is not None:
        assert np.isfinite(found.vertices).all()
        return False
    assert "\n" not in said
    assert path.name in said
    return True


def test_what_cannot_be_used_is_named():
    body = bundled_body()
    points = body.vertices.copy()
    points[17, 1] = np.nan
    with pytest.raises(BadSurface, match=r"a.obj: vertex 17 is .*nan.*, no place"):
        cleaned(points, body.faces, "a.obj")
    many = np.tile(body.faces, (MOST_FACES // len(body.faces) + 1, 1))
    with pytest.raises(BadSurface, match="304,000 triangles; at most 300,000 are taken: decimate"):
        cleaned(body.vertices, many, "a.obj")
    with pytest.raises(BadSurface, match="0 triangles with an area; a body needs 100"):
        cleaned(body.vertices * 0, body.faces, "a.obj")
    with pytest.raises(BadSurface, match="names vertex 9999; there are 4002"):
        cleaned(body.vertices, np.full((200, 3), 9999), "a.obj")
    kept, faces = cleaned(body.vertices, np.vstack([body.faces, [[0, 1, 1]]]), "a.obj")
    assert len(faces) == len(body.faces)
    assert_array_equal(kept, np.arange(body.n_vertices))


@pytest.fixture
def rig(performance, tmp_path):
    """Return an actor, its surface, and the glTF file of both."""
    motion = motion_from_parameters(performance.parameters)
    surface = attach_surface(motion)
    write_gltf(motion, tmp_path / "rig.glb", surface, performance.recording)
    return motion, surface, tmp_path / "rig.glb"


def test_a_rigged_file_keeps_its_weights_and_joints(rig):
    motion, surface, path = rig
    found = read(path)
    assert set(found.limbs) <= {*surface.limbs, "pelvis"}
    to = [surface.limbs.index("trunk" if n == "pelvis" else n) for n in found.limbs]
    assert_allclose(found.vertices, surface.vertices, atol=FLOAT32)
    assert_array_equal(found.faces, surface.faces)
    assert_allclose(found.joint_centres[1:], surface.joint_centres[to[1:]], atol=FLOAT32)
    apart = np.abs(found.weights - surface.weights[:, to]).max(axis=1)
    plain = (surface.weights > 0).sum(axis=1) <= 2  # else a spread fourth carrier was left out
    assert apart[plain].max() < FLOAT32
    assert apart.max() < 0.1
    assert found.history[-1].findings["limbs_from"] == "names"
    again = attach_surface(motion, found)
    assert again.history[-1].findings["inverted_triangles"] == 0
    assert again.limbs == motion.skeleton.limb_names


def test_other_programs_names_are_understood(rig, tmp_path):
    _, surface, path = rig
    tree, rest = parts(path.read_bytes())
    for node in tree["nodes"]:
        node["name"] = MIXAMO.get(node["name"], f"bone {node['name'][-3:]}")
    (tmp_path / "mixamo.glb").write_bytes(joined(tree, rest))
    found = read(tmp_path / "mixamo.glb")
    assert found.history[-1].findings["joints"]["left_forearm"] == "mixamorig:LeftForeArm"
    limb = surface.limbs.index("left_forearm")
    mine = found.weights[:, found.limbs.index("left_forearm")]
    assert np.abs(mine - surface.weights[:, limb]).max() < 0.1


def test_joints_that_are_no_person_leave_a_mesh(rig, tmp_path):
    _, _, path = rig
    tree, rest = parts(path.read_bytes())
    lone = tree["skins"][0]["joints"][0]
    for node in tree["nodes"]:
        node.pop("children", None)
        node["name"] = f"bone {node.get('name', '')[-2:]}"
    tree["nodes"][lone]["children"] = [k for k in tree["skins"][0]["joints"] if k != lone]
    (tmp_path / "odd.glb").write_bytes(joined(tree, rest))
    found = read(tmp_path / "odd.glb")
    assert not found.has_limbs
    assert "could not be matched to arms and legs" in found.history[-1].warnings[0]
    assert len(found.faces) == len(bundled_body().faces)  # markers lie about, they are no body


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda t: t["accessors"][0].update(count=10**9), "reaches beyond the end"),
        (lambda t: t["accessors"][0].update(componentType=7), "its meshes are damaged"),
        (lambda t: t["accessors"][0].update(sparse={}), "sparse"),
        (lambda t: t["accessors"][0].pop("bufferView"), "compressed"),
        (lambda t: t["meshes"].clear() or t.pop("nodes"), "no skeleton to move"),
        (lambda t: t["buffers"][0].update(uri="../etc/passwd"), "not beside it"),
        (lambda t: t["meshes"][0].pop("primitives"), "its meshes are damaged"),
    ],
)
def test_damaged_gltf_is_named(tmp_path, spoil, said):
    raw = put(tmp_path / "a.glb").read_bytes()
    tree, rest = parts(raw)
    spoil(tree)
    (tmp_path / "b.glb").write_bytes(joined(tree, rest))
    with pytest.raises(UnreadableFile, match=said) as error:
        read(tmp_path / "b.glb")
    assert "\n" not in str(error.value)
