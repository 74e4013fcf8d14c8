"""From a name to the place that declares it, and to all places that use it."""

from collections.abc import Sequence
from pathlib import Path

import pytest
from lsprotocol import types

from tests.lsp.editor import Editor, split_at_cursor

ARM = """\
linkforge: 1
name: arm
links:
  base: {}
  tip: {}
joints:
  elbow: {type: revolute, parent: base, child: tip, axis: z, limits: {effort: 1, velocity: 1}}
semantic:
  groups: {all: {joints: [elbow]}}
  group_states: {all: {home: {elbow: 0}}}
"""
CELL = """\
linkforge: 1
name: cell
links:
  world: {}
modules:
  left: {use: arm.robot.yaml, parent: world}
  right: {use: arm.robot.yaml, parent: world, joint: neck}
semantic:
  disabled_collisions: {left_tip: {right_tip: Never}}
  group_states: {left_all: {up: {left_elbow: 1}}}
"""


@pytest.fixture
def robot(editor: Editor, tmp_path: Path) -> Path:
    """A cell of two arms, open in the editor with its module."""
    for name, text in (("arm", ARM), ("cell", CELL)):
        (tmp_path / f"{name}.robot.yaml").write_text(text)
        editor.open(tmp_path / f"{name}.robot.yaml")
    return tmp_path


def shown(locations: object) -> list[str]:
    """Return locations as `FILE:LINE:WORD`."""
    found = []
    for one in locations if isinstance(locations, Sequence) else []:
        assert isinstance(one, types.Location)
        path = Path(one.uri.removeprefix("file://"))
        line = path.read_text().split("\n")[one.range.start.line]
        word = line[one.range.start.character : one.range.end.character]
        found.append(f"{path.name.partition('.')[0]}:{one.range.start.line + 1}:{word}")
    return found


def definition(editor: Editor, path: Path, marked: str) -> list[str]:
    text, position = split_at_cursor(marked)
    document = editor.open(path, text)
    params = types.DefinitionParams(document, position)
    return shown(editor.ask(lambda client: client.text_document_definition_async(params)))


def test_macros_and_arguments_lead_to_their_declarations_in_the_xacro(editor: Editor, tmp_path: Path):
    """Also to one in a file that the xacro includes."""
    root = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n{}\n</robot>'
    macro = '<xacro:macro name="wheel" params="prefix"><link name="${prefix}rim"/></xacro:macro>'
    (tmp_path / "wheel.xacro").write_text(root.format(macro))
    (tmp_path / "parts.xacro").write_text(root.format('<xacro:include filename="wheel.xacro"/>'))
    entry = (
        "linkforge: 1\nname: cart\nlinks: {base: }\nmodules:\n  left: {use: parts.xacro, macro: whe¦el, parent: base}\n"
    )
    assert definition(editor, tmp_path / "cart.robot.yaml", entry) == ["wheel:2:wheel"]
    set_ = entry.replace("whe¦el", "wheel").replace("parent: base}", "parent: base, with: {pre¦fix: a_}}")
    assert definition(editor, tmp_path / "cart.robot.yaml", set_) == ["wheel:2:prefix"]
    (tmp_path / "leg.xacro").write_text(root.format('<xacro:arg name="side" default="left"/><link name="foot"/>'))
    argument = "  left: {use: leg.xacro, parent: base, with: {si¦de: right}}\n"
    leg = f"linkforge: 1\nname: cart\nlinks: {{base: }}\nmodules:\n{argument}"
    assert definition(editor, tmp_path / "cart.robot.yaml", leg) == ["leg:2:side"]
    unknown = entry.replace("whe¦el", "whe¦l")
    assert definition(editor, tmp_path / "cart.robot.yaml", unknown) == []


def references(editor: Editor, path: Path, marked: str) -> list[str]:
    text, position = split_at_cursor(marked)
    document = editor.open(path, text)
    params = types.ReferenceParams(types.ReferenceContext(include_declaration=True), document, position)
    return shown(editor.ask(lambda client: client.text_document_references_async(params)))


@pytest.mark.parametrize(
    ("file", "marks", "declared"),
    [
        ("arm", ("parent: base", "parent: ba¦se"), ["arm:4:base"]),
        ("arm", ("joints: [elbow]", "joints: [¦elbow]"), ["arm:7:elbow"]),
        ("arm", ("{all: {home", "{all¦: {home"), ["arm:9:all"]),
        ("arm", ("{home: {elbow", "{home: {elb¦ow"), ["arm:7:elbow"]),
        ("arm", ("tip: {}", "t¦ip: {}"), ["arm:5:tip"]),
        ("cell", ("left_tip", "left¦_tip"), ["arm:5:tip"]),
        ("cell", ("left_all", "left_a¦ll"), ["arm:9:all"]),
        ("cell", ("left_elbow", "left_elbow¦"), ["arm:7:elbow"]),
        ("cell", ("parent: world}", "parent: w¦orld}"), ["cell:4:world"]),
        ("cell", ("name: cell", "na¦me: cell"), []),
    ],
)
def test_the_declaration_of_a_name(editor: Editor, robot: Path, file: str, marks: tuple[str, str], declared: list[str]):
    marked = {"arm": ARM, "cell": CELL}[file].replace(*marks, 1)
    assert definition(editor, robot / f"{file}.robot.yaml", marked) == declared


def test_the_uses_of_a_modules_link_are_those_of_each_of_its_uses(editor: Editor, robot: Path):
    found = references(editor, robot / "arm.robot.yaml", ARM.replace("  tip: {}", "  t¦ip: {}"))
    assert sorted(found) == ["arm:5:tip", "arm:7:tip", "cell:9:left_tip", "cell:9:right_tip"]


def test_uses_are_found_in_specs_that_are_not_open(editor: Editor, robot: Path):
    editor.close(robot / "cell.robot.yaml")
    found = references(editor, robot / "arm.robot.yaml", ARM.replace("child: tip", "child: ti¦p"))
    assert sorted(found) == ["arm:5:tip", "arm:7:tip", "cell:9:left_tip", "cell:9:right_tip"]


def test_a_name_with_a_prefix_names_one_use_only(editor: Editor, robot: Path):
    found = references(editor, robot / "cell.robot.yaml", CELL.replace("left_tip", "left_¦tip"))
    assert sorted(found) == ["arm:5:tip", "arm:7:tip", "cell:9:left_tip"]


def test_highlights_are_those_of_the_file(editor: Editor, robot: Path):
    text, position = split_at_cursor(ARM.replace("joints: [elbow]", "joints: [el¦bow]"))
    params = types.DocumentHighlightParams(editor.open(robot / "arm.robot.yaml", text), position)
    found = editor.ask(lambda client: client.text_document_document_highlight_async(params)) or []
    assert [one.range.start.line + 1 for one in found] == [7, 9, 10]


def test_a_position_beyond_the_text_names_nothing(editor: Editor, robot: Path):
    params = types.DefinitionParams(editor.open(robot / "arm.robot.yaml"), types.Position(10_000, 10_000))
    assert editor.ask(lambda client: client.text_document_definition_async(params)) == []


def test_the_joint_of_a_repeated_module_is_declared_by_its_key(editor: Editor, robot: Path):
    cell = CELL.replace("left: {use", "$(s): {for: {s: [left]}, use")
    cell = cell.replace("semantic:", "semantic:\n  passive_joints: [left_joint]")
    (robot / "cell.robot.yaml").write_text(cell)
    found = definition(editor, robot / "cell.robot.yaml", cell.replace("[left_joint]", "[left¦_joint]"))
    assert found == ["cell:6:$(s)"]


BROKEN = [
    ("parent: ba¦se", "parent: base", ["arm:5:base"]),
    ("joints: [elb¦ow]", "joints: [elbow]", ["arm:8:elbow"]),
    ("child: ti¦p, axis: [", "child: tip, axis: z", ["arm:6:tip"]),
    ("{effort: 1, vel¦", "{effort: 1, vel", []),
    ("  t¦ip: {}", "  tip: {}", ["arm:6:tip"]),
]


@pytest.mark.parametrize(("marked", "plain", "declared"), BROKEN)
def test_declarations_are_found_in_a_text_that_does_not_parse(
    editor: Editor, robot: Path, marked: str, plain: str, declared: list[str]
):
    """They are those of the last text that did, moved along with their lines."""
    broken = ARM.replace(plain, marked, 1).replace("links:\n", "links: {\n# a line more\n")
    (robot / "arm.robot.yaml").write_text(broken.replace("¦", ""))
    assert definition(editor, robot / "arm.robot.yaml", broken) == declared


def test_a_line_that_the_last_text_does_not_have_names_nothing(editor: Editor, robot: Path):
    broken = ARM.replace("  tip: {}\n", "  tip: {}\n  elbow¦: [\n")
    assert definition(editor, robot / "arm.robot.yaml", broken) == []
    assert references(editor, robot / "arm.robot.yaml", broken) == []


def test_uses_and_highlights_are_found_in_a_text_that_does_not_parse(editor: Editor, robot: Path):
    file, broken = (
        robot / "arm.robot.yaml",
        ARM.replace("links:\n", "links: {\n").replace("joints: [el", "joints: [el¦"),
    )
    file.write_text(broken.replace("¦", ""))
    assert references(editor, file, broken) == ["arm:7:elbow", "arm:9:elbow", "arm:10:elbow", "cell:10:left_elbow"]
    text, position = split_at_cursor(broken)
    params = types.DocumentHighlightParams(editor.open(file, text), position)
    found = editor.ask(lambda client: client.text_document_document_highlight_async(params)) or []
    assert [one.range.start.line + 1 for one in found] == [7, 9, 10]


def test_a_malformed_file_that_a_spec_includes_keeps_its_declarations(editor: Editor, tmp_path: Path):
    part, whole = tmp_path / "links.robot.yaml", tmp_path / "arm.robot.yaml"
    part.write_text("linkforge: 1\nlinks:\n  base: {}\n  tip: {inertial: {mass: 1}}\n")
    whole.write_text(ARM.replace("links:\n  base: {}\n  tip: {}\n", "include: [links.robot.yaml]\n"))
    assert definition(editor, part, part.read_text().replace("tip", "ti¦p")) == ["links:4:tip"]
    assert definition(editor, part, part.read_text().replace("tip", "ti¦p").replace("1}}", "1}")) == ["links:4:tip"]
