"""Joints of one axis: exact without noise, in main movements and in free motion."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.geometry.rotations import rotation_about
from kinesphere.parameterization import free_hinge as free_hinge_module
from kinesphere.parameterization.axes.cone_and_twist import ConeAndTwist
from kinesphere.parameterization.axes.hinge import USUAL_CONE, hinge_axis, other_reading
from kinesphere.parameterization.axes.likeliest import likeliest_axis
from kinesphere.parameterization.axes.phase_log_pca import phase_log_pca
from kinesphere.parameterization.free_hinge import free_hinge, worse_than_body
from kinesphere.parameterization.joint import fit_joint
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import AxesSettings, ParameterizationSettings
from kinesphere.parameterization.view import view_joint

RATE = 50.0
EXACT = 1e-3  # deg, what Gauss-Newton steps leave
LONG_AXIS = np.array([0.0, -1.0, 0.0])


def degrees(a, b):
    """Return the angle between two lines in deg."""
    return np.rad2deg(np.arctan2(np.linalg.norm(np.cross(a, b)), abs(a @ b)))


def waves(rng, n, low, high, slowest=0.1, fastest=0.5):
    """Return smooth angles between two in rad, (n,), from angles in deg."""
    t = np.arange(n) / RATE
    course = sum(
        np.sin(2 * np.pi * rng.uniform(slowest, fastest) * t + rng.uniform(0, 2 * np.pi))
        for _ in range(3)
    )
    return np.deg2rad(low + (high - low) * (0.5 + course / 6))


def hinge(rng, *, cone=85.0, n=1500, bends=(0, 110), twists=(-40, 40), noise=0.0, phases=None):
    """Return a limb that bends about one axis and twists about itself all the while."""
    axis = rotation_about(LONG_AXIS, np.array(rng.uniform(0, 2 * np.pi))) @ [1.0, 0.0, 0.0]
    tilt = Rotation.from_rotvec(np.deg2rad(90 - cone) * np.cross(axis, LONG_AXIS))
    rest = tilt if (tilt.apply(LONG_AXIS) @ axis) * np.cos(np.deg2rad(cone)) >= 0 else tilt.inv()
    rotations = (
        rotation_about(axis, waves(rng, n, *bends))
        @ rest.as_matrix()
        @ rotation_about(LONG_AXIS, waves(rng, n, *twists))
    )
    rotations = Rotation.from_rotvec(np.deg2rad(noise) * rng.normal(size=(n, 3))).as_matrix() @ (
        rotations
    )
    phases = phases or ((0, n),)
    return JointSamples(rotations, rotations @ LONG_AXIS, phases, RATE, LONG_AXIS), axis


@pytest.mark.parametrize("cone", [65.0, 90.0, 110.0])
def test_twist_cannot_touch_the_axis_of_a_hinge(rng, cone):
    samples, axis = hinge(rng, cone=cone)
    assert degrees(hinge_axis(samples, LONG_AXIS[None])[0], axis) < EXACT
    by_orientation = phase_log_pca(samples, 1, AxesSettings())[0]
    assert degrees(by_orientation, axis) > 1.0  # what twist does to the start


def screwed(rng, coupling, noise, n=2000):
    """Return a limb that bends by up to 110° and twists in proportion, (samples, axis)."""
    axis = np.array([1.0, 0.0, 0.0])
    angles = waves(rng, n, 0, 110)
    rotations = rotation_about(axis, angles) @ rotation_about(LONG_AXIS, coupling * angles)
    off = Rotation.from_rotvec(np.deg2rad(noise) * rng.normal(size=(n, 3))).as_matrix()
    rotations = off @ rotations
    return JointSamples(rotations, rotations @ LONG_AXIS, ((0, n),), RATE, LONG_AXIS), axis


@pytest.mark.parametrize("coupling", [0.1, -0.07, 0.0])
def test_twist_that_goes_with_the_angle_is_found_and_leaves_the_axis_alone(rng, coupling):
    errors, scores = [], []
    for _ in range(12):  # how far a limb happens to bend decides how well a coupling shows
        samples, axis = screwed(rng, coupling, 0.3)
        frames = ConeAndTwist.of(samples, samples.phases, 400)
        start = Rotation.from_rotvec([0.0, 0.1, 0.05]).apply(axis)
        found = likeliest_axis(frames, start, 30, USUAL_CONE, 4.0, coupling=0.1)
        errors.append(degrees(found.axis, axis))
        scores.append((found.coupling - coupling) / found.deviation)
        assert 0 < found.deviation < 0.02
        alone = likeliest_axis(frames, start, 30, USUAL_CONE, 4.0)
        assert (alone.coupling, alone.deviation) == (0.0, 0.0)
    assert np.sqrt(np.mean(np.square(errors))) < 0.5
    assert np.abs(scores).max() < 4.0


def test_an_axis_that_such_twist_puts_off_says_so_and_others_do_not(rng):
    off, said, said_of_none = [], [], []
    for _ in range(9):
        samples, axis = screwed(rng, 0.1, 1.0)
        found = hinge_axis(samples, axis[None])[0]
        off.append(degrees(found, axis))
        said.append(np.rad2deg(other_reading(samples, found)))
        samples, axis = screwed(rng, 0.0, 1.0)
        found = hinge_axis(samples, axis[None])[0]
        said_of_none.append(np.rad2deg(other_reading(samples, found)))
    assert min(off) > 2.0
    assert np.median(said) == pytest.approx(np.median(off), rel=0.3)
    assert np.median(said_of_none) < 0.5
    clean, axis = hinge(rng)
    assert np.rad2deg(other_reading(clean, hinge_axis(clean, axis[None])[0])) < 0.1


def test_a_limb_that_dwells_says_nothing_new(rng):
    n = 200
    samples, _ = hinge(rng, n=n, twists=(-15, 15))
    skin = np.deg2rad(6.0) * np.sin(np.linspace(0, 13, n))[:, None] * rng.normal(size=3)
    loose = Rotation.from_rotvec(skin).as_matrix() @ samples.rotations
    dwelling = np.sort(np.concatenate([np.arange(n), np.repeat([50, 140], 90)]))

    def found(frames):
        turned = loose[frames]
        phases = ((0, len(frames)),)
        joint = JointSamples(turned, turned @ LONG_AXIS, phases, RATE, LONG_AXIS)
        return hinge_axis(joint, LONG_AXIS[None])[0]

    assert degrees(found(dwelling), found(np.arange(n))) < 0.1


def test_without_twist_orientations_make_a_small_movement_tell_its_axis(rng):
    # an arc of 20 deg has a sagitta of 1.5 deg: directions alone are at a loss under 1 deg of noise
    errors = []
    for _ in range(5):
        samples, axis = hinge(rng, bends=(0, 20), twists=(0, 0), noise=1.0)
        errors.append(degrees(hinge_axis(samples, axis[None])[0], axis))
    assert np.median(errors) < 1.0


def test_bad_frames_count_little(rng):
    samples, axis = hinge(rng, noise=0.5)
    spoiled = samples.rotations.copy()
    bad = slice(300, 360)
    spoiled[bad] = Rotation.from_euler("x", 40, degrees=True).as_matrix() @ spoiled[bad]
    worse = JointSamples(spoiled, spoiled @ LONG_AXIS, samples.phases, RATE, LONG_AXIS)
    assert degrees(hinge_axis(worse, LONG_AXIS[None])[0], axis) < 0.5


def test_phases_share_one_cone(rng):
    # short arcs here and there: each alone hardly has a curvature
    arcs = tuple((k, k + 40) for k in range(0, 1500, 150))
    samples, axis = hinge(rng, noise=0.3, phases=arcs)
    assert degrees(hinge_axis(samples, LONG_AXIS[None])[0], axis) < 1.0


def test_free_motion_tells_the_axis_of_a_hinge(rng):
    errors = []
    for _ in range(12):
        samples, axis = hinge(rng, noise=1.0)
        off = Rotation.from_rotvec(np.deg2rad(25.0) * LONG_AXIS).apply(axis)
        found = free_hinge(samples, off)
        errors.append(degrees(found.axis, axis))
        assert found.clearly_better
        assert errors[-1] < 4 * np.rad2deg(found.uncertainty)
        assert np.rad2deg(found.moved) > 40.0
    assert np.median(errors) < 1.0


def test_what_is_no_better_than_the_body_axis_is_said_so(rng):
    samples, axis = hinge(rng, noise=2.0)
    assert not free_hinge(samples, axis).clearly_better  # it is the body's that is right


def test_little_movement_tells_no_free_hinge(rng):
    samples, axis = hinge(rng, n=150)
    assert free_hinge(samples, axis) is None


def test_the_jackknife_knows_how_uncertain_an_axis_is(rng):
    errors, deviations = [], []
    for _ in range(24):
        samples, axis = hinge(rng, n=600, noise=2.0)
        found = free_hinge(samples, axis)
        errors.append(degrees(found.axis, axis))
        deviations.append(np.rad2deg(found.uncertainty))
    ratio = np.sqrt(np.mean(np.square(errors)) / np.mean(np.square(deviations)))
    assert 0.6 < ratio < 1.9  # 1.1 over many; four folds make a rough estimate


def test_an_axis_that_suits_less_than_the_body_axis_is_told(rng):
    samples, axis = hinge(rng, noise=1.0)
    off = Rotation.from_rotvec(np.deg2rad(20.0) * LONG_AXIS).apply(axis)
    assert worse_than_body(off, axis, samples.positions)
    assert not worse_than_body(axis, off, samples.positions)
    assert not worse_than_body(axis, axis, samples.positions)


def bent_knee(rng, coupling, arc, bends=4):
    """Return a knee bent and stretched between rests, (view, axis); it twists as it bends."""
    pause, t = np.zeros(40), np.linspace(0, 1, 60)
    bend = (1 - np.cos(2 * np.pi * t)) / 2
    parts = [np.concatenate([pause, arc * (1 + 0.1 * rng.normal()) * bend]) for _ in range(bends)]
    angles = np.deg2rad(np.concatenate([*parts, pause]))
    axis = Rotation.from_rotvec(np.deg2rad(6.0) * np.array([0.8, 0.6, 0.0])).apply([0.0, 0.0, 1.0])
    rotations = rotation_about(axis, -angles) @ rotation_about(LONG_AXIS, coupling * angles)
    noise = Rotation.from_rotvec(np.deg2rad(0.5) * rng.normal(size=(len(angles), 3)))
    everywhere = np.ones(len(angles), dtype=bool)
    return view_joint(
        "left_knee",
        noise.as_matrix() @ rotations,
        LONG_AXIS,
        everywhere,
        RATE,
        everywhere,
        ParameterizationSettings(),
    ), axis


@pytest.mark.parametrize("coupling", [0.2, 0.3])
def test_free_motion_keeps_the_doubt_that_twist_with_the_angle_casts(rng, coupling):
    view, axis = bent_knee(rng, coupling, 60.0)
    strict = ParameterizationSettings(axes=AxesSettings(largest_uncertainty=6.0))
    fit = fit_joint(view, strict)
    assert "held_out_deg" in fit.findings  # all movement together tells the same tilted axis
    off, told = degrees(fit.axes[-1], axis), np.rad2deg(fit.uncertainty[-1])
    assert off > 10.0
    assert told == pytest.approx(off, rel=0.25)
    assert fit.findings["other_reading_deg"] == pytest.approx(told, rel=0.1)
    assert fit.findings["axes_uncertainty_deg"][-1] == pytest.approx(told)
    assert len(fit.doubts) == 1
    assert "if the limb twists with the angle" in fit.doubts[0]


@pytest.mark.parametrize(("reading", "serves"), [(5.0, True), (15.0, True), (31.0, False)])
def test_what_only_free_motion_leaves_uncertain_is_told(rng, monkeypatch, reading, serves):
    view, _ = bent_knee(rng, 0.0, 60.0)
    never = ParameterizationSettings(axes=AxesSettings(largest_spread=0.0))
    monkeypatch.setattr(free_hinge_module, "other_reading", lambda *_: np.deg2rad(reading))
    fit = fit_joint(view, never)
    assert (fit.source == "movement") == serves
    (doubt,) = fit.doubts
    assert ("axis of all movement" in doubt) == serves
    if serves:  # of the axis that does not serve nothing is said, nor are its figures told
        assert doubt.endswith(f"if the limb twists with the angle, it is {reading:.0f}° off")
        (cone,) = fit.findings["main_movement_doubts"]
        assert "leaves the cone" in cone
        assert fit.added  # an axis across it, which no movement tells
        assert fit.findings["halves_disagreement_deg"] == [None, None]
        for figures, about in (("alike_deg", reading), ("ranges_deg", 60.0)):
            across, own = fit.findings[figures]
            assert across is None
            assert own == pytest.approx(about, rel=0.15)
        assert fit.findings["alike_deg"][1] == pytest.approx(reading, abs=0.01)
