"""Any export of a person is turned into the same world: y up, right-handed."""

from dataclasses import replace
from itertools import permutations, product

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from kinesphere.data import JointModel, Recording, Segment, TopologicalModel
from kinesphere.errors import BadSetting
from kinesphere.quality import OrientationSettings, orient, right_handed, world_from_up

UP = np.array([0, 1, 0])
DIRECTIONS = ("+x", "-x", "+y", "-y", "+z", "-z")
EXPORTS = [
    np.array(signs)[:, None] * np.eye(3)[list(order)]
    for order in permutations(range(3))
    for signs in product((1.0, -1.0), repeat=3)
]
"""All 48 ways to name and sign the axes of a file; half of them are mirror images."""


FEET = ("ANK", "HEE", "TOE")


def exported(recording, export, up=None):
    """Return the recording as a file with other axes would hold it, and what it says of up."""
    return replace(recording, markers=recording.markers @ export.T, up=up)


def up_in(export):
    """Return which direction of the file is up."""
    axis = export @ UP
    k = int(np.abs(axis).argmax())
    return ("+" if axis[k] > 0 else "-") + "xyz"[k]


def lying(recording):
    """Return the person on their back on the floor: head along +x, front up."""
    turn = np.array([[0.0, 1, 0], [1, 0, 0], [0, 0, 1]]) * [[1], [1], [-1]]
    return replace(recording, markers=recording.markers @ turn.T + [0.8, -0.15, 0])


def step(recording):
    return recording.history[-1]


@pytest.mark.parametrize("export", EXPORTS, ids=[str(i) for i in range(48)])
def test_every_export_comes_back_to_the_same_world(walker, export):
    file = exported(walker, export)
    world = orient(file)
    mirrored = np.linalg.det(export) < 0
    assert step(world).findings["up"] == up_in(export)
    assert step(world).findings["mirrored"] == mirrored
    assert len(step(world).warnings) == mirrored
    assert world.up == "+y"
    assert np.linalg.det(world.world_from_file) == (-1 if mirrored else 1)
    # back to the original, up to a turn about the vertical
    back = world.world_from_file @ export
    assert np.linalg.det(back) == 1
    assert_array_equal(back @ UP, UP)
    assert_array_equal(world.markers, file.markers @ world.world_from_file.T)


@pytest.mark.parametrize("wanted", ["auto", "yes", "no"])
@pytest.mark.parametrize("axis", [None, 0, 1, 2])
def test_what_is_reflected_beforehand_is_what_orienting_reflects(walker, axis, wanted):
    export = np.diag(np.where(np.arange(3) == axis, -1.0, 1.0))
    file, settings = exported(walker, export), OrientationSettings(mirrored=wanted)
    reflected = step(orient(file, None, settings)).findings["mirrored"]
    assert reflected == (axis is not None if wanted == "auto" else wanted == "yes")
    assert_array_equal(
        right_handed(file, settings).markers, file.markers * [1, 1, -1 if reflected else 1]
    )


@pytest.mark.parametrize("export", EXPORTS[::7], ids=[str(i) for i in range(0, 48, 7)])
def test_undoing_it_is_exact(walker, export):
    file = exported(walker, export)
    world = orient(file)
    assert_array_equal(world.markers @ world.world_from_file, file.markers)


def test_the_matrix_adds_to_what_was_done_before(walker):
    once = orient(exported(walker, EXPORTS[5]))
    before = replace(once, markers=once.markers[..., [1, 2, 0]], up=None)
    turned = np.eye(3)[[1, 2, 0]] @ once.world_from_file
    world = orient(replace(before, world_from_file=turned))
    assert_array_equal(world.world_from_file @ EXPORTS[5] @ UP, UP)


def test_turning_twice_changes_nothing(walker):
    once = orient(exported(walker, EXPORTS[40]))
    twice = orient(once)
    assert_array_equal(twice.markers, once.markers)
    assert_array_equal(twice.world_from_file, once.world_from_file)


@pytest.mark.parametrize("factor", [1e-3, 1e3])
def test_the_unit_changes_nothing(walker, factor):
    file = exported(walker, EXPORTS[19])
    scaled = replace(file, markers=file.markers * factor)
    assert step(orient(scaled)).findings == step(orient(file)).findings


def test_the_order_of_markers_and_time_change_nothing(walker, rng):
    file = exported(walker, EXPORTS[19])
    order = rng.permutation(file.n_markers)
    shuffled = replace(
        file,
        markers=file.markers[::-1, order],
        labels=tuple(file.labels[i] for i in order),
    )
    assert step(orient(shuffled)).findings == step(orient(file)).findings


@pytest.mark.parametrize("up", DIRECTIONS)
def test_the_turn_takes_up_to_y_and_is_a_rotation(up):
    axis = np.zeros(3)
    axis["xyz".index(up[1])] = 1 if up[0] == "+" else -1
    assert_array_equal(world_from_up(up) @ axis, UP)
    assert np.linalg.det(world_from_up(up)) == 1
    assert_array_equal(world_from_up(up, mirrored=True) @ axis, UP)
    assert np.linalg.det(world_from_up(up, mirrored=True)) == -1


class TestAgainstTheFile:
    """What the file says of its axes, and when the body overrules it."""

    @pytest.mark.parametrize("export", EXPORTS[::5], ids=[str(i) for i in range(0, 48, 5)])
    def test_a_right_field_is_taken_without_a_word(self, walker, export):
        world = orient(exported(walker, export, up_in(export)))
        assert step(world).findings["up_from"] == "file"
        assert not any("up is" in warning for warning in step(world).warnings)

    def test_a_body_upside_down_overrules_it_aloud(self, statue):
        file = exported(statue, world_from_up("+z").T, up="-z")
        world = orient(file)
        assert step(world).findings["up_from"] == "body"
        assert step(world).warnings == (
            "the file says up is -z, but in 100% of the frames the head is along +z from the "
            "feet: up is +z",
        )
        assert_array_equal(world.markers, statue.markers)

    def test_where_nobody_shows_it_a_floor_overhead_is_told(self, walker):
        """Labels hide who it is; feet on a floor stay, what is above them does not."""
        hidden = tuple(f"m{i}" for i in range(walker.n_markers))
        sway = np.sin(np.arange(walker.n_frames) / 9.0)[:, None] * (walker.markers[..., 1] > 1.0)
        markers = walker.markers + 0.1 * sway[..., None] * UP
        told = {
            field: step(orient(replace(walker, markers=markers, labels=hidden, up=field)))
            for field in ("+y", "-y")
        }
        assert told["-y"].findings["up"] == "-y"
        (said,) = (w for w in told["-y"].warnings if "upper end" in w)
        assert "set orientation.up to +y" in said
        assert not told["+y"].warnings

    def test_knees_stand_in_for_feet_without_markers(self, statue, walker):
        for person in (statue, walker):
            kept = [k for k, label in enumerate(person.labels) if label[1:] not in FEET]
            labels = tuple(person.labels[k] for k in kept)
            file = replace(person, markers=person.markers[:, kept] * [1, -1, -1], labels=labels)
            told = step(orient(replace(file, up="+y")))
            assert (told.findings["up"], told.findings["up_from"]) == ("-y", "body")
            assert "the head is along -y from the knees: up is -y" in told.warnings[0]
            shanks = Segment("left_shank", ("LKNE",)), Segment("head", ("LFHD", "RFHD"))
            model = TopologicalModel(
                name="no feet",
                segments=shanks[::-1],
                joints=(JointModel("joint_01", "head", "left_shank"),),
                root="head",
            )
            told = step(orient(replace(file, up="+y"), model))
            assert "the head is along -y from the shanks: up is -y" in told.warnings[0]

    def test_it_does_so_above_any_floor(self, statue):
        file = replace(statue, markers=statue.markers + UP, up="-y")
        assert step(orient(file)).findings["up"] == "+y"

    @pytest.mark.parametrize("field", ["+x", "-x", "+z", "-z"])
    def test_a_walker_overrules_a_field_across(self, walker, field):
        world = orient(replace(walker, up=field))
        assert step(world).findings["up"] == "+y"
        assert f"the file says up is {field}" in step(world).warnings[0]

    def test_a_statue_on_the_files_floor_overrules_a_field_across(self, statue):
        world = orient(replace(statue, up="+z"))
        assert step(world).findings["up"] == "+y"

    def test_someone_lying_does_not(self, statue):
        file = lying(statue)
        world = orient(replace(file, up="+y"))
        assert_array_equal(world.markers, file.markers)
        (warning,) = step(world).warnings
        assert "up is +y as the file says, although in 100% of the frames" in warning
        assert "+x" in warning

    def test_nor_does_someone_lying_who_breathes(self, statue):
        """Across the body, ends sway by millimetres; along it they stay: that is no floor."""
        file = lying(statue)
        breath = 0.005 * np.sin(np.linspace(0, 6, file.n_frames))[:, None, None] * UP
        assert (
            step(orient(replace(file, markers=file.markers + breath, up="+y"))).findings["up"]
            == "+y"
        )

    def test_a_few_frames_on_the_hands_do_not_hinder_it(self, walker):
        markers = walker.markers.copy()
        markers[41:] *= [1, -1, -1]
        world = orient(replace(walker, markers=markers, up="-y"))
        assert step(world).findings["upright_share"]["+y"] == pytest.approx(41 / 47, abs=0.02)
        assert step(world).findings["up"] == "+y"

    def test_someone_who_leans_by_half_is_upright_along_nothing(self, statue):
        c = np.sqrt(0.5)
        lean = np.array([[c, c, 0], [-c, c, 0], [0, 0, 1]])
        world = orient(replace(statue, markers=statue.markers @ lean.T, up="+y"))
        assert set(step(world).findings["upright_share"].values()) == {0.0}

    def test_an_acrobat_does_not(self, walker):
        markers = walker.markers.copy()
        markers[20:] *= [1, -1, -1]  # more than half on the hands
        world = orient(replace(walker, markers=markers, up="+y"))
        assert step(world).findings["up"] == "+y"

    def test_an_acrobat_without_a_field_is_judged_by_the_floor(self, walker):
        """Upright 47 %, on the hands 53 %; the floor is below in both."""
        markers = walker.markers.copy()
        markers[22:] = markers[22:] * [1, -1, -1] + [0, 1.7, 0]
        markers[:22] -= np.nanmin(markers[:22], axis=(0, 1)) * UP
        markers[22:] -= np.nanmin(markers[22:], axis=(0, 1)) * UP
        markers[22:, :, 1] += np.linspace(0, 0.5, 25)[:, None] * (markers[22:, :, 1] > 1.2)
        world = orient(replace(walker, markers=markers))
        assert step(world).findings["up"] == "+y"
        assert step(world).warnings[0].endswith("with a steady floor: up is +y")


class TestWithoutAField:
    """Nothing but the body says which way is up: who does nothing but lie looks as if standing."""

    def test_who_stands_on_the_files_floor_is_not_doubted(self, statue):
        assert step(orient(statue)).warnings == ()

    def test_who_walks_above_any_floor_is_not_doubted(self, walker):
        assert step(orient(replace(walker, markers=walker.markers + 3 * UP))).warnings == ()

    def test_who_lies_is_doubted(self, statue):
        (warning,) = step(orient(lying(statue))).warnings
        assert "names no up axis and no floor shows it: up is +x" in warning
        assert "orientation.up" in warning

    def test_who_stands_on_the_head_is_doubted(self, statue, rng):
        markers = statue.markers * [1, -1, -1]
        markers -= np.nanmin(markers, axis=(0, 1)) * UP
        (warning,) = step(orient(replace(statue, markers=markers))).warnings
        assert "up is -y because the head is there from the feet" in warning
        swaying = markers + 0.05 * rng.normal(size=markers.shape) * markers[..., 1:2]
        (warning,) = step(orient(replace(statue, markers=swaying))).warnings
        assert "up is -y" in warning

    def test_who_walks_on_the_hands_is_doubted(self, walker):
        """Along the floor everything moves more than the feet in the air do."""
        markers = walker.markers * [1, -1, -1] + 1.7 * UP
        feet = markers[..., 1] > 1.2
        markers[..., 1] += np.linspace(0, 0.1, len(markers))[:, None] * feet
        (warning,) = step(orient(replace(walker, markers=markers))).warnings
        assert "up is -y" in warning

    def test_who_stands_still_above_any_floor_is_doubted(self, statue):
        (warning,) = step(orient(replace(statue, markers=statue.markers + UP))).warnings
        assert "up is +y" in warning

    def test_the_user_settles_it(self, statue):
        world = orient(lying(statue), settings=OrientationSettings(up="+y"))
        assert step(world).findings["up"] == "+y"


class TestTheUser:
    """What the user says wins."""

    def test_up(self, walker):
        world = orient(walker, settings=OrientationSettings(up="+z"))
        assert step(world).findings["up_from"] == "user"
        assert_array_equal(world.world_from_file, world_from_up("+z"))
        (warning,) = step(world).warnings
        assert warning == "up is +z as asked, although the head is along +y from the feet"

    def test_mirrored(self, walker):
        world = orient(walker, settings=OrientationSettings(mirrored="yes"))
        assert_array_equal(world.world_from_file, np.diag([1, 1, -1]))
        assert "mirrored is yes as asked, although" in step(world).warnings[0]

    def test_not_mirrored(self, walker):
        file = exported(walker, np.diag([-1.0, 1, 1]))
        world = orient(file, settings=OrientationSettings(mirrored="no"))
        assert_array_equal(world.world_from_file, np.eye(3))
        assert "mirrored is no as asked, although" in step(world).warnings[0]

    @pytest.mark.parametrize("setting", [{"up": "z"}, {"mirrored": "maybe"}])
    def test_nonsense_is_refused(self, setting):
        with pytest.raises(BadSetting, match="known are auto"):
            OrientationSettings(**setting)

    def test_settings_are_in_the_history(self, walker):
        world = orient(walker, settings=OrientationSettings(mirrored="no"))
        assert step(world).settings == {"up": "auto", "mirrored": "no"}


class TestWhoShowsIt:
    """Models, prefixes, several people, and nobody at all."""

    def test_a_models_own_labels(self, walker):
        """Labels that mean nothing, but a model that knows head and feet."""
        named = {label: f"m{i:02}" for i, label in enumerate(walker.labels)}
        heads = tuple(named[label] for label in ("LFHD", "RFHD", "LBHD"))
        feet = tuple(named[label] for label in ("LHEE", "LTOE"))
        model = TopologicalModel(
            name="odd",
            segments=(Segment("head", heads), Segment("left_foot", feet)),
            joints=(JointModel("joint_01", "head", "left_foot"),),
            root="head",
        )
        file = exported(walker, EXPORTS[9])
        file = replace(file, labels=tuple(named.values()))
        assert step(orient(file)).findings["up_from"] != "body"
        found = step(orient(file, model)).findings
        assert (found["up"], found["up_from"]) == (up_in(EXPORTS[9]), "body")
        assert found["right_handed_share"] is None

    @pytest.mark.parametrize("unseen", [False, True])
    def test_subjects_are_looked_at_one_by_one(self, walker, unseen):
        """Each person is seen in half of the frames only: a mean over both would have no body."""
        n = walker.n_frames // 2
        first, second = walker.markers.copy(), walker.markers.copy()
        first[n:], second[:n] = np.nan, np.nan
        first[:] = np.nan if unseen else first
        labels = [f"{name}:{label}" for name in "AB" for label in walker.labels]
        both = Recording(np.concatenate([first, second], axis=1), tuple(labels), walker.rate)
        world = orient(exported(both, EXPORTS[33]))
        assert step(world).findings["up"] == up_in(EXPORTS[33])
        assert step(world).findings["upright_share"][up_in(EXPORTS[33])] == 1

    def test_exchanged_sides_look_like_a_mirror_image(self, walker):
        swapped = tuple(
            {"L": "R", "R": "L"}[label[0]] + label[1:] if label[0] in "LR" else label
            for label in walker.labels
        )
        (warning,) = step(orient(replace(walker, labels=swapped))).warnings
        assert "left and right labels are exchanged" in warning

    @pytest.mark.parametrize("mirrored", [False, True])
    def test_feet_without_heels_tell_a_mirror_image_by_the_ankle(self, walker, mirrored):
        few = [c for c, x in enumerate(walker.labels) if x[1:] in ("KNE", "ANK", "TOE", "FWT")]
        legs = replace(
            walker, markers=walker.markers[:, few], labels=tuple(walker.labels[c] for c in few)
        )
        found = step(
            orient(exported(legs, np.diag([1.0, 1, -1 if mirrored else 1]), "+y"))
        ).findings
        assert found["right_handed_share"] == (0.0 if mirrored else 1.0)
        assert found["mirrored"] == mirrored

    def test_a_flat_image_of_a_person_tells_no_handedness(self, walker):
        """All depth is noise: each frame would say something else."""
        flat = replace(walker, markers=walker.markers * [0.005, 1, 1])
        assert step(orient(flat)).findings["right_handed_share"] is None

    def test_half_exchanged_sides_are_doubted(self, walker):
        pairs = [("LFWT", "RFWT"), ("LBWT", "RBWT")]
        exchanged = {a: b for pair in pairs for a, b in (pair, pair[::-1])}
        labels = tuple(exchanged.get(label, label) for label in walker.labels)
        world = orient(replace(walker, labels=labels))
        assert step(world).findings["mirrored"] is False
        assert (
            "labels of left and right, or of front and back, may be mixed up"
            in step(world).warnings[0]
        )

    def test_nobody_and_no_field_is_the_custom_aloud(self, rng):
        cloud = Recording(rng.normal(size=(30, 5, 3)), ("a", "b", "c", "d", "e"), 60.0)
        world = orient(cloud)
        assert step(world).findings["up_from"] == "assumed"
        assert_array_equal(world.world_from_file, world_from_up("+z"))
        assert step(world).warnings[0].endswith("taken from custom: +z")

    def test_nobody_but_a_field(self, rng):
        cloud = Recording(rng.normal(size=(30, 5, 3)), ("a", "b", "c", "d", "e"), 60.0, up="-x")
        assert_array_equal(orient(cloud).world_from_file, world_from_up("-x"))
        assert step(orient(cloud)).warnings == ()

    @pytest.mark.parametrize("export", EXPORTS[::11], ids=[str(i) for i in range(0, 48, 11)])
    def test_nobody_but_a_floor(self, walker, export):
        """A walker whose labels say nothing still treads on one floor."""
        labels = tuple(f"M{i:03}" for i in range(walker.n_markers))
        low = walker.markers.copy()
        low[..., 1] *= 0.5  # not tall
        world = orient(exported(replace(walker, labels=labels, markers=low), export))
        assert step(world).findings["up_from"] == "floor"
        assert step(world).findings["up"] == up_in(export)

    @pytest.mark.parametrize("export", EXPORTS[::11], ids=[str(i) for i in range(0, 48, 11)])
    def test_nobody_but_a_tall_shape(self, statue, export):
        labels = tuple(f"M{i:03}" for i in range(statue.n_markers))
        world = orient(exported(replace(statue, labels=labels), export))
        assert step(world).findings["up_from"] == "extent"
        assert step(world).findings["up"] == up_in(export)

    @pytest.mark.parametrize("n_frames", [1, 9])
    @pytest.mark.parametrize("label", ["LTOE", "*0"])
    def test_a_single_marker_is_no_error(self, rng, n_frames, label):
        lone = Recording(rng.normal(size=(n_frames, 1, 3)), (label,), 60.0, up="+z")
        world = orient(lone)
        assert step(world).findings["up"] == "+z"
        assert step(orient(replace(lone, up=None))).findings["up_from"] in ("floor", "assumed")

    @pytest.mark.parametrize("shape", [(0, 4), (6, 0), (6, 4)])
    def test_nothing_seen_is_no_error(self, shape):
        empty = Recording(np.full((*shape, 3), np.nan), tuple("abcd"[: shape[1]]), 60.0)
        assert step(orient(empty)).findings["up_from"] == "assumed"
