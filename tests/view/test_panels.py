"""The panels around the picture, in a real browser: what the keyboard and the mouse do, and what a live page keeps."""

import copy
import json
import re
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

from linkforge_compile.analysis import Settings
from linkforge_compile.view.html import html_of
from linkforge_compile.view.server import ViewServer
from linkforge_compile.view.session import Session

playwright = pytest.importorskip("playwright.sync_api")
expect = playwright.expect

SAMPLE = json.loads(Path(__file__).with_name("sample.scene.json").read_text())
OPTIONS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
SPEC = """\
linkforge: 1
name: arm
parameters:
  reach: {type: length, default: 1 m, minimum: 0.5 m, maximum: 2 m, description: of the arm}
  is_heavy: {default: false}
  tool: {default: none, enum: [none, hook]}
variants: {long: {reach: 1.5 m}}
links:
  base: {}
  arm: {visual: {box: [0.1, 0.1, $(reach)]}}
joints:
  lift:
    {parent: base, child: arm, type: revolute, axis: y, limits: {lower: -1 rad, upper: 1 rad, effort: 1, velocity: 1}}
"""


@pytest.fixture(scope="module")
def chromium(browser: Sequence[str]) -> Iterator[Any]:
    with playwright.sync_playwright() as started:
        running = started.chromium.launch(executable_path=browser[0], args=[*browser[1:], *OPTIONS])
        yield running
        running.close()


@pytest.fixture
def tab(chromium: Any) -> Iterator[Any]:
    """A tab of the browser, in which no script may fail."""
    tab = chromium.new_page(viewport={"width": 1280, "height": 800})
    faults: list[str] = []
    tab.on("pageerror", lambda error: faults.append(str(error)))
    yield tab
    tab.close()
    assert faults == []


Open = Callable[..., Any]


@pytest.fixture
def show(tab: Any, page: Path, tmp_path: Path) -> Open:
    """Open the page of a scene from disk."""

    def open_scene(scene: Any = SAMPLE, fragment: str = "") -> Any:
        file = tmp_path / "robot.html"
        file.write_text(html_of(scene, None), "utf-8")
        tab.goto(f"{file.as_uri()}{fragment}")
        tab.evaluate("window.linkforge.ready")
        return tab

    return open_scene


def positions(tab: Any) -> dict[str, float]:
    return tab.evaluate("window.linkforge.positions()")


def slide(tab: Any, joint: str, position: float) -> None:
    """Move the thumb of a slider."""
    slider = tab.get_by_label(f"position of {joint}", exact=True)
    move = "(slider, value) => { slider.value = value; slider.dispatchEvent(new Event('input')); }"
    slider.evaluate(move, str(position))


def test_a_slider_moves_its_joint_and_the_links_below(show: Open):
    tab = show()
    slide(tab, "shoulder", 0.5)
    assert positions(tab)["shoulder"] == pytest.approx(0.5)
    transform = tab.evaluate("window.linkforge.transform('fore')")
    assert (transform[3], transform[11]) == pytest.approx((0.4 * 0.479425539, 0.1 + 0.4 * 0.877582562))
    expect(tab.get_by_label("position of shoulder, number")).to_have_value("28.65")


def test_a_slider_ends_at_the_limits_of_its_joint(show: Open):
    tab = show()
    slider = tab.get_by_label("position of shoulder", exact=True)
    slider.focus()
    tab.keyboard.press("End")
    assert positions(tab)["shoulder"] == pytest.approx(1.5)
    tab.keyboard.press("Home")
    assert positions(tab)["shoulder"] == pytest.approx(-1.5)
    unlimited = tab.get_by_label("position of elbow", exact=True)
    assert float(unlimited.get_attribute("max")) == pytest.approx(3.14159265)


def test_a_number_is_read_in_the_shown_unit_and_kept_within_the_limits(show: Open):
    tab = show()
    number = tab.get_by_label("position of shoulder, number")
    number.fill("45")
    number.press("Enter")
    assert positions(tab)["shoulder"] == pytest.approx(0.785398163)
    tab.get_by_role("button", name="rad", exact=True).click()
    expect(number).to_have_value("0.7854")
    number.fill("7")
    number.press("Enter")
    expect(number).to_have_value("1.5")
    slides = tab.get_by_label("position of gripper/left_slide, number")
    slides.fill("0.03")
    slides.press("Enter")
    assert positions(tab)["gripper/left_slide"] == pytest.approx(0.03)


def test_a_double_click_or_the_button_resets_a_joint(show: Open):
    tab = show()
    slide(tab, "shoulder", 0.5)
    tab.get_by_title("move shoulder to its start position").click()
    assert positions(tab)["shoulder"] == 0
    slide(tab, "shoulder", 0.5)
    tab.get_by_label("position of shoulder", exact=True).dblclick()
    assert positions(tab)["shoulder"] == 0


def test_a_mimic_joint_follows_and_cannot_be_moved(show: Open):
    tab = show()
    slide(tab, "gripper/left_slide", 0.02)
    follower = tab.get_by_label("position of gripper/right_slide", exact=True)
    expect(follower).to_be_disabled()
    expect(follower).to_have_value("0.02")
    expect(tab.locator(".mimic")).to_have_text("= gripper/left_slide")


def test_states_of_groups_are_buttons_marked_once_reached(show: Open):
    tab = show()
    arm = tab.get_by_role("group", name="arm")
    reach = arm.get_by_role("button", name="reach")
    expect(reach).to_have_attribute("aria-pressed", "false")
    reach.click()
    assert positions(tab)["elbow"] == pytest.approx(-0.7)
    expect(reach).to_have_attribute("aria-pressed", "true")
    expect(arm.get_by_role("button", name="home")).to_have_attribute("aria-pressed", "false")
    default = tab.get_by_role("button", name="default", exact=True)
    expect(default).to_have_attribute("aria-pressed", "false")
    default.click()
    assert positions(tab)["elbow"] == 0
    assert positions(tab)["gripper/left_slide"] == 0.005
    expect(default).to_have_attribute("aria-pressed", "true")
    reach.click()
    tab.keyboard.press("d")
    assert positions(tab)["elbow"] == 0


def test_random_positions_are_within_the_limits(show: Open):
    tab = show()
    tab.get_by_role("button", name="random").click()
    moved = positions(tab)
    assert moved["shoulder"] != 0
    assert -1.5 <= moved["shoulder"] <= 1.5
    assert 0.005 <= moved["gripper/left_slide"] <= 0.04
    tab.get_by_role("button", name="reset all").click()
    assert positions(tab)["shoulder"] == 0


def shown_links(tab: Any) -> list[str]:
    return tab.locator("[role=treeitem]:visible").evaluate_all("rows => rows.map(row => row.dataset.link)")


@pytest.mark.parametrize("text", ["gripper/LEFT", "left_slide"])
def test_the_search_finds_links_and_joints_with_what_is_above_them(show: Open, text: str):
    tab = show()
    tab.keyboard.press("/")
    tab.keyboard.type(text)
    assert shown_links(tab) == ["base", "upper", "fore", "gripper/palm", "gripper/left"]
    joints = tab.locator(".joint:visible").evaluate_all("rows => rows.map(row => row.dataset.joint)")
    assert joints == ["gripper/left_slide"]
    tab.keyboard.press("Enter")
    expect(tab.get_by_role("treeitem", selected=True)).to_have_attribute("data-link", "gripper/left")
    tab.keyboard.press("Escape")
    assert len(shown_links(tab)) == len(SAMPLE["links"])


def test_a_search_that_finds_nothing_shows_so(show: Open):
    tab = show()
    tab.get_by_role("searchbox").fill("wing")
    assert shown_links(tab) == []
    assert tab.locator(".tree").get_attribute("data-empty") == "nothing of this name"


def test_arrow_keys_walk_close_and_open_the_tree(show: Open):
    tab = show()
    tab.get_by_role("treeitem").first.focus()
    for key in ("ArrowDown", "ArrowDown", "ArrowLeft"):
        tab.keyboard.press(key)
    assert shown_links(tab) == ["base", "upper", "fore"]
    expect(tab.get_by_role("treeitem", selected=True)).to_have_attribute("aria-expanded", "false")
    tab.keyboard.press("ArrowRight")
    tab.keyboard.press("End")
    expect(tab.locator(":focus")).to_have_attribute("data-link", "gripper/right")
    expect(tab.get_by_role("treeitem", selected=True)).to_have_attribute("data-link", "gripper/right")


def test_a_selected_link_in_a_closed_branch_is_opened(show: Open):
    tab = show()
    tab.locator("[data-link=upper] .twisty").click()
    assert shown_links(tab) == ["base", "upper"]
    tab.evaluate("window.linkforge.select('gripper/palm')")
    assert "gripper/palm" in shown_links(tab)


def test_the_eye_of_a_link_hides_it_and_with_shift_all_below(show: Open):
    tab = show()
    tab.get_by_role("button", name="show gripper/palm").click(modifiers=["Shift"])
    hidden = tab.locator(".invisible").evaluate_all("rows => rows.map(row => row.dataset.link)")
    assert hidden == ["gripper/palm", "gripper/left", "gripper/right"]
    tab.get_by_role("button", name="show gripper/left").click()
    expect(tab.locator(".invisible")).to_have_count(2)


def test_details_show_the_link_its_joint_and_the_lines_of_the_spec(show: Open):
    tab = show()
    tab.locator("[data-link=upper] .name").click()
    details = tab.get_by_role("region", name="selected link")
    expect(details).to_contain_text("2 kg")
    expect(details).to_contain_text("capsule, radius 0.05 m, length 0.4 m")
    expect(details).to_contain_text("−85.94° to 85.94°")
    assert details.locator("code").all_inner_texts() == ["sample.robot.yaml:9", "sample.robot.yaml:30"]
    slide(tab, "shoulder", 0.5)
    expect(details).to_contain_text("28.65°")
    tab.keyboard.press("Escape")
    expect(details).to_be_hidden()


def test_the_place_of_a_link_is_copied(show: Open, chromium: Any):
    tab = show()
    tab.context.grant_permissions(["clipboard-read", "clipboard-write"])
    tab.evaluate("window.linkforge.select('upper')")
    tab.get_by_role("button", name="copy").first.click()
    expect(tab.get_by_role("button", name="copied")).to_be_visible()
    assert tab.evaluate("navigator.clipboard.readText()") == "sample.robot.yaml:9"


def test_keys_and_check_boxes_switch_layers(show: Open):
    tab = show()
    box = tab.get_by_role("checkbox", name="collisions")
    expect(box).not_to_be_checked()
    tab.keyboard.press("c")
    expect(box).to_be_checked()
    box.uncheck()
    tab.keyboard.press("?")
    expect(tab.get_by_role("dialog")).to_contain_text("show or hide collisions")
    tab.keyboard.press("c")
    tab.keyboard.press("Escape")
    expect(box).not_to_be_checked()
    tab.get_by_role("searchbox").fill("")
    tab.get_by_role("searchbox").press("c")
    expect(box).not_to_be_checked()


def test_a_reload_keeps_the_pose_the_layers_and_the_selection(show: Open):
    tab = show()
    slide(tab, "gripper/left_slide", 0.02)
    tab.keyboard.press("f")
    tab.evaluate("window.linkforge.select('fore')")
    tab.wait_for_url(re.compile(r"#.*link=fore"))
    tab.reload()
    assert positions(tab)["gripper/left_slide"] == pytest.approx(0.02)
    expect(tab.get_by_role("checkbox", name="frames")).to_be_checked()
    expect(tab.get_by_role("treeitem", selected=True)).to_have_attribute("data-link", "fore")


def test_an_address_with_other_robots_names_is_no_fault(show: Open):
    tab = show(fragment="#joint.wing=1&joint.shoulder=9&joint.elbow=much&layers=none&link=wing")
    assert positions(tab)["shoulder"] == 1.5
    assert positions(tab)["elbow"] == 0
    expect(tab.get_by_role("checkbox", name="visuals")).not_to_be_checked()


def test_missing_meshes_are_listed(show: Open):
    tab = show()
    tab.locator(".problems > summary").click()
    problems = tab.locator(".problems")
    expect(problems).to_contain_text("1 file not shown: the package 'sample' is not found")
    expect(problems).to_contain_text("package://sample/palm.stl of gripper/palm at sample.robot.yaml:21")


def test_names_are_text_never_html(show: Open):
    name = "<img src=x onerror=window.broken=1>"
    text = json.dumps(SAMPLE).replace('"upper"', json.dumps(name)).replace('"shoulder"', json.dumps(f"{name}j"))
    scene = json.loads(text.replace('"gripper"', json.dumps(f"{name}m")).replace('"reach"', json.dumps(f"{name}s")))
    scene["missing"][0] |= {"file": name, "reason": name}
    tab = show(scene)
    tab.evaluate("name => window.linkforge.select(name)", name)
    expect(tab.get_by_role("treeitem", selected=True)).to_contain_text(name)
    expect(tab.locator(".details h2")).to_have_text(name)
    tab.keyboard.press("l")
    assert tab.locator("img").count() == 0
    assert tab.evaluate("window.broken") is None


def test_a_robot_without_visuals_has_its_collisions_and_frames_shown_first(show: Open):
    scene = copy.deepcopy(SAMPLE)
    for link in scene["links"]:
        link["visuals"] = []
    tab = show(scene)
    for layer, is_shown in (("collisions", True), ("frames", True), ("inertia", False)):
        expect(tab.get_by_role("checkbox", name=layer)).to_be_checked(checked=is_shown)


def test_the_number_of_a_joint_and_the_name_of_a_deep_link_are_not_cut(show: Open):
    scene = copy.deepcopy(SAMPLE)
    for link in scene["links"]:
        link["module"] = f"left_arm_of_the_robot/{link['name']}"
    tab = show(scene)
    slide(tab, "shoulder", -0.5)
    slide(tab, "elbow", -3.1415)
    for unit in ("deg", "rad"):
        tab.get_by_role("button", name=unit, exact=True).click()
        for number in tab.locator(".joint input[type=number]").all():
            assert number.evaluate("number => number.scrollWidth <= number.clientWidth")
    for name in tab.locator(".tree .name").all():
        assert name.evaluate("name => name.scrollWidth <= name.clientWidth")


def test_a_picture_has_no_panels(show: Open):
    tab = show(copy.deepcopy(SAMPLE) | {"view": {"panels": False}})
    assert tab.locator("#panels > *").count() == 0
    assert tab.locator("canvas").bounding_box()["width"] == 1280


@pytest.fixture
def spec(tmp_path: Path) -> Path:
    path = tmp_path / "arm.robot.yaml"
    path.write_text(SPEC)
    return path


@pytest.fixture
def live(spec: Path, page: Path, tab: Any) -> Iterator[Any]:
    """A tab with the page of a server that compiles the spec after each change."""
    session = Session(spec, Settings([]))
    session.renew()
    server = ViewServer(session, lambda scene: html_of(scene, None))

    def follow() -> None:
        while not session.is_closed:
            session.pause(0.05)
            if session.poll():
                session.renew()

    follower = threading.Thread(target=follow, daemon=True)
    server.start()
    follower.start()
    tab.goto(server.url)
    tab.evaluate("window.linkforge.ready")
    tab.server = server
    yield tab
    if not session.is_closed:
        server.stop()
    follower.join(timeout=10)


def test_an_update_keeps_positions_within_new_limits_and_the_selection(live: Any, spec: Path):
    slide(live, "lift", 0.8)
    live.evaluate("window.linkforge.select('arm')")
    live.keyboard.press("c")
    spec.write_text(SPEC.replace("upper: 1 rad", "upper: 0.5 rad"))
    expect(live.get_by_label("position of lift", exact=True)).to_have_attribute("max", "0.5")
    assert positions(live)["lift"] == pytest.approx(0.5)
    expect(live.get_by_role("treeitem", selected=True)).to_have_attribute("data-link", "arm")
    expect(live.get_by_role("checkbox", name="collisions")).to_be_checked()


def test_a_renamed_joint_keeps_its_position_and_another_one_does_not_take_it(live: Any, spec: Path):
    slide(live, "lift", 0.8)
    spec.write_text(SPEC.replace("  lift:", "  raise:"))
    expect(live.get_by_label("position of raise", exact=True)).to_be_visible()
    assert positions(live) == {"raise": pytest.approx(0.8)}
    spec.write_text(SPEC.replace("  lift:", "  slide:").replace("revolute", "prismatic").replace(" rad,", " m,"))
    expect(live.get_by_label("position of slide", exact=True)).to_be_visible()
    assert positions(live) == {"slide": 0}


def test_a_narrow_window_has_all_of_the_bar_and_the_panels_below_the_robot(show: Open, tab: Any):
    tab.set_viewport_size({"width": 390, "height": 800})
    show()
    for button in tab.locator("#bar button").all():
        box = button.bounding_box()
        assert box["x"] + box["width"] <= 390
        assert button.evaluate("button => button.scrollWidth <= button.clientWidth")
    picture, panel = (tab.locator(one).bounding_box() for one in ("#viewport", "#right"))
    assert picture["width"] == panel["width"] == 390
    assert picture["y"] + picture["height"] <= panel["y"]


def test_problems_of_the_spec_are_over_the_last_good_robot(live: Any, spec: Path):
    problems = live.locator(".problems")
    expect(problems).to_be_hidden()
    spec.write_text(SPEC.replace("child: arm", "child: amr"))
    expect(problems).to_contain_text("1 error · showing the last robot without errors")
    expect(problems).to_contain_text("did you mean 'arm'?")
    expect(problems.locator("li")).to_contain_text("arm.robot.yaml:13:27")
    assert shown_links(live) == ["base", "arm"]
    spec.write_text(SPEC)
    expect(problems).to_be_hidden()


def test_widgets_of_parameters_compile_the_spec_again(live: Any):
    live.evaluate("window.linkforge.select('arm')")
    details = live.get_by_role("region", name="selected link")
    number = live.get_by_role("textbox", name="reach")
    expect(number).to_have_value("1 m")
    number.fill("700 mm")
    number.press("Enter")
    expect(details).to_contain_text("box 0.1 × 0.1 × 0.7 m")
    expect(live.get_by_label("reach, slider")).to_have_value("0.7")
    live.get_by_title("reset reach to its default").click()
    expect(details).to_contain_text("box 0.1 × 0.1 × 1 m")
    slider = live.get_by_label("reach, slider")
    assert (slider.get_attribute("min"), slider.get_attribute("max")) == ("0.5", "2")
    slider.evaluate("slider => { slider.value = 1.25; slider.dispatchEvent(new Event('input')); }")
    expect(details).to_contain_text("box 0.1 × 0.1 × 1.25 m")
    live.get_by_role("checkbox", name="is_heavy").check()
    live.get_by_role("combobox", name="tool").select_option("hook")
    expect(live.get_by_title("reset tool to its default")).to_be_visible()
    expect(live.get_by_role("checkbox", name="is_heavy")).to_be_checked()


def test_what_is_being_typed_stays_as_other_updates_arrive(live: Any, spec: Path):
    number = live.get_by_role("textbox", name="reach")
    number.fill("1.7 m")
    spec.write_text(SPEC.replace("upper: 1 rad", "upper: 0.5 rad"))
    expect(live.get_by_label("position of lift", exact=True)).to_have_attribute("max", "0.5")
    expect(number).to_have_value("1.7 m")
    number.press("Enter")
    live.evaluate("window.linkforge.select('arm')")
    expect(live.get_by_role("region", name="selected link")).to_contain_text("box 0.1 × 0.1 × 1.7 m")


def test_a_change_is_sent_although_an_update_arrives_before(live: Any, spec: Path):
    live.evaluate("window.linkforge.select('arm')")
    slider = live.get_by_label("reach, slider")
    move = "(slider, value) => { slider.value = value; slider.dispatchEvent(new Event('input')); }"
    for value in (1.1, 1.2, 1.3, 1.4):
        slider.evaluate(move, value)
        spec.write_text(SPEC.replace("upper: 1 rad", f"upper: {value} rad"))
        live.wait_for_timeout(150)
    expect(live.get_by_role("region", name="selected link")).to_contain_text("box 0.1 × 0.1 × 1.4 m")
    expect(live.get_by_role("textbox", name="reach")).to_have_value("1.4 m")


def test_a_variant_is_chosen(live: Any):
    live.evaluate("window.linkforge.select('arm')")
    details = live.get_by_role("region", name="selected link")
    live.get_by_role("combobox", name="variant").select_option("long")
    expect(details).to_contain_text("box 0.1 × 0.1 × 1.5 m")
    expect(live.get_by_role("textbox", name="reach")).to_have_value("1.5 m")


def test_a_faulty_value_has_its_message_at_the_widget(live: Any):
    number = live.get_by_role("textbox", name="reach")
    number.fill("3 m")
    number.press("Enter")
    expect(live.locator("[data-parameter=reach] .fault")).to_contain_text("parameter 'reach' must be at most")
    expect(number).to_have_value("3 m")
    expect(number).to_have_attribute("aria-invalid", "true")


def test_the_end_of_the_server_is_shown(live: Any):
    live.server.stop()
    expect(live.locator(".problems")).to_contain_text("connection lost; the server has stopped", timeout=15_000)
