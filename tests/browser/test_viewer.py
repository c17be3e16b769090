"""The viewer as a person meets it, and what it saves as ``kinesphere edit`` applies it."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.cli.main import run
from kinesphere.io import read, read_edits, write
from kinesphere.viewer import serve, take_from

pytestmark = pytest.mark.slow

SAME = 1e-9
LOCAL = "127.0.0.1"
DRAWN_MS = 400
"""A few pictures, drawn by software."""


@pytest.fixture
def view(watch, tmp_path):  # a small page: software draws it
    """Return a function that serves a file or folder and opens its page."""
    servers = []

    def opened(path, dark=False, **options):
        edits = tmp_path / "EDITS.toml"
        before = read_edits(edits) if edits.exists() else ()
        server, viewer = serve(
            take_from(read(path), path.name), path.name, edits, before, dark=dark
        )
        servers.append((server, viewer))
        watched = watch(viewport={"width": 880, "height": 620}, **options)
        watched.page.goto(f"http://{LOCAL}:{server.get_port()}")
        watched.page.get_by_role("button", name="Play").wait_for(timeout=60_000)
        watched.viewer, watched.server, watched.edits = viewer, server, edits
        return watched

    yield opened
    for server, viewer in servers:
        viewer.stop()
        server.stop()


def field(page, label):
    """Return the box one types into beside a label."""
    row = f"xpath=//label[normalize-space()='{label}']/ancestor::*[.//input][1]//input"
    return page.locator(row).locator("visible=true").last


def type_in(watched, label, value, done):
    """Type a number beside a label until it has arrived: a page that is busy loses keys."""
    page = watched.page

    def typed():
        if done():
            return True
        box = field(page, label)
        box.fill(str(value))
        box.press("Enter")
        box.blur()
        for _ in range(10):
            page.wait_for_timeout(DRAWN_MS / 2)
            if done():
                return True
        return False

    watched.until(typed)


def choose(watched, label, option):
    field(watched.page, label).click()
    watched.page.get_by_role("option", name=option, exact=True).click()


def bend_the_elbow(watched):
    posing, panel = watched.viewer.posing, watched.viewer.panel
    choose(watched, "Joint", "left_elbow")
    watched.until(lambda: posing.axes == (1, "twist"))
    choose(watched, "Change", "from – to")
    watched.until(lambda: panel.scope.value == "from – to")
    type_in(watched, "from", 100, lambda: panel.start.value == 100)
    type_in(watched, "to", 200, lambda: panel.end.value == 200)
    type_in(watched, "Frame", 150, lambda: watched.viewer.frame == 149)
    type_in(watched, "axis 1 (°)", 30, lambda: [e.add_deg for e in posing.session.edits] == [30.0])


def test_an_elbow_bent_undone_redone_saved_and_applied(view, solved, tmp_path):
    watched = view(solved)
    page, viewer = watched.page, watched.viewer
    before = read(solved)
    bend_the_elbow(watched)
    page.get_by_text("left elbow, axis 1: +30°, frames 100–200").wait_for()

    poses = viewer.take.poses
    bent = poses.at(149)[0]
    assert not np.allclose(bent, before.motion.rotations[149])
    page.get_by_role("button", name="Undo").click()
    watched.until(lambda: viewer.posing.session.edits == ())
    assert_array_equal(poses.at(149)[0], before.motion.rotations[149])
    page.keyboard.press("Control+Shift+Z")
    watched.until(lambda: len(viewer.posing.session.edits) == 1)
    assert_array_equal(poses.at(149)[0], bent)
    page.get_by_role("button", name="Save edits").click()
    watched.until(watched.edits.exists)
    watched.until(lambda: viewer.unsaved == ())

    again = view(solved)
    again.page.get_by_text("left elbow, axis 1: +30°, frames 100–200").wait_for()
    assert again.viewer.unsaved == ()

    code = run(["edit", str(solved), "--apply", str(watched.edits), "-o", str(tmp_path / "bent")])
    assert code == 0
    after = read(tmp_path / "bent")
    j = before.skeleton.joint_names.index("left_elbow")
    added = np.rad2deg(after.parameters.angles[:, j, 0] - before.parameters.angles[:, j, 0])
    assert_allclose(added[99:200], 30.0, atol=SAME)
    shown = [poses.at(frame) for frame in range(before.motion.n_frames)]
    for k, kept in enumerate(
        (after.motion.rotations, after.motion.origins, after.recording.markers)
    ):
        assert_allclose(np.array([pose[k] for pose in shown]), kept, atol=SAME)
    assert [c for c in watched.complaints if "THREE" not in c] == []
    local = (f"http://{LOCAL}", f"ws://{LOCAL}", "data:", "blob:")
    assert [r for r in watched.requests if not r.startswith(local)] == []


def on_screen(server, point):
    """Return where a point of the world is on the page, as its camera says."""
    (client,) = server.get_clients().values()
    camera = client.camera
    w, x, y, z = camera.wxyz
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    right, down, ahead = turn.T @ (point - camera.position)
    focal = camera.image_height / 2 / np.tan(camera.fov / 2)
    return (
        camera.image_width / 2 + focal * right / ahead,
        camera.image_height / 2 + focal * down / ahead,
    )


def test_a_bone_is_picked_by_a_click_and_turned_by_its_ring(view, solved):
    watched = view(solved)
    page, viewer, server = watched.page, watched.viewer, watched.server
    posing, skeleton = viewer.posing, viewer.take.skeleton
    watched.until(lambda: any(c.camera.image_height for c in server.get_clients().values()))
    limb = skeleton.limb_names.index("right_thigh")
    rotations, origins, _ = viewer.take.at(0)
    placed = viewer.stage.figure.sticks(rotations, origins)
    (stick,) = np.flatnonzero(viewer.stage.figure.stick_limbs == limb)
    along = rotations[limb] @ skeleton.limbs[limb].long_axis
    middle = placed.positions[stick] + 0.4 * placed.scales[stick, 0] * along

    def click():
        page.mouse.click(*on_screen(server, middle))
        page.wait_for_timeout(DRAWN_MS)
        return posing.joint == limb - 1

    watched.until(click)  # once the first picture is there, which software takes its time for
    watched.until(lambda: field(page, "Joint").input_value() == skeleton.joint_names[limb - 1])

    (client,) = server.get_clients().values()
    rings = posing.handles
    sight = client.camera.position - rings.point_on(0, 0.0)
    # the ring that faces the eye most, where nothing is before it
    k = int(np.argmax([abs(way @ sight) for way in rings.ways]))
    turns = np.linspace(0, 2 * np.pi, 24)
    lowest = max(turns, key=lambda a: on_screen(server, rings.point_on(k, a))[1])
    start, end = (on_screen(server, rings.point_on(k, lowest + a)) for a in (0.3, 1.0))

    def drag():
        page.mouse.move(*start)
        page.wait_for_timeout(DRAWN_MS)
        page.mouse.down()
        page.mouse.move(*end, steps=8)
        page.wait_for_timeout(DRAWN_MS)
        page.mouse.up()
        page.wait_for_timeout(DRAWN_MS)
        return posing.session.edits

    page.wait_for_timeout(2 * DRAWN_MS)
    watched.until(drag)
    watched.until(lambda: posing.session.held is None)
    (edit,) = posing.session.edits
    assert (edit.joint, edit.axis) == (skeleton.joint_names[limb - 1], posing.axes[k])
    assert edit.add_deg == pytest.approx(np.rad2deg(0.7), abs=5)  # the hand is sure to some pixels
    assert len(posing.session.past) == 1


def test_it_plays_and_shows_what_is_asked_for(view, solved):
    watched = view(solved, dark=True)
    page, viewer = watched.page, watched.viewer
    page.get_by_role("button", name="Play").click()
    watched.until(lambda: viewer.frame > 10 and viewer.shown > 5)
    page.get_by_role("button", name="Pause").click()
    watched.until(lambda: not viewer.playing)
    for label, kind in (("Movement axes", "axes"), ("Limb frames", "frames")):
        page.get_by_role("checkbox", name=label).check()
        watched.until(lambda kind=kind: viewer.stage.kinds[kind])
    page.get_by_role("checkbox", name="Markers").uncheck()
    watched.until(lambda: not viewer.stage.kinds["markers"])


def test_the_root_is_moved_too(view, solved):
    watched = view(solved)
    viewer = watched.viewer
    choose(watched, "Joint", "root")
    choose(watched, "Change", "all frames")
    watched.until(lambda: len(viewer.posing.axes) == 6)
    type_in(
        watched,
        "shift y (m)",
        0.25,
        lambda: [e.add_m for e in viewer.posing.session.edits] == [0.25],
    )
    before = viewer.take.solution.motion.origins
    assert_allclose(viewer.take.at(7)[1], before[7] + (0, 0.25, 0), atol=SAME)


def test_a_bare_recording_shows_its_markers(view, solution, tmp_path):
    path = tmp_path / "walk.c3d"
    write(solution.recording, path)
    watched = view(path)
    assert watched.viewer.posing is None
    assert watched.page.get_by_text("Pose", exact=True).count() == 0
    type_in(watched, "Frame", 20, lambda: watched.viewer.frame == 19)


def test_a_motion_of_another_program_shows_its_skeleton(view, solution, tmp_path):
    path = tmp_path / "walk.bvh"
    write(solution.motion, path)
    watched = view(path)
    assert watched.page.get_by_text("Pose", exact=True).count() == 0
    watched.page.get_by_role("checkbox", name="Limb frames").check()
    watched.until(lambda: watched.viewer.stage.kinds.get("frames"))
    type_in(watched, "Frame", 20, lambda: watched.viewer.frame == 19)
    assert watched.viewer.stage.kinds == {"skeleton": True, "frames": True}
