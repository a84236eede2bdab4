"""Takes the pictures in docs/images: RViz and a browser on screens that nobody sees.

Run by ``./run pictures``. Every picture is of the same tour, which has a segment of every kind.
"""

from __future__ import annotations

import os
import subprocess
import tempfile
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import rosgraph
import rospy
from selenium import webdriver
from selenium.webdriver.support.ui import WebDriverWait

from youbot_kinematics.nodes.demo import START_UP, Launch, Recorder
from youbot_kinematics.page import write_page
from youbot_kinematics.planner import plan
from youbot_kinematics.plot import plot_plan
from youbot_kinematics.resources import resource_path
from youbot_kinematics.targets import load_targets

BAG = str(resource_path("bags/all_kinds.bag"))
IMAGES = Path(__file__).resolve().parent / "images"
WIDTH, HEIGHT = 1280, 860
#: s after the arm began to move: in the detour, on the way to the last target.
MOMENT = 13.4


def main() -> None:
    planned = plan(load_targets(BAG), np.zeros(5))
    plot_plan(planned, IMAGES / "plan.png", force=True)
    take_page(planned, IMAGES / "page.png")
    take_rviz(IMAGES / "rviz.png")
    for path in sorted(IMAGES.glob("*.png")):
        print(f"{path} {path.stat().st_size // 1000} kB")


def take_page(planned, picture: Path) -> None:
    """The page of a plan in Chromium, with its slider at the moment."""
    with tempfile.TemporaryDirectory() as folder, browser() as chromium:
        write_page(Path(folder, "plan.html"), planned)
        chromium.get(Path(folder, "plan.html").as_uri())
        wait = WebDriverWait(chromium, START_UP)
        wait.until(lambda it: it.execute_script("return document.body.dataset.ready"))
        chromium.execute_script("goTo(arguments[0])", MOMENT)
        chromium.execute_async_script("requestAnimationFrame(() => setTimeout(arguments[0], 1000))")
        chromium.save_screenshot(str(picture))


@contextmanager
def browser():
    """Debian's Chromium without a window; its own driver, so that none is looked for elsewhere."""
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    for argument in ("headless=new", "no-sandbox", "enable-unsafe-swiftshader"):
        options.add_argument(f"--{argument}")
    options.add_argument(f"--window-size={WIDTH + 120},{HEIGHT + 400}")
    chromium = webdriver.Chrome(options, webdriver.ChromeService("/usr/bin/chromedriver"))
    try:
        yield chromium
    finally:
        chromium.quit()


def take_rviz(picture: Path) -> None:
    """``demo.launch`` with RViz, while the simulated arm is on its way."""
    os.environ.update(LIBGL_ALWAYS_SOFTWARE="1", QT_X11_NO_MITSHM="1")
    with virtual_screen(), Launch("rviz:=true", f"bag:={BAG}") as launch:
        launch.wait_for(lambda: rosgraph.is_master_online() or None, START_UP, "ROS master")
        rospy.init_node("pictures", anonymous=True, disable_signals=True)
        recorder = Recorder()
        launch.wait_for(recorder.first, START_UP, "joint states")
        launch.wait_for(lambda: moving_for(recorder, MOMENT), START_UP, "motion")
        subprocess.run(["import", "-window", "root", str(picture)], check=True)


def moving_for(recorder: Recorder, seconds: float):
    """True once the arm has been on its way for so long, None before."""
    times, _ = recorder.motion()
    return True if times[-1] > seconds else None


@contextmanager
def virtual_screen():
    """An X server with a screen in memory, on a display that is free."""
    read, write = os.pipe()
    screen = ["-screen", "0", f"{WIDTH}x{HEIGHT}x24", "-nolisten", "tcp"]
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), *screen], pass_fds=[write], stderr=subprocess.DEVNULL
    )
    os.close(write)
    try:
        with os.fdopen(read) as number:
            os.environ["DISPLAY"] = f":{number.readline().strip()}"
        yield
    finally:
        server.terminate()
        server.wait()


if __name__ == "__main__":
    main()
