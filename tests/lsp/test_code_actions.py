"""Quick fixes, comments that ignore a diagnostic, and all safe fixes of a text, asked for over the wire."""

from collections.abc import Sequence
from pathlib import Path

from lsprotocol import types

from tests.lsp.editor import Editor

SPEC = """\
linkforge: 1
name: arm
links:
  base:
  tip: {gazebo: {extra: "<!--𝄞-->"}, inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 5}}}
joints:
  weld: {type: fixed, parent: base, child: tpi}
"""


def actions(
    editor: Editor, path: Path, text: str, at: str, only: Sequence[str] | None = None
) -> list[types.CodeAction]:
    """Return the actions at a word of a text, with the diagnostics that the editor shows there."""
    document = editor.open(path, text)
    before = text[: text.index(at)]
    column = len(before.rpartition("\n")[2].encode("utf-16-le")) // 2
    place = types.Position(before.count("\n"), column)
    shown = [one for one in editor.diagnostics(path) if one.range.start == place]
    params = types.CodeActionParams(
        document, types.Range(place, place), types.CodeActionContext(shown, None if only is None else list(only))
    )
    found = editor.ask(lambda client: client.text_document_code_action_async(params)) or []
    return [action for action in found if isinstance(action, types.CodeAction)]


def applied(action: types.CodeAction, path: Path, text: str) -> str:
    """Return a text after an action, as an editor applies it: columns are in UTF-16."""
    assert action.edit is not None
    assert action.edit.changes is not None
    ((uri, edits),) = action.edit.changes.items()
    assert uri == path.as_uri()
    lines = [line.encode("utf-16-le") for line in text.splitlines(keepends=True)]
    for edit in sorted(edits, key=lambda edit: (edit.range.start.line, edit.range.start.character), reverse=True):
        start, end = edit.range.start, edit.range.end
        after = lines[end.line][2 * end.character :] if end.line < len(lines) else b""
        lines[start.line : end.line + 1] = [
            lines[start.line][: 2 * start.character] + edit.new_text.encode("utf-16-le") + after
        ]
    return b"".join(lines).decode("utf-16-le")


def test_a_suggestion_is_a_quick_fix_of_its_diagnostic(editor: Editor, tmp_path: Path):
    path = tmp_path / "arm.robot.yaml"
    (action,) = actions(editor, path, SPEC, "tpi", ["quickfix"])
    assert (action.title, action.kind, action.is_preferred) == ("write 'tip'", "quickfix", None)
    assert [one.code for one in action.diagnostics or ()] == ["LF4102"]
    assert applied(action, path, SPEC) == SPEC.replace("tpi", "tip")


def test_a_safe_fix_is_preferred(editor: Editor, tmp_path: Path):
    path, text = tmp_path / "arm.robot.yaml", SPEC.replace("fixed", "Fixed")
    (action,) = actions(editor, path, text, "Fixed", ["quickfix"])
    assert (action.title, action.is_preferred) == ("write 'fixed'", True)
    assert applied(action, path, text) == SPEC


def test_a_warning_can_be_ignored_by_a_comment(editor: Editor, tmp_path: Path):
    path, text = tmp_path / "arm.robot.yaml", SPEC.replace("tpi", "tip")
    (action,) = actions(editor, path, text, "{ixx", ["quickfix"])
    assert action.title == "ignore LF6003 here"
    changed = applied(action, path, text)
    assert changed == text.replace("  tip:", "  # linkforge: ignore LF6003\n  tip:")
    editor.open(path, changed)
    assert "LF6003" not in [one.code for one in editor.diagnostics(path)]


def test_all_safe_fixes_are_one_action(editor: Editor, tmp_path: Path):
    path, text = tmp_path / "arm.robot.yaml", SPEC.replace("mass: 1", "mass: 1 KG").replace("fixed", "Fixed")
    (action,) = actions(editor, path, text, "linkforge", ["source.fixAll"])
    assert action.kind == "source.fixAll.linkforge"
    assert applied(action, path, text) == text.replace("KG", "kg").replace("Fixed", "fixed")


def test_a_safe_fix_that_brings_an_error_is_not_among_all(editor: Editor, tmp_path: Path):
    """As in `check --fix`: with `Base` for `base`, the joints form a cycle."""
    text = """\
linkforge: 1
name: a
links: {Base: {}, t: {}, u: {}}
joints:
  j: {type: fixed, parent: Base, child: t}
  k: {type: fixed, parent: t, child: base}
  l: {type: fixed, parent: Base, child: u}
"""
    path = tmp_path / "arm.robot.yaml"
    assert actions(editor, path, text, "base", ["source.fixAll"]) == []
    assert [one.is_preferred for one in actions(editor, path, text, "base}", ["quickfix"])] == [None]
    other = text.replace("type: fixed, parent: Base, child: u", "type: Fixed, parent: Base, child: u")
    (action,) = actions(editor, path, other, "base", ["source.fixAll"])
    assert applied(action, path, other) == text


def test_errors_that_a_syntax_error_hid_are_among_all(editor: Editor, tmp_path: Path):
    path, text = tmp_path / "arm.robot.yaml", SPEC.replace("name: arm", "name:arm").replace("fixed", "Fixed")
    (action,) = actions(editor, path, text, "name", ["source.fixAll"])
    assert applied(action, path, text) == SPEC


def test_a_text_that_does_not_parse_is_fixed(editor: Editor, tmp_path: Path):
    path, text = tmp_path / "arm.robot.yaml", SPEC.replace("name: arm", "name:arm")
    (action,) = actions(editor, path, text, "name:arm", ["quickfix"])
    assert applied(action, path, text) == SPEC


def test_only_what_is_asked_for_is_returned(editor: Editor, tmp_path: Path):
    path = tmp_path / "arm.robot.yaml"
    assert actions(editor, path, SPEC, "tpi", ["refactor"]) == []
    text = SPEC.replace("fixed", "Fixed")
    assert {one.kind for one in actions(editor, path, text, "Fixed")} == {"quickfix"}
    assert {one.kind for one in actions(editor, path, text, "Fixed", ["source"])} == {"source.fixAll.linkforge"}


def test_there_is_nothing_to_do_away_from_a_diagnostic(editor: Editor, tmp_path: Path):
    assert actions(editor, tmp_path / "arm.robot.yaml", SPEC, "links", ["quickfix"]) == []


def test_a_fault_of_a_module_is_fixed_in_the_module(editor: Editor, tmp_path: Path):
    """Also if only the spec that uses it shows the fault."""
    user = tmp_path / "cell.robot.yaml"
    user.write_text("linkforge: 1\nname: cell\nlinks: {w: }\nmodules: {a: {use: arm.robot.yaml, parent: w}}\n")
    editor.open(user)
    path = tmp_path / "arm.robot.yaml"
    path.write_text(SPEC)
    found = actions(editor, path, SPEC, "tpi", ["quickfix"])
    assert [action.title for action in found] == ["write 'tip'"]


def test_the_server_says_which_actions_it_has(editor: Editor):
    provider = editor.capabilities.code_action_provider
    assert isinstance(provider, types.CodeActionOptions)
    assert list(provider.code_action_kinds or ()) == ["quickfix", "source.fixAll.linkforge"]


def test_edits_have_the_version_of_the_text_that_they_are_for(tmp_path: Path):
    resource = types.WorkspaceEditClientCapabilities(document_changes=True)
    abilities = types.ClientCapabilities(workspace=types.WorkspaceClientCapabilities(workspace_edit=resource))
    path, text = tmp_path / "arm.robot.yaml", SPEC.replace("fixed", "Fixed")
    with Editor(tmp_path, abilities=abilities) as editor:
        editor.open(path, SPEC)
        found = actions(editor, path, text, "Fixed", ["quickfix", "source.fixAll"])
    assert [one.kind for one in found] == ["quickfix", "source.fixAll.linkforge"]
    for action in found:
        assert action.edit is not None
        assert action.edit.changes is None
        (change,) = action.edit.document_changes or ()
        assert isinstance(change, types.TextDocumentEdit)
        assert (change.text_document.uri, change.text_document.version) == (path.as_uri(), 2)
        assert [edit.range.start.line for edit in change.edits] == [6]
