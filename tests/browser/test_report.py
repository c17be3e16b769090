"""The report as a person meets it: it plays, scrubs, picks and prints, and asks nobody."""

import pytest

from kinesphere.io import read
from kinesphere.pipeline import solve
from kinesphere.report import report_html

pytestmark = pytest.mark.slow

SEEN = "canvas => canvas.toDataURL()"
PAINTED = """canvas => {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  return data.some((value, i) => i % 4 === 3 && value > 0);
}"""
ON_SCREEN = """([kind, index]) => {
  const player = document.querySelector("#stage").player;
  const at = kind === "joint"
    ? player.jointCentre(index, player.posesNow) : player.point("markers", index, player.frame);
  const [x, y] = player.camera.project(at);
  const box = document.querySelector("#stage").getBoundingClientRect();
  return [x + box.x, y + box.y];
}"""


@pytest.fixture
def report(watch, solved):
    def opened(**options):
        before = options.pop("before", "")
        watched = watch(**options)
        if before:
            watched.page.add_init_script(before)
        watched.page.goto((solved / "report.html").as_uri())
        watched.page.wait_for_selector("body.ready")
        return watched

    return opened


def frame(page):
    return int(page.locator("#frame").inner_text().removeprefix("frame "))


def picked(page):
    return page.locator("#pick option:checked").inner_text()


def stage(page):
    return page.locator("#stage").evaluate(SEEN)


def test_it_opens_offline_without_a_complaint(report, solved):
    watched = report(offline=True)
    assert watched.complaints == []
    assert watched.requests == [(solved / "report.html").as_uri()]
    assert not watched.page.locator("#failed").is_visible()
    assert watched.page.locator("#stage").evaluate(PAINTED)
    assert watched.page.locator("#heat canvas").evaluate(PAINTED)


def test_it_plays_and_pauses(report, until):
    page = report().page
    first, still = frame(page), stage(page)
    page.get_by_role("button", name="Play").click()
    until(lambda: frame(page) > first + 2)
    page.keyboard.press("Space")  # the button has the focus: the key is its own
    stopped = frame(page)
    page.wait_for_timeout(150)
    assert frame(page) == stopped > first
    assert stage(page) != still
    assert page.get_by_role("button", name="Play").is_visible()


def test_it_scrubs_by_slider_curve_and_key(report):
    page = report().page
    page.locator("#time").fill("100")
    assert frame(page) == 101
    page.keyboard.press("ArrowRight")
    assert frame(page) == 102
    page.locator("h1").click()
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("ArrowLeft")
    assert frame(page) == 100
    page.keyboard.press("Shift+ArrowRight")
    assert frame(page) == 120
    page.keyboard.press("End")
    last = frame(page)
    page.locator(".chart canvas").first.click(position={"x": 60, "y": 60})
    assert 1 < frame(page) < last / 2
    page.locator("#heat canvas").click(position={"x": 300, "y": 40})
    assert frame(page) > 1


def test_a_click_picks_a_joint_and_its_curves(report, solution):
    watched = report()
    page = watched.page
    names = solution.skeleton.joint_names
    elbow = names.index("left_elbow")
    page.mouse.click(*page.evaluate(ON_SCREEN, ["joint", elbow]))
    assert picked(page) == "left elbow"
    assert page.locator(f'.chart[data-joint="{elbow}"]').evaluate(
        "e => e.classList.contains('picked')"
    )
    told = page.locator("#told").inner_text()
    shown = solution.parameters.angles[frame(page) - 1, elbow, 0]
    assert told.startswith(f"axis 1 {shown * 57.29577951:.1f}°")
    assert watched.complaints == []


def test_a_click_picks_a_marker_and_shows_where_it_goes(report, solution):
    page = report().page
    assert not page.locator("#track").is_visible()
    label = solution.skeleton.limbs[-1].markers[-1]
    page.locator("#pick").select_option(label=label)
    assert page.locator("#track canvas").evaluate(PAINTED)
    x, y, z = solution.recording.markers[frame(page) - 1, solution.recording.labels.index(label)]
    assert page.locator("#told").inner_text() == (
        f"x {1000 * x:.0f} · y {1000 * y:.0f} · z {1000 * z:.0f} mm"
    )
    page.keyboard.press("Escape")
    assert not page.locator("#track").is_visible()


def test_everything_is_at_hand_by_keyboard(report, solution):
    page = report().page
    names = [name.replace("_", " ") for name in solution.skeleton.joint_names]
    page.keyboard.press("j")
    assert picked(page) == names[0]
    page.keyboard.press("Shift+J")
    assert picked(page) == names[-1]
    page.keyboard.press("Escape")
    assert picked(page) == "Nothing picked"
    for key, name in (("x", "axes"), ("f", "frames"), ("m", "markers"), ("b", "bones")):
        button = page.locator(f'[data-show="{name}"]')
        before, seen = button.get_attribute("aria-pressed"), stage(page)
        page.keyboard.press(key)
        assert button.get_attribute("aria-pressed") != before
        assert stage(page) != seen
    for key in ("a", "w", "+"):
        seen = stage(page)
        page.keyboard.press(key)
        assert stage(page) != seen
    page.keyboard.press(".")
    assert page.locator("#speed").input_value() == "2"
    page.keyboard.press(" ")
    page.wait_for_selector("#play.on")


def test_gaps_are_listed_and_can_be_gone_to(report, solution):
    page = report().page
    label = solution.recording.labels[3]
    moment = page.locator(".moments button", has_text=f"{label} unseen")
    assert "15 frames" in moment.inner_text()
    moment.click()
    assert frame(page) == 61
    assert picked(page) == label
    assert page.locator("#told").inner_text() == "unseen"
    page.keyboard.press("Home")
    page.keyboard.press("]")
    assert frame(page) > 1


def test_dragging_turns_and_picks_nothing(report):
    page = report().page
    box = page.locator("#stage").bounding_box()
    seen = stage(page)
    page.mouse.move(box["x"] + 240, box["y"] + 200)
    page.mouse.down()
    page.mouse.move(box["x"] + 320, box["y"] + 210, steps=3)
    page.mouse.up()
    assert stage(page) != seen
    assert picked(page) == "Nothing picked"


def test_light_and_dark(report, until):
    page = report(color_scheme="light").page
    ground = "getComputedStyle(document.body).backgroundColor"
    light, seen = page.evaluate(ground), stage(page)
    page.emulate_media(color_scheme="dark")
    until(lambda: page.evaluate(ground) != light)
    until(lambda: stage(page) != seen)
    assert sum(map(int, page.evaluate(ground)[4:-1].split(","))) < 3 * 60


def test_paper_is_light_and_shows_every_curve(report):
    page = report(color_scheme="dark").page
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    page.emulate_media(media="print")
    charts = page.locator(".chart canvas")
    assert all(charts.nth(i).evaluate(PAINTED) for i in range(charts.count()))
    assert page.locator("details:not([open])").count() == 0
    assert page.evaluate("themeFromStyles().text") == "#161a22"
    page.emulate_media(media="screen")
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert page.locator("details:not([open])").count() > 0
    assert len(page.pdf()) > 10_000


def test_a_phone_scrolls_one_way_only(report):
    page = report(viewport={"width": 390, "height": 844}, has_touch=True).page
    wide = "document.documentElement.scrollWidth"
    assert page.evaluate(wide) <= 390


NO_WEBGL = """
const had = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
  return kind.startsWith("webgl") ? null : had.call(this, kind, ...rest);
};
"""


def test_the_body_is_shown_where_the_browser_can(report):
    watched = report()
    body = watched.page.locator('[data-show="mesh"]')
    assert body.get_attribute("aria-pressed") == "true"
    seen = stage(watched.page)
    watched.page.keyboard.press("o")
    assert body.get_attribute("aria-pressed") == "false"
    assert stage(watched.page) != seen
    without = report(before=NO_WEBGL)
    assert without.complaints == []
    assert not without.page.locator('[data-show="mesh"]').is_visible()
    assert without.page.locator("#stage").evaluate(PAINTED)


@pytest.mark.real
def test_a_real_recording_opens_without_a_complaint(watch, recordings, tmp_path, until):
    recording = read(recordings / "plugin-gait" / "PiG_Motion-FlatFoot-Full.c3d")
    solved = solve(recording)
    path = tmp_path / "report.html"
    path.write_text(report_html(solved, "walk"), encoding="utf-8")
    watched = watch()
    watched.page.goto(path.as_uri())
    watched.page.wait_for_selector("body.ready")
    first = frame(watched.page)
    assert first == recording.first_frame > 1
    watched.page.locator(".moments .event").first.click()
    assert frame(watched.page) > first
    watched.page.locator("h1").click()  # a button that has the focus keeps the key
    watched.page.keyboard.press("Space")
    moved = frame(watched.page)
    until(lambda: frame(watched.page) != moved)
    assert watched.complaints == []
