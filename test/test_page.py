"""The page of a plan: what is in it, and what a browser makes of it.

The browser's tests need Debian's chromium and chromium-driver; ``./run test`` installs them.
"""

import dataclasses
import json
import re
import shutil
import sys

import numpy as np
import pytest

from youbot_kinematics import plan_bag
from youbot_kinematics.exceptions import InputError
from youbot_kinematics.kinematics import YoubotKinematics
from youbot_kinematics.page import page_data, write_page
from youbot_kinematics.planner import plan
from youbot_kinematics.resources import resource_path
from youbot_kinematics.targets import load_targets

pytest.importorskip("plotly")
pytest.importorskip("urdf_parser_py")

CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
SPITEFUL = "</script><script>document.title='taken'</script> {{script}} $& &amp;"


@pytest.fixture(scope="module")
def planned():
    return plan(load_targets(str(resource_path("bags/all_kinds.bag"))), np.zeros(5))


@pytest.fixture(scope="module")
def page(planned, tmp_path_factory):
    targets = dataclasses.replace(planned.targets, source=SPITEFUL)
    path = tmp_path_factory.mktemp("page") / "plan.html"
    write_page(path, dataclasses.replace(planned, targets=targets))
    return path


# What is in it


def test_the_data_are_json_and_as_many_for_every_moment(planned):
    data = json.loads(json.dumps(page_data(planned), allow_nan=False))
    n = len(data["times"])
    assert data["times"][-1] == pytest.approx(planned.trajectory.duration)
    for values in (data["frames"], data["distance"], data["singular_value"]):
        assert len(values) == n
    assert [len(q) for q in data["joints"]["positions"]] == [n] * 5


def test_the_tool_of_every_moment_is_where_the_joints_put_it(planned):
    data = page_data(planned)
    joints = np.array(data["joints"]["positions"]).T
    tool = np.array(data["frames"])[:, 5, :, 3]
    expected = YoubotKinematics().forward_kinematics(joints)[:, :3, 3]
    np.testing.assert_allclose(tool, expected, atol=2e-5)


def test_all_segments_and_the_whole_report_are_there(planned):
    data = page_data(planned)
    assert [s["kind"] for s in data["segments"]] == [s.kind for s in planned.trajectory.segments]
    assert set(planned.report.rows()) <= set(data["report"])


def test_the_distance_is_known_on_lines_only(planned):
    data = page_data(planned)
    for time, distance in zip(data["times"], data["distance"]):
        kinds = [s.kind for s in planned.trajectory.segments if s.start < time < s.end]
        if kinds:
            assert (distance is None) == (kinds != ["line"])


def test_the_page_loads_nothing_from_elsewhere(page):
    text = page.read_text(encoding="utf-8")
    own = re.sub(r"<script>/\*\*.*?</script>", "", text, count=1, flags=re.DOTALL)  # plotly.js
    assert len(own) < len(text) / 2
    assert "http" not in own and "src=" not in own


def test_plan_bag_writes_it(tmp_path, capsys):
    path = tmp_path / "plan.html"
    assert plan_bag.main([str(resource_path("bags/demo.bag")), "--report", str(path)]) == 0
    assert str(path) in capsys.readouterr().out
    assert "5 targets from demo.bag" in path.read_text(encoding="utf-8")


def test_names_of_other_files_and_files_that_exist_are_refused(planned, tmp_path):
    (tmp_path / "plan.html").write_text("mine")
    with pytest.raises(InputError, match="--force"):
        write_page(tmp_path / "plan.html", planned)
    with pytest.raises(InputError, match=r"\.html"):
        write_page(tmp_path / "plan.pdf", planned)
    assert [path.read_text() for path in tmp_path.iterdir()] == ["mine"]


def test_without_plotly_the_sentence_says_what_to_install(planned, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "plotly.offline", None)
    with pytest.raises(InputError, match="pip install plotly"):
        write_page(tmp_path / "plan.html", planned)


# What a browser makes of it


@pytest.fixture(scope="module")
def chromium(page):
    webdriver = pytest.importorskip("selenium.webdriver")
    if not (CHROMIUM and DRIVER):
        pytest.skip("needs chromium and chromedriver")
    options = webdriver.ChromeOptions()
    options.binary_location = CHROMIUM
    # No sandbox: containers have none. SwiftShader draws in 3-D where there is no graphics card.
    for argument in ("headless=new", "no-sandbox", "enable-unsafe-swiftshader"):
        options.add_argument(f"--{argument}")
    for argument in ("disable-background-networking", "window-size=800,600"):
        options.add_argument(f"--{argument}")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    browser = webdriver.Chrome(options=options, service=webdriver.ChromeService(DRIVER))
    browser.set_script_timeout(60)
    try:
        browser.get(page.as_uri())
        wait_until(browser, lambda it: it.execute_script("return document.body.dataset.ready"))
        yield browser
    finally:
        browser.quit()


@pytest.fixture
def opened(chromium):
    """The page with its slider at the start."""
    chromium.execute_script("goTo(0)")
    return chromium


def wait_until(browser, condition):
    """Waits for a condition of the browser, for a minute at most."""
    pytest.importorskip("selenium.webdriver.support.ui").WebDriverWait(browser, 60).until(condition)


def shown(browser):
    """What the page shows: the slider's moment, the cursor of the plots, the middle of the arm."""
    return browser.execute_script(
        """const mesh = document.getElementById("scene").data[0];
        const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;
        return [Number(document.getElementById("time").value),
                document.getElementById("plots").layout.shapes[0].x0,
                [mean(mesh.x), mean(mesh.y), mean(mesh.z)]];"""
    )


def scene_picture(browser):
    """A picture of the arm as it is on the screen, once it is drawn, as bytes of a PNG."""
    browser.execute_async_script("requestAnimationFrame(() => setTimeout(arguments[0], 500))")
    return browser.find_element("id", "scene").screenshot_as_png


def test_the_page_opens_without_an_error_and_shows_the_names_as_they_are(opened):
    errors = [entry for entry in opened.get_log("browser") if entry["level"] == "SEVERE"]
    assert errors == []
    assert opened.title == "youBot plan"
    assert opened.find_element("id", "title").text == f"4 targets from {SPITEFUL}"


def test_the_page_asks_the_network_for_nothing(opened):
    loaded = "return performance.getEntriesByType('resource').map((entry) => entry.name)"
    assert [name for name in opened.execute_script(loaded) if not name.startswith("data:")] == []


def test_the_slider_moves_the_arm_and_the_cursor(opened, planned):
    before, picture = shown(opened), scene_picture(opened)
    opened.find_element("id", "time").send_keys("\ue010")  # the end key
    moment, cursor, middle = shown(opened)
    assert before[0] == before[1] == 0 and moment > 0
    assert cursor == pytest.approx(planned.trajectory.duration)
    assert np.linalg.norm(np.subtract(middle, before[2])) > 0.05
    assert scene_picture(opened) != picture


def test_the_play_button_runs_the_arm_and_stops_it(opened):
    button = opened.find_element("id", "play")
    opened.find_element("id", "speed").send_keys("\u00bc")  # or it may be over before it is stopped
    button.click()
    wait_until(opened, lambda browser: shown(browser)[0] > 5)
    assert button.text == "pause"
    button.click()
    stopped = shown(opened)
    scene_picture(opened)
    assert button.text == "play" and shown(opened) == stopped


def test_a_click_on_a_segment_goes_to_its_beginning(opened, planned):
    rows = opened.find_elements("css selector", "#segments tbody tr")
    assert len(rows) == len(planned.trajectory.segments)
    rows[-1].click()
    assert shown(opened)[1] == pytest.approx(planned.trajectory.segments[-1].start, abs=0.02)
    assert rows[-1].get_attribute("aria-current") == "true"


def test_the_view_turned_by_the_mouse_stays_turned_while_the_arm_moves(opened):
    before = steady_eye(opened)
    turned = next(filter(lambda eye: abs(eye[0] - before[0]) > 0.1, drags(opened)))
    opened.find_element("id", "time").send_keys("\ue010")
    scene_picture(opened)
    assert steady_eye(opened) == pytest.approx(turned, abs=1e-6)


def drags(browser):
    """Drags the scene with the mouse, and yields where the eye is then.

    Again and again, since a busy machine may draw too seldom to see a drag between two frames.
    """
    scene = browser.find_element("id", "scene")
    for _ in range(8):
        actions = pytest.importorskip("selenium.webdriver").ActionChains(browser)
        actions.move_to_element(scene).click_and_hold()
        for _ in range(3):
            actions.move_by_offset(30, 10).pause(0.2)
        actions.release().perform()
        yield steady_eye(browser)


def steady_eye(browser):
    """Where the eye of the scene is, x, y and z, once it no longer glides."""
    script = """const layout = document.getElementById('scene')._fullLayout
                const eye = layout.scene._scene.getCamera().eye
                return [eye.x, eye.y, eye.z]"""
    eye, last = browser.execute_script(script), None
    for _ in range(20):
        if eye == last:
            break
        scene_picture(browser)
        eye, last = browser.execute_script(script), eye
    return eye
