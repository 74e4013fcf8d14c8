"""The page itself: its types, what it draws and when, the pointer, and what it holds after many updates."""

import copy
import json
import random
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from linkforge_compile import compile_text
from linkforge_compile.resources import view_page_file
from linkforge_compile.view.files import RobotFiles, collect_files
from linkforge_compile.view.html import html_of
from linkforge_compile.view.scene import make_scene
from tests.meshes import block, content
from tests.programs import program
from tests.view.test_shapes import pixels

PROJECT = view_page_file().parents[1]
SAMPLE = json.loads(Path(__file__).with_name("sample.scene.json").read_text("utf-8"))

# Stands in for the connection to the server.
SERVER = """
window.EventSource = class extends EventTarget {
  constructor() { super(); window.server = this; }
  close() {}
};
window.update = async (scenes) => {
  for (const scene of scenes) {
    const data = { version: 1, scene, problems: [], settings: { parameters: [], variants: [], variant: null } };
    server.dispatchEvent(new MessageEvent("update", { data: JSON.stringify(data) }));
    await linkforge.ready;
  }
  return linkforge.memory();
};
"""

COUNT = """
window.frames_drawn = 0;
const original = requestAnimationFrame;
window.requestAnimationFrame = (draw) => original((time) => { window.frames_drawn += 1; draw(time); });
"""


def sample(**view: object) -> str:
    return html_of({**SAMPLE, "view": {"panels": False, **view}}, RobotFiles())


def test_the_types_are_strictly_right(page: Path):
    run = subprocess.run((program("npm"), "run", "check"), cwd=PROJECT, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout


@pytest.mark.parametrize("seed", range(5))
def test_an_inertia_ellipsoid_is_of_the_solid_with_that_inertia(seed: int, page: Path):
    """Of a solid with half axes a, b, c: m/5 (b² + c²) about the first one, and so on."""
    chance = np.random.default_rng(seed)
    half = chance.uniform(0.01, 2, 3)
    mass = chance.uniform(0.1, 10)
    turn = np.linalg.qr(chance.normal(size=(3, 3)))[0]
    tensor = turn @ np.diag(mass / 5 * (half @ half - half**2)) @ turn.T
    rows, columns = (0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)
    inertia = {"origin": None, "moments": tensor[rows, columns].tolist()}
    script = f"""
        import {{ ellipsoid }} from "./src/inertia";
        console.log(JSON.stringify(ellipsoid({json.dumps(inertia)}, {mass}).elements));
    """
    bundler = PROJECT / "node_modules" / ".bin" / "esbuild"
    bundle = subprocess.run(
        (bundler, "--bundle", "--platform=node"), input=script, cwd=PROJECT, capture_output=True, text=True, check=True
    ).stdout
    run = subprocess.run((program("node"), "-"), input=bundle, capture_output=True, text=True, check=True)
    axes = np.reshape(json.loads(run.stdout), (4, 4)).T[:3, :3]
    assert np.allclose(axes @ axes.T, turn @ np.diag(half**2) @ turn.T, atol=1e-9)
    assert np.linalg.det(axes) > 0


def test_a_click_selects_a_link_and_another_one_beside_the_robot_none(show: Callable[[str], Any]):
    tab = show(sample(camera={"azimuth": 0, "elevation": 0, "distance": 3, "target": [0, 0, 0.3]}))
    plain = pixels(tab)
    tab.mouse.click(400, 300)
    tab.mouse.move(10, 10)
    tab.wait_for_timeout(300)
    changed = np.argwhere((np.abs(pixels(tab) - plain) > 20).any(axis=2))
    height = changed.max(axis=0) - changed.min(axis=0)
    assert len(changed) > 500
    assert height[0] > 2 * height[1], "the upper arm is highlighted, which is high and narrow"
    tab.mouse.click(10, 10)
    tab.wait_for_timeout(300)
    assert (np.abs(pixels(tab) - plain) > 20).mean() < 0.0005


def test_the_name_of_the_link_under_the_pointer_is_shown(show: Callable[[str], Any]):
    tab = show(sample(camera={"azimuth": 0, "elevation": 0, "distance": 3, "target": [0, 0, 0.3]}))
    tab.mouse.move(400, 300)
    tab.wait_for_selector(".labels span")
    assert tab.locator(".labels span").all_inner_texts() == ["upper"]


def corner(tab: Any) -> list[int]:
    """Return the colour of the background at the top of the picture."""
    tab.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    image = pixels(tab)
    return image[image.shape[0] // 4, image.shape[1] // 2].tolist()


def test_the_picture_follows_the_theme_and_one_for_a_file_is_light(show: Callable[[str], Any]):
    above = {"azimuth": 0, "elevation": 0, "distance": 9, "target": [0, 0, 0]}
    tab = show(sample(panels=True, layers=["visuals"], camera=above))
    tab.evaluate("for (const one of document.querySelectorAll('#over > *')) one.hidden = true")
    assert min(corner(tab)) > 220
    tab.emulate_media(color_scheme="dark")
    assert max(corner(tab)) < 60
    tab.emulate_media(color_scheme="light")
    assert min(corner(tab)) > 220
    tab.emulate_media(color_scheme="dark")
    tab = show(sample(layers=["visuals"], camera=above))
    tab.emulate_media(color_scheme="dark")
    assert min(corner(tab)) > 220


def test_an_ellipsoid_over_a_sphere_does_not_flicker(show: Callable[[str], Any]):
    """Of a solid sphere, both have the same surface: all of it is in the colour of the ellipsoid."""
    scene = copy.deepcopy(SAMPLE)
    (base, *_), moment = scene["links"], 0.4 * 1 * 0.2**2
    pose = {"xyz": [0, 0, 0], "quaternion": [0, 0, 0, 1]}
    base |= {"mass": 1, "center": [0, 0, 0], "collisions": []}
    base["inertia"] = {"origin": pose, "moments": [moment] * 3 + [0] * 3}
    base["visuals"] = [{"type": "sphere", "radius": 0.2, "origin": pose, "color": [0, 1, 0, 1]}]
    scene |= {"links": [base], "joints": [], "states": [], "missing": []}
    view = {"panels": False, "layers": ["visuals", "inertias"], "camera": {"azimuth": 20, "elevation": 30}}
    image = pixels(show(html_of({**scene, "view": view}, RobotFiles())))
    middle = image[200:400, 300:500]
    assert (middle[:, :, 2] > 0.4 * middle[:, :, 1]).all(), "no pixel has the colour of the sphere alone"


@pytest.mark.parametrize("layer", ["collisions", "frames", "axes", "centers", "inertias", "labels", "grid", "visuals"])
def test_a_layer_is_switched_on_and_off(layer: str, show: Callable[[str], Any]):
    tab = show(sample())
    is_on = layer in ("grid", "visuals")

    def seen(is_shown: bool) -> np.ndarray:
        tab.evaluate("([name, on]) => linkforge.layer(name, on)", [layer, is_shown])
        tab.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        return pixels(tab)

    before = pixels(tab)
    assert (np.abs(seen(not is_on) - before) > 20).any(axis=2).sum() > 50
    assert (np.abs(seen(is_on) - before) > 20).any(axis=2).sum() < 10


def test_nothing_is_drawn_while_nothing_changes(page: Path, new_tab: Callable[[], Any], tmp_path: Path):
    tab = new_tab()
    tab.add_init_script(COUNT)
    file = tmp_path / "robot.html"
    file.write_text(sample(), "utf-8")
    tab.goto(file.as_uri())
    tab.evaluate("linkforge.ready")
    tab.wait_for_timeout(300)
    before = tab.evaluate("frames_drawn")
    tab.wait_for_timeout(700)
    assert tab.evaluate("frames_drawn") == before
    tab.evaluate("linkforge.set({shoulder: 0.5})")
    tab.wait_for_timeout(300)
    assert tab.evaluate("frames_drawn") == before + 1


def test_many_updates_hold_no_more_than_one(page: Path, new_tab: Callable[[], Any], tmp_path: Path):
    (tmp_path / "m.stl").write_bytes(content(block(1, 1, 1), "stl"))
    text = f"linkforge: 1\nname: r\nlinks: {{a: {{visual: {{mesh: {tmp_path / 'm.stl'}}}}}}}\n"
    robot = compile_text(text, name=str(tmp_path / "r.robot.yaml")).result()
    files = collect_files(robot)
    scene = make_scene(robot, files)
    scene = {**SAMPLE, "links": [*SAMPLE["links"], scene["links"][0]], "files": scene["files"], "live": True}
    html = html_of(scene, files)
    scene["files"] = json.loads(html.split('type="application/json">')[1].split("</script>")[0])["files"]
    tab = new_tab()
    tab.set_viewport_size({"width": 160, "height": 120})  # 60 pictures by software
    tab.add_init_script(SERVER)
    file = tmp_path / "robot.html"
    file.write_text(html, "utf-8")
    tab.goto(file.as_uri())
    tab.evaluate("linkforge.ready")
    for layer in ("collisions", "frames", "axes", "centers", "inertias"):
        tab.evaluate("layer => linkforge.layer(layer, true)", layer)
    tab.evaluate("linkforge.select('upper')")
    chance = random.Random(1)
    scenes = []
    for _ in range(60):
        changed = copy.deepcopy(scene)
        changed["links"][1]["visuals"][0]["length"] = chance.uniform(0.2, 0.5)
        changed["links"][1]["visuals"][0]["color"] = [chance.random(), 0.5, 0.5, 1]
        scenes.append(changed)
    first = tab.evaluate("scenes => update(scenes)", scenes[:5])
    last = tab.evaluate("scenes => update(scenes)", scenes[5:])
    assert last == first
    assert first["geometries"] < 30


def big_robot(links: int, folder: Path) -> str:
    """Return the page of a robot of many links, each with a mesh of its own."""
    names = [f"l{number}" for number in range(links)]
    for number, name in enumerate(names):
        mesh = trimesh.creation.icosphere(subdivisions=2, radius=0.04 + number * 1e-5)
        (folder / f"{name}.stl").write_bytes(content(mesh, "stl"))
    lines = [f"  {name}: {{visual: {{mesh: {name}.stl}}}}" for name in names]
    joint = "type: continuous, axis: y, origin: {xyz: [0.1, 0, 0.01]}"
    joints = [f"  j{n}: {{{joint}, parent: l{(n - 1) // 2}, child: l{n}}}" for n in range(1, links)]
    text = "\n".join(("linkforge: 1", "name: big", "links:", *lines, "joints:", *joints, ""))
    robot = compile_text(text, name=str(folder / "r.robot.yaml")).result()
    files = collect_files(robot)
    return html_of(make_scene(robot, files), files)


def test_a_robot_of_300_links_is_up_within_three_seconds(page: Path, new_tab: Callable[[], Any], tmp_path: Path):
    file = tmp_path / "robot.html"
    file.write_text(big_robot(300, tmp_path), "utf-8")
    times = []
    for _ in range(3):  # the machine may be busy
        tab = new_tab()
        start = time.perf_counter()
        tab.goto(file.as_uri())
        tab.evaluate("linkforge.ready")
        times.append(time.perf_counter() - start)
        tab.close()
    assert min(times) < 3


def test_a_chain_of_thousands_of_links_is_shown(page: Path, new_tab: Callable[[], Any], tmp_path: Path):
    links = "".join(f"  l{n}: \n" for n in range(9000))
    joints = "".join(f"  j{n}: {{type: fixed, parent: l{n - 1}, child: l{n}}}\n" for n in range(1, 9000))
    text = f"linkforge: 1\nname: chain\nlinks:\n{links}joints:\n{joints}"
    robot = compile_text(text, name=str(tmp_path / "r.robot.yaml")).result()
    file = tmp_path / "robot.html"
    file.write_text(html_of(make_scene(robot, RobotFiles()), RobotFiles()), "utf-8")
    tab = new_tab()
    tab.goto(file.as_uri())
    tab.evaluate("linkforge.ready")
    tab.evaluate("linkforge.select('l8999')")
    assert tab.locator("[role=treeitem][aria-selected=true]").get_attribute("data-link") == "l8999"


def test_a_browser_without_webgl_says_so(page: Path, chromium: Any, tmp_path: Path):
    file = tmp_path / "robot.html"
    file.write_text(html_of(SAMPLE, RobotFiles()), "utf-8")
    tab = chromium.new_page()
    tab.add_init_script("HTMLCanvasElement.prototype.getContext = () => null;")
    tab.goto(file.as_uri())
    notice = tab.locator("#starting").text_content()
    tab.close()
    assert "It needs JavaScript and WebGL 2" in notice
    assert "It did not start: " in notice
