"""Source maps: each line of the output leads to the line of the spec that wrote it, and costs no byte of it."""

import json
import re
from functools import cache
from pathlib import Path
from textwrap import dedent

import pytest
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft7Validator
from lxml import etree

from linkforge_compile import Robot, compile_file, compile_text, render_srdf, render_urdf
from linkforge_compile.export_spec import explain
from linkforge_compile.formats.map_file import NoMapError, map_text, read_map
from linkforge_compile.formats.render import render_srdf_with_map, render_urdf_with_map
from linkforge_compile.formats.source_map import Mapped, SourceMap
from linkforge_compile.source import Span
from linkforge_compile.source.provenance import Kind
from tests.conftest import ROOT
from tests.formats.everything import everything
from tests.formats.test_laws import unhurried

SPECS = sorted([*(ROOT / "examples").rglob("*.robot.yaml"), *(ROOT / "tests/cases/good").rglob("*.robot.yaml")])
SCHEMA = Draft7Validator(json.loads((Path(__file__).parent / "source_map.schema.json").read_text("utf-8")))


@pytest.fixture(params=SPECS, ids=lambda path: path.name.removesuffix(".robot.yaml"))
def spec(request: pytest.FixtureRequest) -> Path:
    path: Path = request.param
    return path


@pytest.fixture
def robot(spec: Path) -> Robot:
    return compiled(spec)


@pytest.fixture
def urdf(spec: Path) -> Mapped:
    return mapped_urdf(spec)


@cache
def compiled(spec: Path) -> Robot:
    return compile_file(spec).result()


@cache
def mapped_urdf(spec: Path) -> Mapped:
    return render_urdf_with_map(compiled(spec))


def written(source_map: SourceMap, line: int, column: int | None = None) -> Span:
    place = source_map.at(line, column)
    assert place is not None, f"line {line} is not mapped"
    return place.span


def test_a_map_changes_no_byte(robot: Robot, urdf: Mapped):
    assert urdf.text == render_urdf(robot)
    assert render_srdf_with_map(robot).text == render_srdf(robot)
    classic = render_urdf_with_map(robot, gazebo="classic", banner="two\n<robot>\nlines").text
    assert classic == render_urdf(robot, gazebo="classic", banner="two\n<robot>\nlines")


def test_a_robot_built_in_python_has_a_map_of_nothing():
    mapped = render_urdf_with_map(everything())
    assert mapped.text == render_urdf(everything())
    assert not any(mapped.map.lines)
    assert mapped.map.at(1) is None
    assert mapped.map.at(10_000) is None


def test_every_line_of_an_element_is_mapped(robot: Robot, urdf: Mapped):
    for mapped in (urdf, render_srdf_with_map(robot)):
        tags = [number for number, line in enumerate(mapped.text.split("\n"), start=1) if line and line[1] != "?"]
        assert [number for number in tags if mapped.map.at(number) is None] == []


def names_written_at(span: Span) -> re.Pattern[str]:
    """Return a pattern of the names that the key at a place can give, with any prefix and any values in it."""
    pattern = "".join(".*" if part.startswith("$(") else re.escape(part) for part in KEY_PARTS.findall(span.text or ""))
    line = span.file.line(span.line)
    named = "|".join(f".*{re.escape(name)}" for name in re.findall(r"\bjoint: (\w[^\s,}]*)", line))
    return re.compile(f".*{pattern}(_joint)?|{named}")


KEY_PARTS = re.compile(r"\$\([^)]*\)|[^$]+")


@pytest.mark.parametrize("tag", ["link", "joint"])
def test_a_link_or_joint_leads_to_the_key_that_names_it(urdf: Mapped, tag: str):
    for element in etree.fromstring(urdf.text.encode()).findall(tag):
        place = written(urdf.map, element.sourceline)
        if element.get("name") != "world":  # which a mount may have made
            assert names_written_at(place).fullmatch(element.get("name")), place


KEYS = {"origin": "origin", "parent": "parent", "axis": "axis", "limit": "limits", "mimic": "mimic"}
"""The key of each element of a joint whose place is held against the one that `explain` finds by another way."""


def some(elements: list[etree._Element]) -> list[etree._Element]:
    """Return up to ten of a list, from all of its length, because each takes an `explain` of the whole robot."""
    return elements[:: 1 + len(elements) // 10]


def test_the_parts_of_a_joint_lead_to_where_explain_finds_them(robot: Robot, urdf: Mapped):
    count = 0
    for joint in some(etree.fromstring(urdf.text.encode()).findall("joint")):
        for part in joint.iterchildren(*KEYS):
            explanation = explain(robot, f"joints/{joint.get('name')}/{KEYS[part.tag]}")
            if explanation.is_written:
                assert explanation.provenance
                assert written(urdf.map, part.sourceline) == explanation.provenance.span, (
                    joint.get("name"),
                    part.tag,
                )
                count += 1
    assert count or len(robot.joints) == 0


def test_an_attribute_leads_to_its_own_value(robot: Robot, urdf: Mapped):
    lines = urdf.text.split("\n")
    for limit in some(etree.fromstring(urdf.text.encode()).findall("joint/limit")):
        for attribute in {"lower", "upper", "effort", "velocity"} & set(limit.attrib):
            column = lines[limit.sourceline - 1].index(f"{attribute}=") + 1
            joint = limit.getparent().get("name")
            explanation = explain(robot, f"joints/{joint}/limits/{attribute}")
            assert explanation.provenance
            assert written(urdf.map, limit.sourceline, column) == explanation.provenance.span
            assert urdf.map.at(limit.sourceline, column + 3).spans(Kind.USE) == explanation.provenance.spans(Kind.USE)


SPEC = """\
linkforge: 1
name: all
parameters: {push: 7}
defaults:
  joint:
    limits: {effort: 5, velocity: 9}
materials: {red: {color: [1, 0, 0], texture: red.png}}
links:
  base:
    visual:
      mesh: hull.stl
      material: red
    collision: {sphere: 0.5}
    inertial: {mass: 2}
    physics: {mu: 0.3}
    gazebo:
      mu2: 0.4
      properties: {odd: {_a: 1, inner: [x, y]}}
    extra: |
      <one>
        <two/>
      </one>
    extra_attributes: {kind: hull}
  arm:
joints:
  hinge: {type: revolute, parent: base, child: arm, axis: y, limits: {lower: -1, upper: 1, effort: $(push)}}
sensors:
  eye:
    type: camera
    link: arm
    update_rate: 12
    camera: {width: 320, noise: {stddev: 0.1}}
transmissions:
  gear: {type: transmission_interface/SimpleTransmission, joints: {hinge: }, actuators: {motor: {offset: 0.1}}}
ros2_control:
  system:
    hardware_plugin: mock/System
    parameters: {slow: 5}
    joints: {hinge: {command_interfaces: {effort: {max: 3}}, state_interfaces: [position, velocity]}}
gazebo:
  plugins: {brain: {filename: libbrain.so, parameters: {rate: 50}}}
semantic:
  groups: {reach: {joints: [hinge]}}
  group_states: {reach: {up: {hinge: 0.5}}}
  disabled_collisions: {base: {arm: Adjacent}}
  no_default_collision_links: [arm]
"""


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Mapped]:
    path = tmp_path_factory.mktemp("whole") / "all.robot.yaml"
    path.write_text(SPEC, encoding="utf-8")
    robot = compile_file(path).result()
    return {"urdf": render_urdf_with_map(robot), "srdf": render_srdf_with_map(robot)}


@pytest.mark.parametrize(
    ("output", "line"),
    [
        ('<robot name="all">', "name: all"),
        ('<color rgba="1 0 0 1"/>', "materials:"),
        ('<texture filename="red.png"/>', "materials:"),
        ('<link name="base" kind="hull">', "  base:"),
        ('<mass value="2"/>', "    inertial: {mass: 2}"),
        ('<inertia ixx="0.2" ', "    inertial: {mass: 2}"),
        ('<mesh filename="hull.stl"/>', "      mesh: hull.stl"),
        ('<material name="red"/>', "      material: red"),
        ('<sphere radius="0.5"/>', "    collision: {sphere: 0.5}"),
        ("<one>", "      <one>"),
        ("<two/>", "        <two/>"),
        ("</one>", "      <one>"),
        ('<child link="arm"/>', "  hinge:"),
        ("<hardwareInterface>position", "  gear:"),
        ("<offset>0.1</offset>", "  gear:"),
        ("<plugin>mock/System</plugin>", "    hardware_plugin: mock/System"),
        ('<param name="slow">5</param>', "    parameters: {slow: 5}"),
        ('<param name="max">3</param>', "    joints: {hinge:"),
        ('<state_interface name="velocity"/>', "    joints: {hinge:"),
        ("<mu1>0.3</mu1>", "    physics: {mu: 0.3}"),
        ("<mu2>0.4</mu2>", "      mu2: 0.4"),
        ('<odd a="1">', "      properties:"),
        ("<inner>y</inner>", "      properties:"),
        ('<plugin name="brain"', "  plugins: {brain:"),
        ("<rate>50</rate>", "  plugins: {brain:"),
        ("<update_rate>12</update_rate>", "    update_rate: 12"),
        ("<width>320</width>", "    camera:"),
        ("<height>480</height>", "    camera:"),
        ("<stddev>0.1</stddev>", "    camera:"),
        ('<group name="reach">', "  groups:"),
        ('<joint name="hinge"/>', "  groups:"),
        ('<joint name="hinge" value="0.5"/>', "  group_states:"),
        ('<disable_collisions link1="base" link2="arm" reason="Adjacent"/>', "  disabled_collisions:"),
        ('<disable_default_collisions link="arm"/>', "  arm:"),
    ],
)
def test_a_line_leads_to_what_wrote_it(whole: dict[str, Mapped], output: str, line: str):
    mapped, number = next(
        (mapped, number)
        for mapped in whole.values()
        for number, text in enumerate(mapped.text.split("\n"), start=1)
        if text.strip().startswith(output)
    )
    span = written(mapped.map, number)
    assert span.file.line(span.line).startswith(line)


@pytest.mark.parametrize(
    ("attribute", "text"), [("lower", "-1"), ("upper", "1"), ("effort", "$(push)"), ("velocity", "9")]
)
def test_a_default_and_an_expression_lead_to_where_they_stand(whole: dict[str, Mapped], attribute: str, text: str):
    lines = whole["urdf"].text.split("\n")
    number = next(number for number, line in enumerate(lines, start=1) if "<limit " in line)
    column = lines[number - 1].index(f"{attribute}=") + 1
    assert written(whole["urdf"].map, number, column).text == text
    assert written(whole["urdf"].map, number, 1).text == "{lower: -1, upper: 1, effort: $(push)}"


def test_an_override_an_include_and_a_use_are_on_the_trail(tmp_path: Path):
    (tmp_path / "parts").mkdir()
    (tmp_path / "arm.robot.yaml").write_text(
        dedent("""\
            linkforge: 1
            name: arm
            include: [parts/joints.yaml]
            links: {root: , tip: }
        """)
    )
    (tmp_path / "parts" / "joints.yaml").write_text(
        dedent("""\
            linkforge: 1
            joints:
              turn: {type: continuous, parent: root, child: tip, axis: z, limits: {effort: 1, velocity: 2}}
        """)
    )
    cell = tmp_path / "cell.robot.yaml"
    cell.write_text(
        dedent("""\
            linkforge: 1
            name: cell
            links: {table: }
            modules:
              left:
                use: arm.robot.yaml
                parent: table
                override: {joints: {turn: {limits: {effort: 8}}}}
        """)
    )
    mapped = render_urdf_with_map(compile_file(cell).result())
    lines = mapped.text.split("\n")
    number = next(number for number, line in enumerate(lines, start=1) if "<limit " in line)
    effort, velocity = (mapped.map.at(number, lines[number - 1].index(name) + 1) for name in ("effort", "velocity"))
    assert (effort.span.file.name, effort.span.text, effort.spans(Kind.USE)) == (str(cell), "8", ())
    assert velocity.span.text == "2"
    assert [use.text for use in velocity.spans(Kind.USE)] == ["arm.robot.yaml"]

    whole = json.loads(map_text(*mapped, "cell.urdf", tmp_path / "build"))
    paths = {source["path"] for source in whole["sources"]}
    assert paths == {"../cell.robot.yaml", "../arm.robot.yaml", "../parts/joints.yaml"}
    [*_, trail] = whole["mappings"][str(number)][-1]
    assert [how for step in whole["trails"][trail] for how in step] == ["included", "used"]


def test_the_file_of_a_map_fits_its_schema_and_reads_back(urdf: Mapped):
    text = map_text(*urdf, "robot.urdf", ROOT / "examples")
    SCHEMA.validate(json.loads(text))
    assert text == map_text(*urdf, "robot.urdf", ROOT / "examples")
    assert str(ROOT) not in text
    read = read_map(text)
    lines = urdf.text.split("\n")
    for number, line in enumerate(lines, start=1):
        for column in range(1, len(line) + 1, 7):
            place, found = urdf.map.at(number, column), read.at(number, column)
            assert (place is None) == (found is None)
            if place and found:
                stretch, _ = found
                path = (ROOT / "examples" / read.sources[stretch.source].path).resolve()
                assert (path, *stretch[1:3]) == (place.span.file.path.resolve(), place.span.line, place.span.column)


json_values = st.recursive(
    st.none() | st.integers() | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
)
nearly_maps = st.fixed_dictionaries(
    {"version": st.just(1) | json_values, "sha256": st.text() | json_values},
    optional={
        "sources": st.lists(st.fixed_dictionaries({"path": st.text(), "sha256": st.text()})) | json_values,
        "trails": st.lists(st.lists(st.dictionaries(st.text(), st.lists(st.integers(0, 2))))) | json_values,
        "mappings": st.dictionaries(st.integers(0, 9).map(str), st.lists(st.lists(st.integers(0, 1)))) | json_values,
    },
)


@unhurried
@given(nearly_maps.map(json.dumps) | st.text())
def test_what_is_no_map_is_refused(text: str):
    try:
        read = read_map(text)
    except NoMapError:
        return
    for line in read.mappings:
        read.at(line)


@pytest.mark.parametrize("text", ["[" * 100_000, "{}", '{"version": 2}', "1e999", '{"version": 1, "mappings": 3}'])
def test_a_hostile_map_is_refused(text: str):
    with pytest.raises(NoMapError):
        read_map(text)


def test_lines_that_raw_xml_keeps_lead_to_their_element_and_later_ones_to_their_own():
    robot = compile_text("""
linkforge: 1
name: r
extra: |
  <note>
    <!-- first
  second -->
    <text>1
  2</text>
  </note>
links:
  base:
""").result()
    mapped = render_urdf_with_map(robot)
    assert mapped.text == render_urdf(robot)
    lines = mapped.text.splitlines()
    assert written(mapped.map, lines.index("second -->") + 1).line == 5
    assert written(mapped.map, lines.index("2</text>") + 1).line == 8
    assert written(mapped.map, lines.index("  </note>") + 1).line == 5


def test_no_line_of_a_text_is_mapped_where_an_expression_of_it_has_two():
    spec = "linkforge: 1\nname: r\nlinks: {base: }\nextra: |\n  <a v='$(1 +\n    2)'>\n    <b/>\n  </a>\n"
    mapped = render_urdf_with_map(compile_text(spec).result())
    assert written(mapped.map, mapped.text.splitlines().index("    <b/>") + 1).line == 4
