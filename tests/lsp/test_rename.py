"""Renaming a part in all specs that name it, or refusing to."""

from collections.abc import Mapping
from pathlib import Path

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcException

from linkforge_compile import compile_file, render_urdf
from tests.lsp.editor import Editor, split_at_cursor
from tests.lsp.test_navigation import ARM, CELL


@pytest.fixture
def robot(editor: Editor, tmp_path: Path) -> Path:
    """A cell of two arms, of which only what a test opens is open."""
    (tmp_path / "arm.robot.yaml").write_text(ARM)
    (tmp_path / "cell.robot.yaml").write_text(CELL)
    return tmp_path


def renamed(editor: Editor, path: Path, marked: str, new: str) -> Mapping[str, str]:
    """Return the texts of the files that a rename changes, by their names without ending."""
    text, position = split_at_cursor(marked)
    path.write_text(text)
    params = types.RenameParams(editor.open(path, text), position, new)
    edit = editor.ask(lambda client: client.text_document_rename_async(params))
    assert edit is not None
    files = {Path(uri.removeprefix("file://")): edits for uri, edits in (edit.changes or {}).items()}
    return {file.name.partition(".")[0]: applied(file.read_text(), edits) for file, edits in files.items()}


def applied(text: str, edits: object) -> str:
    lines = text.split("\n")
    assert isinstance(edits, list | tuple)
    for edit in sorted(edits, key=lambda one: (one.range.start.line, one.range.start.character), reverse=True):
        assert edit.range.start.line == edit.range.end.line
        line = lines[edit.range.start.line]
        lines[edit.range.start.line] = (
            line[: edit.range.start.character] + edit.new_text + line[edit.range.end.character :]
        )
    return "\n".join(lines)


def test_a_link_is_renamed_in_its_module_and_in_all_that_use_it(editor: Editor, robot: Path):
    found = renamed(editor, robot / "arm.robot.yaml", ARM.replace("child: tip", "child: t¦ip"), "hand")
    assert found == {"arm": ARM.replace("tip", "hand"), "cell": CELL.replace("_tip", "_hand")}


def test_a_name_with_a_prefix_is_renamed_without_it(editor: Editor, robot: Path):
    found = renamed(editor, robot / "cell.robot.yaml", CELL.replace("left_tip", "left_¦tip"), "left_hand")
    assert found == {"arm": ARM.replace("tip", "hand"), "cell": CELL.replace("_tip", "_hand")}


def test_joints_groups_and_states_are_renamed(editor: Editor, robot: Path):
    found = renamed(editor, robot / "arm.robot.yaml", ARM.replace("joints: [elbow", "joints: [¦elbow"), "wrist")
    assert found == {"arm": ARM.replace("elbow", "wrist"), "cell": CELL.replace("elbow", "wrist")}
    found = renamed(editor, robot / "arm.robot.yaml", ARM.replace("groups: {all", "groups: {¦all"), "most")
    assert found == {"arm": ARM.replace("all:", "most:"), "cell": CELL.replace("left_all", "left_most")}


def test_the_robot_differs_in_the_name_only(editor: Editor, robot: Path):
    before = render_urdf(compile_file(robot / "cell.robot.yaml").result())
    changed = renamed(editor, robot / "arm.robot.yaml", ARM.replace("  tip:", "  ¦tip:"), "hand")
    for name, text in changed.items():
        (robot / f"{name}.robot.yaml").write_text(text)
    after = render_urdf(compile_file(robot / "cell.robot.yaml").result())
    assert after == before.replace('_tip"', '_hand"') != before


def test_quoted_names_overrides_and_names_in_expressions_are_renamed(editor: Editor, robot: Path):
    arm = ARM.replace("joints: [elbow]", "joints: ['elbow']").replace(
        "name: arm", "name: arm\nextra: <a b=\"$(joint('elbow'))\"/>"
    )
    cell = CELL.replace("joint: neck", "joint: neck, override: {joints: {elbow: {limits: {effort: 2}}}}")
    (robot / "cell.robot.yaml").write_text(cell)
    found = renamed(editor, robot / "arm.robot.yaml", arm.replace("  elbow:", "  e¦lbow:"), "wrist")
    assert found == {"arm": arm.replace("elbow", "wrist"), "cell": cell.replace("elbow", "wrist")}


@pytest.mark.parametrize(
    ("marks", "new", "reason"),
    [
        (("child: tip", "child: ¦tip"), "base", "there is a link 'base' already"),
        (("child: tip", "child: ¦tip"), "my tip", "not a name that can be written without quotes"),
        (("child: tip", "child: ¦tip"), "on: x", "not a name that can be written without quotes"),
    ],
)
def test_a_new_name_that_cannot_be_is_refused(
    editor: Editor, robot: Path, marks: tuple[str, str], new: str, reason: str
):
    with pytest.raises(JsonRpcException, match=reason):
        renamed(editor, robot / "arm.robot.yaml", ARM.replace(*marks), new)


def test_another_prefix_is_refused(editor: Editor, robot: Path):
    with pytest.raises(JsonRpcException, match="must begin with 'left_'"):
        renamed(editor, robot / "cell.robot.yaml", CELL.replace("left_tip", "left_¦tip"), "hand")


def test_a_name_that_an_expression_makes_is_refused_with_its_place(editor: Editor, robot: Path):
    made = ARM.replace("  tip: {}", "  t$('i')p: {}")
    with pytest.raises(JsonRpcException, match=r"the name 'tip' is made of 't\$\('i'\)p' at .*arm.robot.yaml:5:3"):
        renamed(editor, robot / "arm.robot.yaml", made.replace("child: tip", "child: ¦tip"), "hand")


def test_a_name_in_text_that_plugins_read_is_refused_with_the_text(editor: Editor, robot: Path):
    plugin = ARM + "gazebo: {plugins: [{name: p, filename: p.so, parameters: {frame: the tip}}]}\n"
    with pytest.raises(JsonRpcException, match=r"text that others read.*<frame>the tip</frame>"):
        renamed(editor, robot / "arm.robot.yaml", plugin.replace("child: tip", "child: ¦tip"), "hand")


def test_a_name_of_a_urdf_is_refused(editor: Editor, robot: Path):
    (robot / "arm.urdf").write_text('<robot name="a"><link name="base"/></robot>')
    cell = CELL.replace("arm.robot.yaml", "arm.urdf").partition("semantic")[0] + "frames: {f: {parent: left_base}}\n"
    with pytest.raises(JsonRpcException, match=r"written in .*arm\.urdf, which is not a spec"):
        renamed(editor, robot / "cell.robot.yaml", cell.replace("left_base", "left_¦base"), "left_foot")


def test_what_is_no_name_of_a_part_cannot_be_renamed(editor: Editor, robot: Path):
    text, position = split_at_cursor(ARM.replace("name: arm", "na¦me: arm"))
    params = types.PrepareRenameParams(editor.open(robot / "arm.robot.yaml", text), position)
    assert editor.ask(lambda client: client.text_document_prepare_rename_async(params)) is None


def test_the_name_to_change_is_offered_without_quotes(editor: Editor, robot: Path):
    text, position = split_at_cursor(ARM.replace("[elbow]", "['el¦bow']"))
    params = types.PrepareRenameParams(editor.open(robot / "arm.robot.yaml", text), position)
    found = editor.ask(lambda client: client.text_document_prepare_rename_async(params))
    assert isinstance(found, types.PrepareRenamePlaceholder)
    assert (found.placeholder, found.range.start.character) == ("elbow", text.split("\n")[8].index("'elbow'") + 1)


def test_the_joint_of_a_frame_is_renamed_with_it(editor: Editor, robot: Path):
    arm = ARM.replace("semantic:", "frames: {eye: {parent: tip}}\nsemantic:").replace("[elbow]", "[elbow, eye_joint]")
    found = renamed(editor, robot / "arm.robot.yaml", arm.replace("{eye:", "{e¦ye:"), "lens")
    assert found == {"arm": arm.replace("eye", "lens")}
    found = renamed(editor, robot / "arm.robot.yaml", arm.replace("eye_joint", "eye_jo¦int"), "lens_joint")
    assert found == {"arm": arm.replace("eye", "lens")}
    with pytest.raises(JsonRpcException, match="must end with '_joint'"):
        renamed(editor, robot / "arm.robot.yaml", arm.replace("eye_joint", "eye_jo¦int"), "lens")


def test_a_state_is_renamed_where_others_consist_of_it(editor: Editor, robot: Path):
    cell = CELL.replace("group_states:", "groups: {both: {subgroups: [left_all, right_all]}}\n  group_states:")
    cell = cell.replace(
        "{left_elbow: 1}}}", "{left_elbow: 1}}, both: {rest: {left_all: left_home, right_all: right_home}}}"
    )
    (robot / "cell.robot.yaml").write_text(cell)
    found = renamed(editor, robot / "arm.robot.yaml", ARM.replace("{home:", "{ho¦me:"), "rest")
    assert found == {"arm": ARM.replace("home", "rest"), "cell": cell.replace("_home", "_rest")}


def test_a_name_after_an_expression_is_renamed(editor: Editor, robot: Path):
    cell = CELL.replace("{left_tip: {right_tip: Never}}", "{$(s)_tip: {for: {s: [left]}, value: {right_tip: Never}}}")
    (robot / "cell.robot.yaml").write_text(cell)
    found = renamed(editor, robot / "arm.robot.yaml", ARM.replace("  tip: {}", "  t¦ip: {}"), "hand")
    assert found == {"arm": ARM.replace("tip", "hand"), "cell": cell.replace("_tip", "_hand")}


def test_a_module_without_a_prefix_is_refused(editor: Editor, robot: Path):
    with pytest.raises(JsonRpcException, match="write 'prefix: left_' in its entry first"):
        renamed(editor, robot / "cell.robot.yaml", CELL.replace("  left: {use", "  le¦ft: {use"), "port")
    cell = CELL.replace("left: {use: arm.robot.yaml,", "left: {use: arm.robot.yaml, prefix: left_,")
    found = renamed(editor, robot / "cell.robot.yaml", cell.replace("  left: {use", "  le¦ft: {use"), "port")
    assert found == {"cell": cell.replace("  left:", "  port:")}


def test_a_spec_with_errors_is_refused_with_the_first_one(editor: Editor, robot: Path):
    faulty = ARM.replace("type: revolute", "type: revolt")
    with pytest.raises(JsonRpcException, match=r"mend the errors first: .*arm\.robot\.yaml:7:\d+"):
        renamed(editor, robot / "arm.robot.yaml", faulty.replace("  tip:", "  t¦ip:"), "hand")


def test_a_text_that_cannot_be_read_is_refused(editor: Editor, robot: Path):
    with pytest.raises(JsonRpcException, match="the text cannot be read; mend it first"):
        renamed(editor, robot / "arm.robot.yaml", ARM.replace("  tip: {}", "  t¦ip: {"), "hand")
