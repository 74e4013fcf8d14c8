"""The shapes of a robot in the page: where they are, and how they look."""

import io
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from linkforge_compile import compile_file
from linkforge_compile.view.files import collect_files
from linkforge_compile.view.html import html_of
from linkforge_compile.view.scene import SceneView, make_scene
from tests.meshes import GEOMETRY, block, collada, content

Image = pytest.importorskip("PIL.Image")

Show = Callable[[str], Any]

MILLIMETRES = '<unit name="millimeter" meter="0.001"/><up_axis>Y_UP</up_axis>'
INCHES = '<unit name="inch" meter="0.0254"/><up_axis>Z_UP</up_axis>'
PLACED = f"<node><translate>10 0 0</translate><rotate>0 0 1 90</rotate>{GEOMETRY}</node>"
FRONT: SceneView = {"panels": False, "layers": ["visuals"], "camera": {"azimuth": 0, "elevation": 0, "distance": 6}}


@pytest.fixture
def show_link(show: Show, tmp_path: Path) -> Callable[..., Any]:
    """Return a function that shows a robot of one link, `part`, with files next to its spec."""

    def shown(link: str, files: dict[str, bytes] | None = None, view: SceneView = FRONT) -> Any:
        for name, written in (files or {}).items():
            (tmp_path / name).write_bytes(written)
        spec = tmp_path / "r.robot.yaml"
        spec.write_text(f"linkforge: 1\nname: r\nlinks: {{part: {link}}}\n")
        robot = compile_file(spec).result()
        found = collect_files(robot)
        return show(html_of(make_scene(robot, found, view), found))

    return shown


def extent(tab: Any) -> np.ndarray:
    """Return the least and the largest corner of the visuals in the world."""
    return np.array(tab.evaluate("linkforge.extent('part')"))


def pixels(tab: Any) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(tab.screenshot())).convert("RGB")).astype(int)


def middle(tab: Any) -> list[int]:
    image = pixels(tab)
    return image[image.shape[0] // 2, image.shape[1] // 2].tolist()


@pytest.mark.parametrize(
    ("geometry", "half"),
    [
        ("box: [1, 2, 3]", (0.5, 1, 1.5)),
        ("sphere: 0.5", (0.5, 0.5, 0.5)),
        ("cylinder: {radius: 0.5, length: 3}", (0.5, 0.5, 1.5)),
        ("capsule: {radius: 0.5, length: 3}", (0.5, 0.5, 2)),
    ],
)
def test_a_primitive_is_along_z_at_its_origin(geometry: str, half: tuple[float, ...], show_link: Callable[..., Any]):
    tab = show_link(f"{{visual: {{{geometry}, origin: {{xyz: [1, 0, 0], rpy: [0, 90 deg, 0]}}}}}}")
    x, y, z = half
    expected = np.array([[1 - z, -y, -x], [1 + z, y, x]])
    assert np.allclose(extent(tab), expected, atol=1e-6)


@pytest.mark.parametrize("form", ["stl", "stl_ascii", "obj", "ply", "glb", "dae"])
def test_a_mesh_has_the_place_and_the_scale_of_its_visual(form: str, show_link: Callable[..., Any]):
    mesh = block(2, 4, 6, at=(1, 2, 3))
    name = f"m.{form.removesuffix('_ascii')}"
    scale = (0.5, -1, 2)
    visual = f"{{mesh: {{file: {name}, scale: [0.5, -1, 2]}}, origin: {{xyz: [0, 0, 1], rpy: [0, 0, 90 deg]}}}}"
    tab = show_link(f"{{visual: {visual}}}", {name: content(mesh, form)})
    x, y, z = (mesh.vertices * scale).T
    placed = np.array([-y, x, z + 1])
    assert np.allclose(extent(tab), [placed.min(axis=1), placed.max(axis=1)], atol=1e-6)


@pytest.mark.parametrize(("asset", "unit"), [("", 1), (MILLIMETRES, 0.001), (INCHES, 0.0254)])
def test_collada_has_its_unit_and_keeps_its_axes(asset: str, unit: float, show_link: Callable[..., Any]):
    """As in RViz, and in the inertia that linkforge computes."""
    written = collada(PLACED, asset=asset, mesh=block(2, 4, 6))
    tab = show_link("{visual: {mesh: m.dae}}", {"m.dae": written})
    assert np.allclose(extent(tab), np.array([[8, -1, -3], [12, 1, 3]]) * unit, atol=1e-6)


@pytest.mark.parametrize("scale", ["[1, 1, 1]", "[-1, 1, 1]", "[-1, -1, -1]"])
def test_a_mirrored_mesh_has_the_light_of_a_box(scale: str, show_link: Callable[..., Any]):
    view: SceneView = {**FRONT, "camera": {"azimuth": 30, "elevation": 30, "distance": 6}}
    look = "material: {name: red, color: [0.8, 0.2, 0.1]}"
    box = pixels(show_link(f"{{visual: {{box: [1, 2, 1], {look}}}}}", view=view))
    stl = {"m.stl": content(block(1, 2, 1), "stl")}
    mesh = pixels(show_link(f"{{visual: {{mesh: {{file: m.stl, scale: {scale}}}, {look}}}}}", stl, view))
    assert (np.abs(box - mesh).max(axis=2) > 3).mean() < 0.001


def test_a_missing_mesh_is_a_box_of_the_collision(show_link: Callable[..., Any]):
    tab = show_link("{visual: {mesh: no.stl}, collision: {box: [1, 2, 3], origin: [0, 0, 1]}}")
    assert np.allclose(extent(tab), [[-0.5, -1, -0.5], [0.5, 1, 2.5]], atol=1e-6)


def test_a_mesh_that_cannot_be_read_is_a_box(show_link: Callable[..., Any]):
    tab = show_link("{visual: {mesh: m.dae}}", {"m.dae": b"<COLLADA/>"})
    assert np.allclose(extent(tab), [[-0.05] * 3, [0.05] * 3], atol=1e-6)


def picture(color: tuple[int, int, int]) -> bytes:
    written = io.BytesIO()
    Image.new("RGB", (4, 4), color).save(written, "png")
    return written.getvalue()


OBJ = """\
mtllib m.mtl
v 0 -1 -1
v 0 1 -1
v 0 1 1
v 0 -1 1
vt 0 0
vt 1 0
vt 1 1
vt 0 1
vn 1 0 0
usemtl skin
f 1/1/1 2/2/1 3/3/1 4/4/1
"""
TEXTURED = b"newmtl skin\nKd 1 1 1\nmap_Kd skin%20of%20it.png\n".replace(b"%20", b"_")
GREEN = "material: {name: green, color: [0, 1, 0]}"


def test_the_texture_of_a_mesh_is_seen_and_wins_over_the_material_of_the_robot(show_link: Callable[..., Any]):
    files = {"m.obj": OBJ.encode(), "m.mtl": TEXTURED, "skin_of_it.png": picture((0, 0, 255))}
    red, green, blue = middle(show_link(f"{{visual: {{mesh: m.obj, {GREEN}}}}}", files))
    assert max(red, green) < 60
    assert blue > 150


def test_a_mesh_without_a_material_has_that_of_the_robot(show_link: Callable[..., Any]):
    for name, written in (("m.obj", content(block(1, 1, 1), "obj")), ("m.dae", collada(f"<node>{GEOMETRY}</node>"))):
        red, green, blue = middle(show_link(f"{{visual: {{mesh: {name}, {GREEN}}}}}", {name: written}))
        assert max(red, blue) < 60, name
        assert green > 150, name


@pytest.mark.parametrize("line", ["Tr 1", "Tr 0", "d 1", "d 0"])
def test_a_mesh_that_its_file_calls_invisible_is_seen(line: str, show_link: Callable[..., Any]):
    material = f"newmtl skin\nKd 0 0 1\n{line}\n"  # MeshLab writes `Tr 1` for opaque, others for the opposite
    red, green, blue = middle(show_link("{visual: {mesh: m.obj}}", {"m.obj": OBJ.encode(), "m.mtl": material.encode()}))
    assert max(red, green) < 60
    assert blue > 150


def test_a_texture_of_the_robot_is_seen_on_a_box(show_link: Callable[..., Any]):
    link = "{visual: {box: [1, 1, 1], material: {name: skin, texture: skin.png}}}"
    red, green, blue = middle(show_link(link, {"skin.png": picture((255, 0, 0))}))
    assert red > 150
    assert max(green, blue) < 60


def test_a_texture_that_cannot_be_read_leaves_the_shape_and_is_listed(show_link: Callable[..., Any]):
    link = "{visual: {box: [1, 1, 1], material: {name: skin, texture: skin.png}}}"
    tab = show_link(link, {"skin.png": picture((255, 0, 0))[:20]}, {**FRONT, "panels": True})
    assert tab.locator(".problems").text_content().count("skin.png is not shown: it cannot be read") == 1
    low, high = extent(tab)
    assert np.allclose(high - low, 1)


def test_a_mesh_that_cannot_be_read_is_listed(show_link: Callable[..., Any]):
    tab = show_link("{visual: {mesh: m.gltf}}", {"m.gltf": b"{}"}, {**FRONT, "panels": True})
    assert "m.gltf is not shown: it cannot be read as .gltf" in tab.locator(".problems").text_content()


def test_half_of_a_mesh_is_listed_with_its_link_and_place(show_link: Callable[..., Any]):
    known, found = (content(block(1, 1, 1), form) for form in ("stl", "ply"))
    tab = show_link("{visual: {mesh: m.stl}}", {"m.stl": known[:300]}, {**FRONT, "panels": True})
    problems = tab.locator(".problems").text_content()
    assert "1 file not shown: the file ends before its data does, after 4 of 12 triangles" in problems
    assert "m.stl of part at " in problems
    # What Python does not look for, the reader of the page finds.
    tab = show_link("{visual: {mesh: m.ply}}", {"m.ply": found[:-40]}, {**FRONT, "panels": True})
    problems = tab.locator(".problems").text_content()
    assert "m.ply is not shown: the file ends before its data does" in problems
    assert re.search(r"of part at \S*r\.robot\.yaml:3", problems)


def test_a_texture_that_is_missing_leaves_the_mesh(show_link: Callable[..., Any]):
    files = {"m.obj": OBJ.encode(), "m.mtl": TEXTURED}
    assert min(middle(show_link("{visual: {mesh: m.obj}}", files))) > 150
