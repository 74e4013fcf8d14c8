"""Parameters, variables, data and names of `for`: where they are declared and used, and what a rename changes."""

from pathlib import Path

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcException

from tests.lsp.editor import Editor, split_at_cursor
from tests.lsp.test_navigation import definition, references
from tests.lsp.test_rename import renamed

ARM = """\
linkforge: 1
name: arm
include: [hand.robot.yaml]
parameters:
  reach: {type: length, default: 1 m, description: reach}
variables:
  half: $(reach / 2)
data:
  offsets: offsets.yaml
variants:
  long: {reach: 2 m}
links:
  base: {}
  "part_$(i)": {for: {i: 2}, visual: {box: [$(i + 1), 1, 1]}}
joints:
  joint_$(i):
    {for: {i: 2}, type: fixed, parent: base, child: part_$(i), origin: {xyz: ["$(half)", $(offsets.y), $( reach*2 )]}}
"""
HAND = """\
linkforge: 1
frames:
  tip: {parent: base, origin: {xyz: [$(reach), 0, 0]}}
"""
CELL = """\
linkforge: 1
name: cell
parameters:
  reach: {type: length, default: 3 m}
links:
  world: {}
modules:
  left: {use: arm.robot.yaml, parent: world, with: {reach: $(reach)}}
  arm_$(side): {for: {side: [a, b]}, use: arm.robot.yaml, parent: world, with: {reach: 4 m}}
"""


@pytest.fixture
def robot(editor: Editor, tmp_path: Path) -> Path:
    """A cell of three arms, open in the editor with the files of its module."""
    (tmp_path / "offsets.yaml").write_text("y: 0.5\n")
    for name, text in (("hand", HAND), ("arm", ARM), ("cell", CELL)):
        (tmp_path / f"{name}.robot.yaml").write_text(text)
        editor.open(tmp_path / f"{name}.robot.yaml")
    return tmp_path


@pytest.mark.parametrize(
    ("file", "marks", "declared"),
    [
        ("arm", ("$(reach / 2)", "$(re¦ach / 2)"), ["arm:5:reach"]),
        ("arm", ("long: {reach", "long: {¦reach"), ["arm:5:reach"]),
        ("arm", ("$( reach*2", "$( reach¦*2"), ["arm:5:reach"]),
        ("arm", ("$(half)", "$(¦half)"), ["arm:7:half"]),
        ("arm", ("$(offsets.y)", "$(off¦sets.y)"), ["arm:9:offsets"]),
        ("arm", ("child: part_$(i)", "child: part_$(¦i)"), ["arm:17:i"]),
        ("arm", ("$(i + 1)", "$(i¦ + 1)"), ["arm:14:i"]),
        ("hand", ("$(reach)", "$(reach¦)"), ["arm:5:reach"]),
        ("cell", ("with: {reach: $", "with: {re¦ach: $"), ["arm:5:reach"]),
        ("cell", ("reach: 4 m", "re¦ach: 4 m"), ["arm:5:reach"]),
        ("cell", ("$(reach)", "$(re¦ach)"), ["cell:4:reach"]),
        ("cell", ("arm_$(side)", "arm_$(si¦de)"), ["cell:9:side"]),
    ],
)
def test_the_declaration_of_a_name(editor: Editor, robot: Path, file: str, marks: tuple[str, str], declared: list[str]):
    text = {"arm": ARM, "hand": HAND, "cell": CELL}[file]
    assert marks[0] in text
    assert definition(editor, robot / f"{file}.robot.yaml", text.replace(*marks, 1)) == declared


def test_the_uses_of_a_parameter_are_those_in_its_files_and_where_it_is_set(editor: Editor, robot: Path):
    found = references(editor, robot / "arm.robot.yaml", ARM.replace("  reach:", "  r¦each:"))
    uses = ["arm:5:reach", "arm:7:reach", "arm:11:reach", "arm:17:reach", "hand:3:reach"]
    assert sorted(found) == sorted([*uses, "cell:8:reach", "cell:9:reach"])


def test_a_name_of_for_is_used_in_its_entry_only(editor: Editor, robot: Path):
    found = references(editor, robot / "arm.robot.yaml", ARM.replace("joint_$(i)", "joint_$(i¦)"))
    assert sorted(found) == ["arm:16:i", "arm:17:i", "arm:17:i"]


def test_a_parameter_is_renamed_in_its_files_and_where_it_is_set(editor: Editor, robot: Path):
    found = renamed(editor, robot / "arm.robot.yaml", ARM.replace("  reach:", "  ¦reach:"), "span")
    arm = ARM.replace("reach", "span").replace("description: span", "description: reach")
    assert found == {
        "arm": arm,
        "hand": HAND.replace("reach", "span"),
        "cell": CELL.replace("with: {reach", "with: {span"),
    }


@pytest.mark.parametrize(("old", "new"), [("half", "middle"), ("offsets", "places")])
def test_variables_and_data_are_renamed(editor: Editor, robot: Path, old: str, new: str):
    found = renamed(editor, robot / "arm.robot.yaml", ARM.replace(f"$({old}", f"$(¦{old}"), new)
    assert found == {"arm": ARM.replace(old, new).replace(f"{new}.yaml", f"{old}.yaml")}


def test_a_name_of_for_is_renamed_in_its_entry(editor: Editor, robot: Path):
    found = renamed(editor, robot / "cell.robot.yaml", CELL.replace("{side:", "{s¦ide:"), "which")
    assert found == {"cell": CELL.replace("side", "which")}


@pytest.mark.parametrize(
    ("new", "reason"),
    [
        ("half", "half"),
        ("sqrt", "sqrt"),
        ("a-b", "not a name that expressions can use"),
        ("1st", "not a name that expressions can use"),
    ],
)
def test_a_new_name_that_cannot_be_is_refused(editor: Editor, robot: Path, new: str, reason: str):
    with pytest.raises(JsonRpcException, match=reason):
        renamed(editor, robot / "arm.robot.yaml", ARM.replace("  reach:", "  re¦ach:"), new)


def test_a_symbolic_link_to_a_spec_is_the_spec(editor: Editor, robot: Path):
    link = robot / "link.robot.yaml"
    link.symlink_to(robot / "arm.robot.yaml")
    found = definition(editor, link, ARM.replace("$(half)", "$(ha¦lf)"))
    assert [one.partition(":")[2] for one in found] == ["7:half"]


def test_a_document_without_a_file_has_no_declarations(editor: Editor, robot: Path):
    params = types.DefinitionParams(types.TextDocumentIdentifier("untitled:Untitled-1"), types.Position(2, 2))
    assert not editor.ask(lambda client: client.text_document_definition_async(params))
    rename = types.RenameParams(params.text_document, params.position, "other")
    assert editor.ask(lambda client: client.text_document_rename_async(rename)) is None


def test_names_in_a_file_with_errors_have_declarations(editor: Editor, robot: Path):
    arm = ARM.replace("type: fixed", "typo: fixed").replace(
        "half: $(reach / 2)", "half: $(reach /)\n  third: $(re¦ach)"
    )
    assert definition(editor, robot / "arm.robot.yaml", arm) == ["arm:5:reach"]
    assert definition(editor, robot / "arm.robot.yaml", ARM.replace("links:", "links: [\n¦")) == []


@pytest.mark.parametrize(
    ("file", "marks", "target"),
    [
        ("cell", ("use: arm.robot", "use: arm¦.robot"), "arm.robot.yaml"),
        ("arm", ("[hand.robot", "[ha¦nd.robot"), "hand.robot.yaml"),
        ("arm", ("offsets.yaml", "offsets.ya¦ml"), "offsets.yaml"),
    ],
)
def test_the_definition_of_a_path_is_its_file(
    editor: Editor, robot: Path, file: str, marks: tuple[str, str], target: str
):
    text, position = split_at_cursor({"arm": ARM, "cell": CELL}[file].replace(*marks, 1))
    params = types.DefinitionParams(editor.open(robot / f"{file}.robot.yaml", text), position)
    found = editor.ask(lambda client: client.text_document_definition_async(params))
    assert isinstance(found, list | tuple)
    assert [one.uri for one in found if isinstance(one, types.Location)] == [(robot / target).as_uri()]


def test_columns_count_without_byte_order_mark_and_line_ends(editor: Editor, robot: Path):
    path = robot / "arm.robot.yaml"
    text, position = split_at_cursor(
        ARM.replace("description: reach", "description: 🤖").replace("$( reach", "$( r¦each")
    )
    document = editor.open(path, "\ufeff" + text.replace("\n", "\r\n"))
    edit = editor.ask(lambda client: client.text_document_rename_async(types.RenameParams(document, position, "span")))
    assert edit is not None
    assert edit.changes is not None
    places = sorted((one.range.start.line + 1, one.range.start.character) for one in edit.changes[path.as_uri()])
    lines = text.split("\n")
    expected = [(5, 2), (7, lines[6].index("reach")), (11, lines[10].index("reach")), (17, lines[16].index("reach"))]
    assert places == expected
