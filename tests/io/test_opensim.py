"""The OpenSim model and its motion, played back by an evaluator of ours and by OpenSim itself."""

import warnings
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.data import motion_from_parameters
from kinesphere.errors import BadModel
from kinesphere.io import read_segments, write, write_mot, write_osim
from kinesphere.io.opensim_joints import LEAST_SINE, joint_turns

PLAYED_BACK = 1e-7  # m; the motion file has nine decimals of a degree and of a metre


def read_mot(path):
    """Return coordinate → values in rad and m, from the format's description alone."""
    head, _, rest = path.read_text(encoding="utf-8").partition("endheader\n")
    assert head.startswith("Coordinates\nversion=1\n")
    assert "inDegrees=yes\n" in head
    names, *rows = (line.split("\t") for line in rest.splitlines())
    assert f"nRows={len(rows)}\n" in head
    assert f"nColumns={len(names)}\n" in head
    columns = dict(zip(names, np.array(rows, dtype=float).T, strict=True))
    return {
        name: values if name.endswith(("time", "_tx", "_ty", "_tz")) else np.radians(values)
        for name, values in columns.items()
    }


def numbers(element, tag):
    return np.array(element.findtext(tag).split(), dtype=float)


class Playback:
    """Forward kinematics of an .osim file: free and custom joints between offset frames.

    ``translations[body]`` (n_frames, 3) m and ``rotations[body]`` place the bodies in the ground.
    """

    def __init__(self, path, coordinates):
        self.model = ElementTree.parse(path).getroot().find("Model")
        self.coordinates = coordinates
        self.used = set()
        n_frames = len(coordinates["time"])
        self.translations = {"/ground": np.zeros((n_frames, 3))}
        self.rotations = {"/ground": Rotation.identity(n_frames)}
        joints = list(self.model.find("JointSet/objects"))
        while joints:
            ready = [j for j in joints if self._end(j, "parent")[0] in self.rotations]
            assert ready, "a joint hangs in the air"
            for joint in ready:
                self._place(joint)
                joints.remove(joint)

    def _place(self, joint):
        parent, shift, turn = self._end(joint, "parent")
        child, child_shift, child_turn = self._end(joint, "child")
        rotation = self.rotations[parent] * turn
        place = self.translations[parent] + self.rotations[parent].apply(shift)
        moved, turned = self._moved(joint)
        place = place + rotation.apply(moved)
        rotation = rotation * turned * child_turn.inv()
        self.rotations[child] = rotation
        self.translations[child] = place - rotation.apply(child_shift)

    def _end(self, joint, which):
        name = joint.findtext(f"socket_{which}_frame")
        frame = joint.find(f"frames/PhysicalOffsetFrame[@name='{name}']")
        # OpenSim: orientation is a body-fixed x-y-z sequence
        turn = Rotation.from_euler("XYZ", numbers(frame, "orientation"))
        return frame.findtext("socket_parent"), numbers(frame, "translation"), turn

    def _moved(self, joint):
        names = [c.get("name") for c in joint.find("coordinates")]
        if joint.tag == "FreeJoint":
            self.used.update(names)
            q = np.stack([self.coordinates[name] for name in names], axis=1)
            return q[:, 3:], Rotation.from_euler("XYZ", q[:, :3])
        turned = Rotation.identity(len(self.coordinates["time"]))
        transform = joint.find("SpatialTransform")
        for k in (1, 2, 3):
            axis = transform.find(f"TransformAxis[@name='rotation{k}']")
            name = (axis.findtext("coordinates") or "").strip()
            if name:
                assert name in names
                slope, offset = numbers(axis.find("LinearFunction"), "coefficients")
                angle = slope * self.coordinates[name] + offset
                self.used.add(name)
            else:
                angle = np.full(
                    len(self.coordinates["time"]), numbers(axis.find("Constant"), "value")
                )
            turned = turned * Rotation.from_rotvec(angle[:, None] * numbers(axis, "axis"))
        return np.zeros(3), turned

    def markers(self):
        """Return label → (n_frames, 3) m in the ground."""
        placed = {}
        for marker in self.model.find("MarkerSet/objects"):
            body, at = marker.findtext("socket_parent_frame"), numbers(marker, "location")
            placed[marker.get("name")] = self.rotations[body].apply(at) + self.translations[body]
        return placed


@pytest.fixture(params=["performance", "odd", "gappy"])
def parameters(request):
    if request.param == "performance":
        return request.getfixturevalue("performance").parameters
    return request.getfixturevalue(f"{request.param}_parameters")


@pytest.fixture
def files(parameters, tmp_path):
    write(parameters.skeleton, tmp_path / "motion.osim")
    write(parameters, tmp_path / "motion.mot")
    return tmp_path / "motion.osim", tmp_path / "motion.mot"


def test_bodies_and_markers_are_where_the_parameters_have_them(parameters, files):
    played = Playback(files[0], coordinates := read_mot(files[1]))
    motion = motion_from_parameters(parameters)
    assert motion.seen.any(axis=0).sum() >= 10  # a joint of the gappy one is never known
    for i, limb in enumerate(motion.skeleton.limbs):
        seen = motion.seen[:, i]
        body = f"/bodyset/{limb.name}"
        assert_allclose(played.translations[body][seen], motion.origins[seen, i], atol=PLAYED_BACK)
        assert_allclose(
            played.rotations[body].as_matrix()[seen], motion.rotations[seen, i], atol=PLAYED_BACK
        )
    placed = played.markers()
    for label, positions in motion.marker_positions().items():
        seen = np.isfinite(positions).all(axis=1)
        assert_allclose(placed[label][seen], positions[seen], atol=PLAYED_BACK)
    assert {*played.used, "time"} == set(coordinates), "every column is a coordinate of the model"


def test_opensim_itself_agrees(parameters, files):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # its bindings are SWIG's
        osim = pytest.importorskip("opensim")
        osim.Logger.setLevelString("error")
        model = osim.Model(str(files[0]))
        state = model.initSystem()
        table = osim.TimeSeriesTable(str(files[1]))
    names, motion = list(table.getColumnLabels()), motion_from_parameters(parameters)
    markers = motion.marker_positions()
    for frame in range(4, parameters.n_frames, 14):
        row = table.getRowAtIndex(frame)
        for k, name in enumerate(names):
            translation = name.endswith(("_tx", "_ty", "_tz"))
            value = row[k] if translation else np.radians(row[k])
            model.getCoordinateSet().get(name).setValue(state, value, False)
        model.realizePosition(state)
        for i, limb in enumerate(motion.skeleton.limbs):
            if motion.seen[frame, i]:
                there = model.getBodySet().get(limb.name).getPositionInGround(state)
                at = [there[k] for k in range(3)]
                assert_allclose(at, motion.origins[frame, i], atol=PLAYED_BACK)
        for label, positions in markers.items():
            if np.isfinite(positions[frame]).all():
                there = model.getMarkerSet().get(label).getLocationInGround(state)
                assert_allclose([there[k] for k in range(3)], positions[frame], atol=PLAYED_BACK)


def test_opensim_opens_the_marker_file_of_the_model(performance, tmp_path):
    """TRC, model and coordinates together: the markers lie where the model carries them."""
    motion, parameters = performance.motion, performance.parameters
    placed = motion_from_parameters(parameters).marker_positions()
    recording = replace(
        performance.recording,
        markers=np.stack([placed[label] for label in placed], axis=1),
        labels=tuple(placed),
        residuals=None,
    )
    for name in ("motion.osim", "motion.mot", "motion.trc"):
        part = {"osim": motion.skeleton, "mot": parameters, "trc": recording}[name[7:]]
        write(parameters.skeleton if part is motion.skeleton else part, tmp_path / name)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        osim = pytest.importorskip("opensim")
        osim.Logger.setLevelString("error")
        model = osim.Model(str(tmp_path / "motion.osim"))
        state = model.initSystem()
        table = osim.TimeSeriesTable(str(tmp_path / "motion.mot"))
        trc = osim.TimeSeriesTableVec3(str(tmp_path / "motion.trc"))
    assert trc.getTableMetaDataString("Units") == "mm"
    assert trc.getNumRows() == table.getNumRows() == motion.n_frames
    names, labels = list(table.getColumnLabels()), list(trc.getColumnLabels())
    centres = motion.joint_centres()
    for frame in (0, 20, 74):
        values, points = table.getRowAtIndex(frame), trc.getRowAtIndex(frame)
        for k, name in enumerate(names):
            value = values[k] if name.endswith(("_tx", "_ty", "_tz")) else np.radians(values[k])
            model.getCoordinateSet().get(name).setValue(state, value, False)
        model.realizePosition(state)
        for k, label in enumerate(labels):
            there = model.getMarkerSet().get(label).getLocationInGround(state)
            found = [points.getElt(0, k)[i] / 1e3 for i in range(3)]
            assert_allclose([there[i] for i in range(3)], found, atol=1e-4)
        for j, joint in enumerate(motion.skeleton.joints):
            there = model.getJointSet().get(joint.name).getChildFrame().getPositionInGround(state)
            assert_allclose([there[i] for i in range(3)], centres[frame, j], atol=1e-4)


def test_the_files_say_what_their_numbers_mean(files):
    model, motion = (path.read_text(encoding="utf-8") for path in files)
    for text in (model, motion):
        assert "parent_from_child" in text
        assert "body-fixed" in text
    assert "Angles are in degrees." in motion


def test_gaps_hold_the_last_value_and_unknown_twists_are_zero(
    odd_parameters, gappy_parameters, tmp_path
):
    write_mot(odd_parameters, tmp_path / "whole.mot")
    write_mot(gappy_parameters, tmp_path / "gappy.mot")
    whole, gappy = read_mot(tmp_path / "whole.mot"), read_mot(tmp_path / "gappy.mot")
    joints = odd_parameters.skeleton.joint_names
    frames = np.arange(75)
    first = np.maximum(frames, 4)
    for name in ("trunk_tx", "trunk_ty", "trunk_tz"):
        assert_allclose(gappy[name], whole[name][first])
    assert_allclose(gappy[f"{joints[2]}_axis1"], 0)
    assert_allclose(gappy[f"{joints[2]}_twist"], 0)
    last = np.where((frames >= 30) & (frames < 37), 29, frames)
    for what in ("axis1", "axis2", "axis3", "twist"):
        assert_allclose(gappy[f"{joints[5]}_{what}"], whole[f"{joints[5]}_{what}"][last])
    unknown = (frames >= 50) & (frames < 60)
    twist = f"{joints[6]}_twist"
    assert_allclose(gappy[twist], np.where(unknown, 0, whole[twist]))
    assert_allclose(gappy[f"{joints[6]}_axis1"], whole[f"{joints[6]}_axis1"])


def test_no_joint_of_the_model_turns_twice_about_one_axis(odd_parameters):
    skeleton, sizes = odd_parameters.skeleton, []
    for j, joint in enumerate(skeleton.joints):
        groups = joint_turns(skeleton, j)
        sizes.append(len(groups))
        names = [turn.coordinate for group in groups for turn in group if turn.coordinate]
        assert len(names) == len(set(names)) == joint.n_axes + 1
        for group in groups:
            assert len(group) == 3
            axes = np.array([turn.axis for turn in group])
            assert_allclose(np.linalg.norm(axes, axis=1), 1)
            between = np.linalg.norm(np.cross(axes, np.roll(axes, 1, axis=0)), axis=1)
            assert between.min() >= LEAST_SINE
    assert sizes[0] == 1  # one axis, a twist and an idle third
    assert sizes[2] == 2  # three axes and a twist
    assert sizes[4] == 2  # the axes share directions
    assert sizes[7] == 2


@pytest.mark.parametrize(("apart_deg", "n_joints"), [(2.5, 2), (3.5, 1)])
def test_axes_within_three_degrees_do_not_share_a_joint(performance, apart_deg, n_joints):
    skeleton = performance.skeleton
    j = skeleton.joint_names.index("left_hip")
    axes = Rotation.from_euler("y", [[0.0], [apart_deg]], degrees=True).apply([0.0, 0.0, 1.0])
    joints = [replace(joint, axes=axes, axes_uncertainty=None) for joint in skeleton.joints]
    assert len(joint_turns(replace(skeleton, joints=tuple(joints)), j)) == n_joints


def test_names_opensim_refuses_are_changed_alike_everywhere(performance, tmp_path):
    limbs = list(performance.skeleton.limbs)
    limbs[0] = replace(limbs[0], markers=("C 7", "a/b", *limbs[0].markers[2:]))
    write_osim(replace(performance.skeleton, limbs=tuple(limbs)), tmp_path / "a.osim")
    assert read_segments(tmp_path / "a.osim")["trunk"][:2] == ("C_7", "a_b")


def test_the_model_tells_which_marker_sits_where(performance, tmp_path):
    write_osim(performance.skeleton, tmp_path / "a.osim")
    expected = {limb.name: limb.markers for limb in performance.skeleton.limbs if limb.markers}
    assert read_segments(tmp_path / "a.osim") == expected


def test_joints_without_axes_are_refused(performance, tmp_path):
    joints = list(performance.skeleton.joints)
    joints[3] = replace(joints[3], axes=None, axes_uncertainty=None)
    with pytest.raises(BadModel, match=f"{joints[3].name} has no movement axes"):
        write_osim(replace(performance.skeleton, joints=tuple(joints)), tmp_path / "a.osim")
    assert not list(tmp_path.iterdir())
