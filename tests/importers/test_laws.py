"""What holds for every robot that URDF can say: written as URDF, imported and compiled, it is the robot that it was."""

import tempfile
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile import import_urdf, render_srdf, render_urdf
from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.importers.link import named_colors
from linkforge_compile.importers.xml import read_xml
from linkforge_compile.source import SourceFile
from tests.export_spec.test_laws import compiled, few, robots


def as_urdf_states_it(robot: Robot) -> Robot:
    """Return a robot without what an import writes in another place: the materials of visuals."""
    robot = robot.clone()
    robot.links = [
        replace(link, visuals=[replace(visual, material=None) for visual in link.visuals]) for link in robot.links
    ]
    return robot


def imported(robot: Robot) -> str:
    with tempfile.TemporaryDirectory() as folder:
        urdf, srdf = Path(folder) / "robot.urdf", Path(folder) / "robot.srdf"
        urdf.write_text(render_urdf(robot), "utf-8")
        srdf.write_text(render_srdf(robot), "utf-8")
        read = import_urdf(urdf, srdf=srdf)
    assert read.text is not None, read.diagnostics
    assert not read.losses
    return read.text


def is_writable(robot: Robot) -> bool:
    try:
        render_urdf(robot), render_srdf(robot)
    except RobotGeneratorError:
        return False
    return True


def elements(document: str) -> object:
    """Return the content of a document, with its elements in any order, because raw ones are written last."""
    return _sorted(ElementTree.fromstring(document))


def _sorted(element: ElementTree.Element) -> tuple[object, ...]:
    children = sorted(map(_sorted, element), key=repr)
    return element.tag, sorted(element.attrib.items()), (element.text or "").strip(), children


@few
@given(robots.map(as_urdf_states_it).filter(is_writable))
def test_an_imported_robot_has_all_its_elements(robot: Robot):
    again = compiled(imported(robot))
    assert elements(render_urdf(again)) == elements(render_urdf(robot))
    assert elements(render_srdf(again)) == elements(render_srdf(robot))
    assert shapes(render_urdf(again)) == shapes(render_urdf(robot))
    assert colors(render_urdf(again)) == colors(render_urdf(robot))


def shapes(document: str) -> dict[str, list[str]]:
    """Return for each link the tags of its shapes in their order."""
    links = ElementTree.fromstring(document).iter("link")
    return {link.get("name", ""): [one.tag for one in link if one.tag in {"visual", "collision"}] for link in links}


def colors(document: str) -> list[tuple[str, tuple[float | None, ...]]]:
    """Return the names of materials with their colors, in their order."""
    read = read_xml(SourceFile("r.urdf", document), Diagnostics())
    assert read
    return [(name, color) for _, name, color in named_colors(read.root)]


def first_of_each(
    colors: list[tuple[str, tuple[float | None, ...]]],
) -> dict[str, tuple[float | None, ...]]:
    """Return the first color of each name: what MuJoCo takes for all who only name it."""
    return dict(reversed(colors))


@few
@given(robots.filter(is_writable))
def test_what_came_in_once_stays_as_it_is(robot: Robot):
    first = compiled(imported(robot))
    assert first_of_each(colors(render_urdf(first))) == first_of_each(colors(render_urdf(robot)))
    spec = imported(first)
    second = compiled(spec)
    assert (render_urdf(second), render_srdf(second)) == (render_urdf(first), render_srdf(first))
    assert imported(second) == spec


PAINT = '<material name="a"><color rgba="{} 0 0 1"/></material>'
LOOKS = ("", '<material name="a"/>', PAINT.format(1), PAINT.format(0.5))
IN_GEOMETRY = "", "text", '<box size="1 1 1"/>'
"""What follows the sphere: a shape with text in it loses the text, and one with two shapes stays raw and comes last."""
KINDS = "visual", "collision"
SHAPES = st.lists(st.tuples(*map(st.sampled_from, (KINDS, LOOKS, IN_GEOMETRY))), max_size=6)


@few
@given(SHAPES, st.sampled_from(LOOKS[2:]), st.booleans())
def test_an_import_tells_exactly_where_mujoco_shows_another_color(
    shapes: list[tuple[str, str, str]], own: str, own_comes_first: bool
):
    link = "".join(
        f'<{kind}><geometry><sphere radius="{size}"/>{more}</geometry>{look if kind == "visual" else ""}</{kind}>'
        for size, (kind, look, more) in enumerate(shapes, start=1)
    )
    parts = [own, f'<link name="l">{link}</link>']
    document = f'<robot name="r">{"".join(parts if own_comes_first else reversed(parts))}</robot>'
    read = import_urdf("r.urdf", text=document)
    is_reported = bool({"LF8140", "LF8141"} & {loss.code.id for loss in read.losses})
    assert is_reported == (seen_in_mujoco(render_urdf(compiled(read.text or ""))) != seen_in_mujoco(document))


def seen_in_mujoco(document: str) -> dict[float, str]:
    """Return the color of each sphere by its radius: as its URDF reader goes on with the last color that it met."""
    robot, color, seen = ElementTree.fromstring(document), "", dict[float, str]()
    first = {one.get("name"): one for one in reversed(list(robot.iter("material"))) if one.find("color") is not None}
    for shape in robot.findall("link/*"):
        material = shape.find("material")
        if material is not None:
            color = words_of(first[material.get("name")] if material.find("color") is None else material)
        seen[float(shape.find("geometry/sphere").get("radius"))] = color
    return seen


def words_of(material: ElementTree.Element) -> str:
    return " ".join(f"{float(word):g}" for word in material.find("color").get("rgba").split())
