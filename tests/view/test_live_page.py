"""The live viewer in a real browser: what a person sees while a spec is edited."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.view.conftest import OPTIONS
from tests.view.viewer import Viewer

SPEC = """\
linkforge: 1
name: arm
parameters:
  reach: {type: length, default: 1 m, minimum: 10 cm, maximum: 3 m}
links:
  base: {visual: {box: [10 cm, 10 cm, $(reach)]}}
  hand: {visual: {sphere: 5 cm}}
joints:
  turn:
    type: revolute
    parent: base
    child: hand
    axis: z
    origin: [0, 0, $(reach)]
    limits: {lower: -90 deg, upper: 90 deg, effort: 1 N*m, velocity: 1 rad/s}
"""

pytestmark = [
    pytest.mark.usefixtures("page"),
    pytest.mark.skipif(sys.platform != "linux", reason="the browser of CI is that of Linux"),
]


@pytest.fixture
def spec(tmp_path: Path) -> Path:
    path = tmp_path / "arm.robot.yaml"
    path.write_text(SPEC)
    return path


@pytest.fixture
def viewer(spec: Path) -> Iterator[Viewer]:
    viewer = Viewer(spec.name, cwd=spec.parent)
    yield viewer
    viewer.close()


@pytest.fixture
def tab(new_tab: Callable[[], Page], viewer: Viewer) -> Page:
    """A tab with the viewer; the test fails if it asks another machine, or reports an error."""
    tab = new_tab()
    open_viewer(tab, viewer)
    return tab


def open_viewer(tab: Page, viewer: Viewer) -> None:
    tab.goto(viewer.url)
    tab.evaluate("window.linkforge.ready")


def wait_until_hand_is_at(tab: Page, height: float) -> None:
    """Wait until the link `hand` is at a height in the world [m]."""
    has_hand = "window.linkforge.scene().links.some(({name}) => name === 'hand')"
    is_there = "Math.abs(window.linkforge.transform('hand')[11] - height) < 1e-6"
    tab.wait_for_function(f"height => {has_hand} && {is_there}", arg=height)


def test_an_edit_moves_a_link_and_the_joints_stay_where_they_are(tab: Page, spec: Path):
    wait_until_hand_is_at(tab, 1)
    tab.evaluate("window.linkforge.set({turn: 0.5})")
    spec.write_text(SPEC.replace("default: 1 m", "default: 2 m"))
    wait_until_hand_is_at(tab, 2)
    assert tab.evaluate("window.linkforge.positions()") == {"turn": 0.5}


def test_faults_are_shown_over_the_last_robot_until_they_are_corrected(tab: Page, spec: Path):
    problems = tab.locator(".problems")
    expect(problems).to_be_hidden()
    spec.write_text(SPEC.replace("child: hand", "child: hnd"))
    expect(problems).to_be_visible()
    expect(problems).to_contain_text("no link named 'hnd'; did you mean 'hand'?")
    expect(problems).to_contain_text("LF4102")
    expect(problems).to_contain_text(f"{spec.name}:12:12")
    expect(problems).to_contain_text("showing the last robot without errors")
    wait_until_hand_is_at(tab, 1)
    with tab.expect_popup() as manual:
        problems.get_by_role("link", name="LF4102").click()
    expect(manual.value.locator("body")).to_contain_text("# LF4102")
    spec.write_text(SPEC)
    expect(problems).to_be_hidden()


def test_texts_of_a_spec_are_no_elements_of_the_page(tab: Page, spec: Path):
    element = "<img src=x onerror=document.title=1>"
    spec.write_text(f"{SPEC.replace('default: 1 m', f'description: {element}, default: 1 m')}  '{element}': {{}}\n")
    expect(tab.locator(".problems")).to_contain_text(element)
    expect(tab.locator("[data-parameter=reach]")).to_be_visible()
    assert tab.locator("img").count() == 0
    assert tab.title() == "arm"


def test_a_parameter_changes_the_robot_in_all_tabs(tab: Page, new_tab: Callable[[], Page], viewer: Viewer):
    other = new_tab()
    open_viewer(other, viewer)
    reach = tab.locator("[data-parameter=reach] input[name=reach]")
    reach.fill("2.5 m")
    reach.press("Enter")
    for page in (tab, other):
        wait_until_hand_is_at(page, 2.5)
        expect(page.locator("[data-parameter=reach] input[name=reach]")).to_have_value("2.5 m")


def test_a_value_that_the_spec_refuses_is_a_problem_and_the_robot_stays(tab: Page):
    reach = tab.locator("[data-parameter=reach] input[name=reach]")
    reach.fill("3 kg")
    reach.press("Enter")
    expect(tab.locator(".problems")).to_contain_text("parameter 'reach' takes a length")
    wait_until_hand_is_at(tab, 1)
    reach.fill("2 m")
    reach.press("Enter")
    expect(tab.locator(".problems")).to_be_hidden()
    wait_until_hand_is_at(tab, 2)


def test_a_texture_half_written_does_not_end_the_updates(tab: Page, spec: Path):
    texture = spec.with_name("t.png")
    texture.write_bytes(b"\x89PNG\r\n\x1a\n half of it")
    skin = "{sphere: 5 cm, material: {name: skin, texture: t.png}}"
    spec.write_text(SPEC.replace("{sphere: 5 cm}", skin))
    expect(tab.locator(".problems")).to_contain_text("t.png is not shown")
    spec.write_text(SPEC.replace("default: 1 m", "default: 2 m"))
    wait_until_hand_is_at(tab, 2)


def test_the_layers_of_the_options_are_those_of_the_first_robot(new_tab: Callable[[], Page], spec: Path):
    spec.write_text(SPEC.replace("child: hand", "child: hnd"))
    viewer = Viewer(spec.name, "--show", "collisions,frames", cwd=spec.parent)
    tab = new_tab()
    open_viewer(tab, viewer)
    spec.write_text(SPEC)
    wait_until_hand_is_at(tab, 1)
    tab.locator("summary", has_text="Layers").click()
    expect(tab.get_by_role("checkbox", name="frames")).to_be_checked()
    expect(tab.get_by_role("checkbox", name="visuals")).not_to_be_checked()
    viewer.close()


def test_a_pose_that_an_edit_makes_impossible_keeps_the_viewer(new_tab: Callable[[], Page], spec: Path):
    viewer = Viewer(spec.name, "--pose", "turn=80deg", cwd=spec.parent)
    tab = new_tab()
    open_viewer(tab, viewer)
    assert tab.evaluate("window.linkforge.positions()") == {"turn": pytest.approx(1.396263)}
    spec.write_text(SPEC.replace("upper: 90 deg", "upper: 45 deg").replace("default: 1 m", "default: 2 m"))
    wait_until_hand_is_at(tab, 2)
    viewer.close()


def test_a_spec_with_errors_from_the_start_shows_its_robot_once_it_is_corrected(
    new_tab: Callable[[], Page], spec: Path
):
    spec.write_text(SPEC.replace("child: hand", "child: hnd"))
    viewer = Viewer(spec.name, cwd=spec.parent)
    tab = new_tab()
    open_viewer(tab, viewer)
    expect(tab.locator(".problems")).to_contain_text("LF4102")
    expect(tab.locator(".problems")).to_contain_text("no robot to show yet")
    spec.write_text(SPEC)
    wait_until_hand_is_at(tab, 1)
    expect(tab.locator(".problems")).to_be_hidden()
    viewer.close()


def test_the_page_reports_that_the_server_has_ended(chromium: Browser, viewer: Viewer):
    tab = chromium.new_page()  # whose console reports the lost connection
    open_viewer(tab, viewer)
    expect(tab.locator(".problems")).to_be_hidden()
    assert viewer.interrupt() == 130
    expect(tab.locator(".problems")).to_contain_text("the server has stopped")
    wait_until_hand_is_at(tab, 1)
    tab.close()


def test_a_killed_browser_leaves_no_threads(browser: Sequence[str], viewer: Viewer, tmp_path: Path):
    tasks = Path(f"/proc/{viewer.process.pid}/task")
    before = len(list(tasks.iterdir()))
    words = [
        *browser,
        "--headless",
        "--no-first-run",
        f"--user-data-dir={tmp_path / 'profile'}",
        "--remote-debugging-port=0",
    ]
    options = [*OPTIONS, *(["--no-sandbox"] if os.geteuid() == 0 else [])]
    process = subprocess.Popen([*words, *options, viewer.url], start_new_session=True, stderr=subprocess.DEVNULL)
    wait_until(lambda: len(list(tasks.iterdir())) > before)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    wait_until(lambda: len(list(tasks.iterdir())) <= before)


def wait_until(is_done: object, seconds: float = 60) -> None:
    """Wait for a condition; fail after a time."""
    assert callable(is_done)
    end = time.monotonic() + seconds
    while not is_done():
        assert time.monotonic() < end
        time.sleep(0.1)
