"""A model from motion alone, against the actor it came from and laws it must keep."""

import sys
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.data import Recording
from kinesphere.errors import BadRecording, BadSetting, DegenerateMotion
from kinesphere.skeleton import DiscoverySettings, discover
from kinesphere.synthetic import (
    HAND,
    PLAYER,
    QUADRUPED,
    make_performance,
    spoil_with_gaps,
    spoil_with_ghosts,
    spoil_with_noise,
    spoil_with_soft_tissue,
    together,
)


@pytest.fixture(scope="module")
def found(recorded):
    """Return what is found of the actor."""
    return discover(recorded)


def as_told(discovery):
    """Return everything of a model but the names of its labels' columns."""
    return (
        {segment.name: set(segment.markers) for segment in discovery.model.segments},
        {(joint.name, joint.parent, joint.child) for joint in discovery.model.joints},
    )


def partition(discovery):
    """Return bodies as sets of markers, and pairs of those that meet."""
    bodies = {segment.name: frozenset(segment.markers) for segment in discovery.model.segments}
    joints = {(bodies[joint.parent], bodies[joint.child]) for joint in discovery.model.joints}
    return set(bodies.values()), joints


def truly_named(limbs):
    return all(own == {name} for name, own in limbs.items())


def test_every_limb_of_a_person_is_found_and_named(found, actor, owner, limbs_of):
    assert truly_named(limbs_of(found, owner))
    assert {segment.name for segment in found.model.segments} == set(owner)
    edges = {(joint.name, joint.parent, joint.child) for joint in found.model.joints}
    assert edges == {(joint.name, joint.parent, joint.child) for joint in actor.skeleton.joints}
    assert found.model.root == "trunk"
    assert found.step.warnings == ()


def test_knees_are_hinges_and_hips_are_not(found):
    axes = {joint.name: joint.n_axes for joint in found.model.joints}
    assert axes["left_knee"] == axes["right_knee"] == 1
    assert axes["left_hip"] == axes["right_hip"] == 2


def test_turned_moved_and_reversed_it_is_the_same_person(found, recorded, rng):
    turn = Rotation.random(rng=rng).as_matrix()
    for markers in (recorded.markers @ turn.T + rng.normal(size=3), recorded.markers[::-1]):
        assert as_told(discover(replace(recorded, markers=np.array(markers)))) == as_told(found)


@pytest.mark.parametrize("unit", [0.1, 10.0])
def test_another_unit_gives_the_same_bodies_and_tree(found, recorded, unit):
    other = discover(replace(recorded, markers=unit * recorded.markers))
    assert partition(other) == partition(found)
    assert all(segment.name.startswith("limb_") for segment in other.model.segments)
    assert any("unit of length is wrong" in doubt for doubt in other.step.warnings)
    here, there = found.step.findings, other.step.findings
    assert there["within_bodies_mm"] == pytest.approx(unit * here["within_bodies_mm"], rel=0.01)
    costs = [sorted(j["cost_mm"] for j in told["joints_found"].values()) for told in (here, there)]
    assert costs[1] == pytest.approx(unit * np.array(costs[0]), rel=0.01)


@pytest.mark.parametrize("unit", [0.1, 10.0])
def test_another_unit_gives_the_same_hand(unit):
    rng = np.random.default_rng(4)
    performance = make_performance(rng, plan=HAND, n_frames=6000)
    recording = spoil_with_noise(performance.recording, rng, deviation=0.0002)
    other = discover(replace(recording, markers=unit * recording.markers))
    assert partition(other) == partition(discover(recording))


def test_numbers_of_limbs_do_not_depend_on_the_order_of_markers(rng):
    performance = make_performance(np.random.default_rng(3), plan=QUADRUPED, n_frames=6000)
    recording = spoil_with_noise(performance.recording, rng, deviation=0.001)
    order = rng.permutation(recording.n_markers)
    shuffled = replace(
        recording,
        markers=np.ascontiguousarray(recording.markers[:, order]),
        labels=tuple(recording.labels[i] for i in order),
    )
    assert as_told(discover(shuffled)) == as_told(discover(recording))


def test_order_of_markers_does_not_matter(found, recorded, rng):
    order = rng.permutation(recorded.n_markers)
    shuffled = replace(
        recorded,
        markers=np.ascontiguousarray(recorded.markers[:, order]),
        labels=tuple(recorded.labels[i] for i in order),
    )
    assert as_told(discover(shuffled)) == as_told(found)


def test_a_mirror_image_has_left_and_right_exchanged(recorded, owner, limbs_of):
    seen = discover(replace(recorded, markers=recorded.markers * [-1.0, 1.0, 1.0]))
    swapped = {"left": "right", "right": "left"}
    for name, limbs in limbs_of(seen, owner).items():
        side, _, kind = name.partition("_")
        assert limbs == {f"{swapped[side]}_{kind}" if side in swapped else name}


def test_a_child_is_named_as_an_adult_is(found, recorded):
    small = discover(replace(recorded, markers=0.6 * recorded.markers))
    assert as_told(small) == as_told(found)


def test_gaps_ghosts_and_soft_tissue_leave_the_person(actor, owner, limbs_of):
    rng = np.random.default_rng(11)
    recording = spoil_with_soft_tissue(actor.recording, rng, actor)
    recording = spoil_with_noise(recording, rng, deviation=0.001)
    recording = spoil_with_gaps(recording, rng, share=0.1, gap_s=0.3)
    recording = spoil_with_ghosts(recording, rng, n_ghosts=5)
    n = recording.n_markers
    seen = discover(replace(recording, labels=tuple(f"*{i}" for i in range(n))))
    assert truly_named(limbs_of(seen, owner))
    assert sorted(seen.step.findings["ghosts"]) == [f"*{i}" for i in range(n - 5, n)]


def test_samples_missing_at_random_leave_the_person(found, recorded, rng):
    markers = recorded.markers.copy()
    markers[rng.random(markers.shape[:2]) < 0.3] = np.nan
    assert as_told(discover(replace(recorded, markers=markers))) == as_told(found)


def test_where_all_counts_as_reflections_the_setting_is_named(recorded):
    seen_at_times = recorded.markers.copy()
    seen_at_times[np.arange(recorded.n_frames) % 20 > 4] = np.nan  # 0.2 s of each 0.8 s
    for turn in (1, 2):  # a third of the markers at a time
        seen_at_times[:, turn::3] = np.roll(seen_at_times[:, turn::3], 5 * turn, axis=0)
    with pytest.raises(BadRecording, match=r"0 of .*0\.5 s .*discovery\.ghost_s"):
        discover(replace(recorded, markers=seen_at_times))


@pytest.mark.parametrize("laid_out", ["F", "markers first", "not aligned"])
def test_how_numbers_lie_in_memory_does_not_matter(found, recorded, laid_out):
    """Past the copy that a recording makes, too: every finding to the last digit."""
    markers = recorded.markers
    if laid_out == "F":
        other = np.asfortranarray(markers)
    elif laid_out == "markers first":
        other = np.ascontiguousarray(markers.swapaxes(0, 1)).swapaxes(0, 1)
    else:
        bare = np.empty(markers.nbytes + 8, dtype=np.uint8)
        other = bare[8:].view(np.float64).reshape(markers.shape)
        other[:] = markers
    again = replace(recorded)
    object.__setattr__(again, "markers", other)
    told = discover(again)
    assert as_told(told) == as_told(found)
    assert told.step.findings == found.step.findings


def test_a_marker_over_a_joint_is_a_knee_s_half_width_from_its_centre_and_as_much_again(
    actor, recorded, rng
):
    """6 cm on a person: a knee is 9 to 12 cm wide; in proportion on dolls and in other units."""
    names = list(actor.skeleton.limb_names)
    knee = next(j for j, joint in enumerate(actor.skeleton.joints) if joint.name == "left_knee")
    joint = actor.skeleton.joints[knee]
    axis = actor.motion.rotations[:, names.index(joint.parent)] @ joint.axes[0]
    over = actor.joint_centres[:, knee] + 0.05 * axis + rng.normal(scale=0.001, size=axis.shape)
    markers = np.concatenate([recorded.markers, over[:, None]], axis=1)
    spreads = {}
    for size in (1.0, 0.25, 0.2, 0.1, 10.0):
        labels = (*recorded.labels, "knee")
        model = discover(replace(recorded, markers=size * markers, labels=labels)).model
        (landmark,) = (mark for joint in model.joints for mark in joint.landmarks)
        assert landmark.weights == {"knee": 1.0}
        spreads[size] = landmark.spread
    assert 0.045 < spreads[1.0] < 0.075
    assert spreads[0.25] < 0.75 * spreads[1.0]
    assert spreads[0.2] == pytest.approx(0.8 * spreads[0.25])
    for unit in (0.1, 10.0):
        assert spreads[unit] == pytest.approx(unit * spreads[1.0])


def test_the_same_input_gives_the_same_output(found, recorded):
    again = discover(recorded)
    assert again.model == found.model or as_told(again) == as_told(found)
    assert again.step.findings == found.step.findings


@pytest.mark.parametrize(("plan", "noise"), [(QUADRUPED, 0.001), (HAND, 0.0001)])
def test_what_is_no_person_is_numbered(plan, noise):
    rng = np.random.default_rng(1)
    performance = make_performance(rng, plan=plan, rate=25, calibration_s=90, free_s=30)
    recording = spoil_with_noise(performance.recording, rng, deviation=noise)
    owner = {label: limb.name for limb in performance.skeleton.limbs for label in limb.markers}
    found = discover(recording)
    names = [segment.name for segment in found.model.segments]
    assert sorted(names) == [f"limb_{i:02d}" for i in range(1, len(plan.limbs) + 1)]
    limbs = {
        segment.name: {owner[label] for label in segment.markers}
        for segment in found.model.segments
    }
    assert all(len(one) == 1 for one in limbs.values())
    edges = {frozenset((*limbs[j.parent], *limbs[j.child])) for j in found.model.joints}
    assert edges == {frozenset((j.parent, j.child)) for j in performance.skeleton.joints}
    assert any("numbered" in warning for warning in found.step.warnings)


def test_a_racket_is_no_hand():
    rng = np.random.default_rng(3)
    performance = make_performance(rng, plan=PLAYER, rate=25, calibration_s=60, free_s=20)
    found = discover(spoil_with_noise(performance.recording, rng, deviation=0.001))
    by_name = {segment.name: segment.markers for segment in found.model.segments}
    assert set(by_name["limb_01"]) == set(performance.skeleton.limb("racket").markers)
    assert set(by_name["right_forearm"]) == set(performance.skeleton.limb("right_forearm").markers)


def test_of_two_people_either_is_solved_and_the_other_is_told():
    people = {
        name: make_performance(np.random.default_rng(k), rate=25, calibration_s=40, free_s=20)
        for k, name in enumerate(("Anna", "Ben"))
    }
    recording = spoil_with_noise(together(people), np.random.default_rng(5), deviation=0.001)
    whom = set()
    for tree in (1, 2):
        found = discover(recording, DiscoverySettings(tree=tree))
        (other,) = found.step.findings["other_trees"]
        assert {label[:3] for label in found.model.labels}.isdisjoint(label[:3] for label in other)
        assert len(found.model.labels) + len(other) == recording.n_markers
        assert any("move independently" in warning for warning in found.step.warnings)
        whom |= {label[:3] for label in found.model.labels}
    assert whom == {"Ann", "Ben"}
    with pytest.raises(BadRecording, match="tree 3 was asked for; 2"):
        discover(recording, DiscoverySettings(tree=3))


def test_the_number_of_bodies_and_the_names_can_be_settled(recorded):
    found = discover(recorded, DiscoverySettings(bodies=9, names=False))
    assert found.step.findings["bodies_found"] == 9
    assert all(segment.name.startswith("limb_") for segment in found.model.segments)
    with pytest.raises(BadSetting, match="bodies is 0"):
        DiscoverySettings(bodies=0)


def test_cloth_is_told_as_loose_and_trusted_with_nothing(recorded, owner, rng):
    trunk = owner.index("trunk")
    flutter = np.cumsum(rng.normal(scale=0.02, size=(recorded.n_frames, 3)), axis=0)
    flutter = 0.1 * flutter / flutter.std(axis=0)
    cloth = recorded.markers[:, trunk] + np.array([0.0, -0.1, 0.15]) + flutter
    found = discover(
        replace(
            recorded,
            markers=np.concatenate([recorded.markers, cloth[:, None]], axis=1),
            labels=(*recorded.labels, "cloth"),
        )
    )
    assert found.step.findings["loose"] == ["cloth"]
    assert found.step.findings["marker_confidence"]["cloth"] == 0
    assert "cloth" not in found.model.labels
    assert {segment.name for segment in found.model.segments} == set(owner)


@pytest.mark.parametrize("size", [3, 4, 5, 8])
def test_a_single_thing_without_any_noise_is_one_limb(rng, moving_bodies, size):
    points, _ = moving_bodies(rng, (size,))
    found = discover(Recording(points, tuple("abcdefgh"[:size]), 100.0))
    assert [len(segment.markers) for segment in found.model.segments] == [size]


def test_a_single_rigid_thing_is_one_limb(rng):
    steps = np.cumsum(rng.normal(scale=0.03, size=(2, 300, 3)), axis=1)
    turns = Rotation.from_rotvec(steps[0]).as_matrix()
    points = np.einsum("fij,mj->fmi", turns, rng.normal(scale=0.1, size=(5, 3)))
    points = points + steps[1][:, None] + rng.normal(scale=3e-4, size=points.shape)
    found = discover(Recording(points, tuple("abcde"), 50.0))
    assert len(found.model.segments) == 1
    assert found.model.joints == ()


def test_a_marker_never_seen_and_a_pair_in_one_place_are_survived(recorded, owner):
    markers = np.array(recorded.markers)
    markers[:, 3] = np.nan
    markers[:, 6] = markers[:, 7]
    found = discover(replace(recorded, markers=markers))
    assert "*3" not in found.model.labels
    assert "*6" in found.model.labels
    assert "*7" not in found.model.labels  # the same as *6
    assert found.step.findings["copies"] == {"*7": "*6"}
    assert len(found.model.segments) == len(set(owner))


def test_bodies_never_seen_together_are_trees_of_their_own(rng, moving_bodies):
    points, _ = moving_bodies(rng, (4, 5), n_frames=400, noise=0.0005)
    points[:200, :4] = np.nan
    points[200:, 4:] = np.nan
    found = discover(Recording(points, tuple("abcdefghi"), 50.0))
    assert found.step.findings["trees"] == 2
    assert set(found.model.labels) == set("efghi")


def test_two_markers_and_bodies_of_two_are_refused(recorded, rng):
    with pytest.raises(BadRecording, match="at least 3 are needed"):
        discover(replace(recorded, markers=recorded.markers[:, :2], labels=recorded.labels[:2]))
    ends = np.cumsum(rng.normal(scale=0.05, size=(400, 4, 3)), axis=0)
    stick = ends[:, 1] - ends[:, 0]
    ends[:, 1] = ends[:, 0] + 0.2 * stick / np.linalg.norm(stick, axis=1, keepdims=True)
    stick = ends[:, 3] - ends[:, 2]
    ends[:, 3] = ends[:, 2] + 0.3 * stick / np.linalg.norm(stick, axis=1, keepdims=True)
    with pytest.raises(DegenerateMotion, match="three markers off a line that a root needs"):
        discover(Recording(ends, tuple("abcd"), 50.0))


@pytest.mark.parametrize("more", [-1, 0, 448])
def test_more_bodies_than_markers_allow_are_refused_before_any_work(recorded, monkeypatch, more):
    def never(*_):
        raise AssertionError

    module = sys.modules["kinesphere.skeleton.discovery.discover"]
    monkeypatch.setattr(module, "find_copies", never)
    n = recorded.n_markers
    told = f"asks for {n + more} bodies of {n} markers; at most {n // 3} can have three each"
    with pytest.raises(BadRecording, match=told):
        discover(recorded, DiscoverySettings(bodies=n + more))
    with pytest.raises(AssertionError):  # so many can be
        discover(recorded, DiscoverySettings(bodies=n - 2))


@pytest.mark.parametrize("where", [2e9, -1e300])
def test_a_marker_where_none_can_be_is_refused(recorded, where):
    markers = np.array(recorded.markers)
    markers[5, 3, 1] = where
    told = rf"\*3 is {abs(where):.3g} m from the origin in frame {recorded.first_frame + 5}: "
    with pytest.raises(BadRecording, match=told.replace("+", r"\+")):
        discover(replace(recorded, markers=markers))


def test_of_somebody_who_hardly_moves_nothing_is_to_be_trusted(recorded, rng, found):
    """A person sways: every limb by a millimetre or two, more than any marker on its limb."""
    swaying = np.array(recorded.markers)
    still = swaying[:1] + rng.normal(scale=0.0001, size=swaying.shape)
    still += 0.03 * (swaying - swaying[:1])
    told = [w for w in discover(replace(recorded, markers=still)).step.warnings if "hardly" in w]
    assert "the markers hardly move against each other" in told[0]
    assert "bodies, joints and names are not to be trusted" in told[0]
    assert not [w for w in found.step.warnings if "hardly move against" in w]


def test_bodies_that_stay_where_they_are_are_joined_with_doubt(rng):
    """A shank swings about its ankle; the foot stands still, as a thing on the floor would."""
    angles = 0.5 * np.sin(np.linspace(0, 12, 300))
    turns = Rotation.from_rotvec(angles[:, None] * [0.0, 0.3, 1.0]).as_matrix()
    shank = np.array([[0.03, 0.1, 0], [-0.03, 0.15, 0.02], [0, 0.2, -0.03], [0.02, 0.3, 0.03]])
    foot = np.array([[0, -0.04, 0], [0.08, -0.06, 0.02], [0.02, -0.05, -0.06], [0.05, -0.03, 0.04]])
    points = np.concatenate(
        [np.einsum("fij,mj->fmi", turns, shank), np.tile(foot, (300, 1, 1))], axis=1
    )
    points += rng.normal(scale=0.001, size=points.shape)
    doubts = {}
    for way in (0.0, 1.0):  # m, that both go
        going = points + np.linspace(0, way, 300)[:, None, None]
        found = discover(Recording(going, tuple("abcdefgh"), 50.0))
        assert len(found.model.joints) == 1
        doubts[way] = any("hardly anything shows a joint" in w for w in found.step.warnings)
    assert doubts == {0.0: True, 1.0: False}
