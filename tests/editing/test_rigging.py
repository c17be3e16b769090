"""A mesh that somebody brings: limbs, joints and weights found again, and what is no person."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.data import Surface, bundled_body, motion_from_parameters
from kinesphere.editing import SurfaceSettings, attach_surface
from kinesphere.editing.mesh.rigging import rigged, righted
from kinesphere.editing.mesh.rigging.puppet import Puppet
from kinesphere.editing.mesh.rigging.units import unit_of
from kinesphere.editing.mesh.rigging.upright import name_of_axis, ways_to_stand
from kinesphere.errors import BadSetting, BadSurface
from kinesphere.geometry.samples import surface_samples, vertex_areas
from kinesphere.synthetic import make_performance

ARMS_UP = {"T": 45.0, "A": 0.0, "standing": -20.0}  # degrees from how the bundled body has them
JOINTS = 2e-3  # m, of a body that differs in pose alone; the fit ends within 1 mm
OTHER_JOINTS = 15e-3  # m, of one that differs in shape as well
WEIGHTS = 0.02  # mean share that goes to a wrong limb; two rounds of smoothing alone make 0.015


def posed(up_deg, **shape):
    """Return the bundled body with its arms raised, and where its joints then are."""
    body = bundled_body().shaped(shape)
    puppet = Puppet(body)
    vector = np.zeros(puppet.parts["shapes"].stop)
    bends = vector[puppet.parts["bends"]].reshape(-1, 3)
    for side, sign in (("left", 1), ("right", -1)):
        bends[body.limbs.index(f"{side}_upper_arm") - 1, 0] = sign * np.radians(up_deg)
    return puppet.vertices(vector), puppet.maps(vector[None])[2][0]


def given(vertices, scale=1.0, degrees=(0, 0, 0)):
    turn = Rotation.from_euler("xyz", degrees, degrees=True).as_matrix()
    return Surface.without_limbs(vertices @ turn.T * scale + 7.0, bundled_body().faces)


fits = pytest.mark.slow  # in plain Python, seconds compiled


@pytest.fixture(scope="module")
def recovered():
    """Return pose → (what was found, how far its joints are off, m), in mm and turned over."""
    found = {}
    for pose, up in ARMS_UP.items():
        vertices, joints = posed(up)
        body = rigged(given(vertices, 1000.0, (90, 0, 0)))
        shift = (body.vertices - vertices).mean(axis=0)
        assert_allclose(body.vertices, vertices + shift, atol=1e-9)  # metres, standing, untouched
        off = np.linalg.norm(body.joint_centres - joints - shift, axis=1)
        found[pose] = body, off
    return found


@fits
@pytest.mark.parametrize("pose", ARMS_UP)
def test_joints_and_weights_are_found_again(recovered, pose):
    body, off = recovered[pose]
    assert off.max() < JOINTS
    wrong = np.abs(body.weights - bundled_body().weights).sum(axis=1) / 2
    assert wrong.mean() < WEIGHTS
    assert np.quantile(wrong, 0.99) < 0.15


@fits
@pytest.mark.parametrize("pose", ARMS_UP)
def test_how_it_stood_is_said(recovered, pose):
    found = recovered[pose][0].history[-1].findings
    assert (found["up"], found["facing"], found["unit"]) == ("+z", "+x", "mm")
    assert found["pose"] == pose
    assert found["off_mm"] < 1.0


@fits
@pytest.mark.parametrize("pose", ARMS_UP)
def test_no_triangle_turns_over_in_the_default_pose(recovered, pose, rng):
    made = make_performance(rng, rate=25.0, calibration_s=2.0, free_s=1.0)
    motion = motion_from_parameters(made.parameters)
    surface = attach_surface(motion, recovered[pose][0])
    assert surface.history[-1].findings["inverted_triangles"] == 0
    own = attach_surface(motion)
    tall = [np.ptp(one.vertices[:, 1]) for one in (surface, own)]
    assert tall[0] == pytest.approx(tall[1], rel=0.03)


@fits
def test_another_body_in_odd_axes_is_found():
    """Heavy, female, of other proportions; leaning in its file."""
    vertices, joints = posed(45.0, sex=-1.0, weight=0.6, proportions=-0.4)
    body = rigged(given(vertices, 39.37, (20, 30, 50)))
    assert body.history[-1].findings["unit"] == "in"
    turn, _ = Rotation.align_vectors(
        vertices - vertices.mean(axis=0), body.vertices - body.vertices.mean(axis=0)
    )
    there = turn.apply(body.joint_centres - body.vertices.mean(axis=0)) + vertices.mean(axis=0)
    assert np.linalg.norm(there - joints, axis=1).max() < OTHER_JOINTS
    # its upright is that of its own torso
    assert np.degrees(turn.magnitude()) < 5.0


@fits
def test_what_is_stated_is_taken():
    vertices, _ = posed(45.0)
    points, normals, _ = surface_samples(vertices, bundled_body().faces, 900)
    for up, facing, expected in (("+y", "auto", 2), ("auto", "+x", 2), ("+y", "+x", 1)):
        ways = ways_to_stand(points, normals, up, facing)
        assert len(ways) == expected
        assert any(np.allclose(way, np.eye(3)) for way in ways)
    (alone,) = ways_to_stand(points, normals, "-z", "+x")
    assert_allclose(alone[:2], [[1, 0, 0], [0, 0, -1]])
    assert np.linalg.det(alone) == pytest.approx(1.0)
    mesh = given(vertices, 1000.0, (90, 0, 0))
    with pytest.raises(BadSurface, match=r"up is \+z and surface.facing -z: they must be square"):
        rigged(mesh, SurfaceSettings(up="+z", facing="-z"))
    with pytest.raises(BadSurface, match="no person"):
        rigged(mesh, SurfaceSettings(up="+x", facing="+z"))
    with pytest.raises(BadSetting, match="pose is 'sitting'; known are auto, T, A, standing"):
        SurfaceSettings(pose="sitting")


def box(size, cuts=6):
    """Return a closed box of many triangles."""
    ticks = np.linspace(-0.5, 0.5, cuts + 1)
    vertices, faces = [], []
    for axis in range(3):
        for side in (-0.5, 0.5):
            grid = np.stack(np.meshgrid(ticks, ticks, indexing="ij"), axis=-1).reshape(-1, 2)
            points = np.insert(grid, axis, side, axis=1)
            for i in range(cuts):
                for j in range(cuts):
                    a = len(vertices) * len(points) + i * (cuts + 1) + j
                    b, c, d = a + 1, a + cuts + 1, a + cuts + 2
                    quad = [[a, c, b], [b, c, d]]
                    outward = (side > 0) != (axis == 1)
                    faces += quad if outward else [f[::-1] for f in quad]
            vertices.append(points)
    return np.vstack(vertices) * size, np.array(faces)


@fits
def test_what_is_no_person_is_refused():
    body = bundled_body()
    sheet = np.stack(np.meshgrid(np.linspace(0, 1, 12), np.linspace(0, 2, 12), [0.0]), -1)
    flat = [
        [i * 12 + j + k for k in corner]
        for i in range(11)
        for j in range(11)
        for corner in ((0, 1, 12), (1, 13, 12))
    ]
    shifted = body.vertices + np.array([0.0, 0.0, 1.6])
    two = np.vstack([body.vertices, shifted]), np.vstack([body.faces, body.faces + len(shifted)])
    for vertices, faces in (
        box([1.0, 1.0, 1.0]),
        box([0.3, 1.7, 0.5]),
        (sheet.reshape(-1, 3), np.array(flat)),
        two,
    ):
        with pytest.raises(BadSurface, match="the mesh is no person standing alone") as error:
            rigged(Surface.without_limbs(vertices, faces))
        assert "\n" not in str(error.value)


def test_a_rigged_body_is_turned_by_its_joints(rng):
    body = replace(bundled_body(), shapes=())
    turn = Rotation.from_euler("y", -90, degrees=True).as_matrix()  # as glTF has it, in cm
    other = replace(
        body,
        vertices=body.vertices @ turn.T * 100,
        joint_centres=body.joint_centres @ turn.T * 100,
        ends=body.ends @ turn.T * 100,
    )
    back = righted(other)
    found = back.history[-1].findings
    assert (found["up"], found["facing"], found["unit"]) == ("+y", "+z", "cm")
    assert found["pose"] == "A"
    low = body.vertices[:, 1].min()
    assert_allclose(back.vertices, body.vertices - [0, low, 0], atol=1e-9)
    assert_allclose(back.ends, body.ends - [0, low, 0], atol=1e-9)


def test_a_rigged_body_without_arms_is_refused():
    body = replace(bundled_body(), shapes=())
    names = [n.replace("left_upper_arm", "wing") for n in body.limbs]
    with pytest.raises(BadSurface, match="no left_upper_arm"):
        righted(replace(body, limbs=tuple(names)))


@pytest.mark.parametrize(
    ("tall", "name"), [(1.7, "m"), (170, "cm"), (1700, "mm"), (68, "in"), (17, "dm")]
)
def test_units_are_guessed_by_how_tall_people_are(tall, name):
    assert unit_of(tall)[0] == name
    assert 1.2 < tall * unit_of(tall)[1] < 2.3
    assert unit_of(4e-4) == ("of 4.25e+03 m, as for a person", pytest.approx(4250))


def test_a_mirror_plane_tells_left_and_right():
    vertices, _ = posed(45.0)
    turn = Rotation.from_euler("zyx", [70, -20, 35], degrees=True).as_matrix()
    points, normals, _ = surface_samples(vertices @ turn.T, bundled_body().faces, 1500)
    ways = ways_to_stand(points, normals, "auto", "auto")
    assert len(ways) == 4
    off = [np.degrees(Rotation.from_matrix(way @ turn).magnitude()) for way in ways]
    assert min(off) < 6.0
    across = np.array([way[2] @ turn @ [0, 0, 1] for way in ways])
    assert (np.abs(across) > np.cos(np.radians(2))).all()


def test_axes_are_named():
    assert name_of_axis(np.array([0.0, -1.0, 0.0])) == "-y"
    assert name_of_axis(np.array([np.cos(0.5), 0.0, np.sin(0.5)])) == "29° off +x"


def test_samples_lie_on_the_surface_evenly():
    vertices, faces = box([1.0, 2.0, 0.5])
    points, normals, face = surface_samples(vertices, faces, 3500)
    half = np.array([0.5, 1.0, 0.25])
    on = np.isclose(np.abs(points), half)
    assert on.any(axis=1).all()
    assert (np.abs(points) <= half + 1e-12).all()
    # each of six sides gets its share of 7 m²: x sides 1, y sides 0.5, z sides 2
    for axis, area in ((0, 1.0), (1, 0.5), (2, 2.0)):
        share = np.mean(normals[:, axis] > 0.9)
        assert share == pytest.approx(area / 7, abs=2e-3)
    assert_allclose(np.einsum("ni,ni->n", normals, np.where(on, points, 0)) > 0, True)
    assert_allclose(vertex_areas(vertices, faces).sum(), 7.0)
    assert (face < len(faces)).all()


def test_the_puppet_at_rest_is_the_body(rng):
    puppet = Puppet(bundled_body())
    vector = np.zeros(puppet.parts["shapes"].stop)
    assert_allclose(puppet.vertices(vector), bundled_body().vertices, atol=1e-12)
    steps = rng.normal(scale=0.3, size=len(bundled_body().shapes))
    vector[puppet.parts["shapes"]] = steps
    shaped = bundled_body().shaped(dict(zip(bundled_body().shapes, steps, strict=True)))
    assert_allclose(puppet.vertices(vector), shaped.vertices, atol=1e-9)
    vector[puppet.parts["size"]] = np.log(2.0)
    hips = shaped.joint_centres[0]
    assert_allclose(puppet.vertices(vector) - hips, 2 * (shaped.vertices - hips), atol=1e-9)


def test_slopes_are_those_of_the_places(rng):
    """A step along any mix of numbers moves the vertices as the slopes say."""
    puppet = Puppet(bundled_body())
    chosen = np.arange(0, 4000, 97)
    vector = rng.normal(scale=0.1, size=puppet.parts["shapes"].stop)
    step = 1e-4 * rng.normal(size=len(vector))
    moved = puppet.vertices(vector + step, chosen) - puppet.vertices(vector - step, chosen)
    told = np.tensordot(2 * step, puppet.slopes(vector, chosen), 1)
    assert_allclose(told, moved, atol=1e-7)
