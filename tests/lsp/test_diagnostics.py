"""What the server reports of open specs: the texts of `linkforge check`, at once and for unsaved texts."""

from pathlib import Path

from lsprotocol import types

from linkforge_compile import check_file
from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.reports import without_repeats
from tests.lsp.editor import Editor

ARM = """\
linkforge: 1
name: arm
links:
  base: {}
  tip: {}
joints:
  elbow: {type: fixed, parent: base, child: tip}
"""
CELL = """\
linkforge: 1
name: cell
links:
  world: {}
modules:
  left: {use: arm.robot.yaml, parent: world, prefix: left_}
"""


def place(one: types.Diagnostic) -> tuple[int, int]:
    return one.range.start.line + 1, one.range.start.character + 1


def codes(found: list[types.Diagnostic]) -> list[object]:
    return [one.code for one in found]


def test_a_spec_without_faults_has_no_diagnostics(editor: Editor, tmp_path: Path):
    file = tmp_path / "arm.robot.yaml"
    editor.open(file, ARM)
    assert editor.diagnostics(file) == []


def test_diagnostics_are_those_of_check_with_their_pages(editor: Editor, tmp_path: Path):
    file = tmp_path / "arm.robot.yaml"
    file.write_text(ARM.replace("parent: base", "parent: bose").replace("type: fixed", "typ: fixed"))
    editor.open(file)
    found, report = editor.diagnostics(file), check_file(file).diagnostics
    assert [(one.code, place(one)) for one in found] == [
        (one.code.id, (one.span.line, one.span.column)) for one in report if one.span
    ]
    for one, expected in zip(found, report, strict=True):
        assert one.message.partition("\n")[0] == expected.message
        page = one.code_description.href.removeprefix("file://") if one.code_description else ""
        assert Path(page).read_text("utf-8").startswith(f"# {one.code}")


def test_an_unsaved_text_replaces_the_file_and_each_change_the_text_before(editor: Editor, tmp_path: Path):
    file = tmp_path / "arm.robot.yaml"
    file.write_text("nothing")
    editor.open(file, ARM)
    assert editor.diagnostics(file) == []
    editor.open(file, ARM.replace("child: tip", "child: top"))
    assert "LF4102" in codes(editor.diagnostics(file))
    editor.open(file, ARM)
    assert editor.diagnostics(file) == []


def test_a_text_that_does_not_parse_is_reported(editor: Editor, tmp_path: Path):
    file = tmp_path / "arm.robot.yaml"
    editor.open(file, ARM + "links: [\n")
    assert codes(editor.diagnostics(file))


def test_columns_count_utf_16_units(editor: Editor, tmp_path: Path):
    file = tmp_path / "arm.robot.yaml"
    editor.open(file, ARM.replace("elbow: {type", "🦾: {typ"))
    assert (7, 1 + len("  🦾🦾: {".replace("🦾🦾", "12"))) in map(place, editor.diagnostics(file))


def test_an_unsaved_module_is_checked_in_the_robot_that_uses_it(editor: Editor, tmp_path: Path):
    arm, cell = tmp_path / "arm.robot.yaml", tmp_path / "cell.robot.yaml"
    arm.write_text(ARM)
    editor.open(cell, CELL)
    assert editor.diagnostics(cell) == []
    editor.open(arm, ARM.replace("child: tip", "child: base"))
    [fault, *_] = editor.diagnostics(arm)
    assert place(fault)[0] == 7


def test_a_fault_that_only_the_use_shows_is_in_the_module_with_the_use_as_related(editor: Editor, tmp_path: Path):
    arm, cell = tmp_path / "arm.robot.yaml", tmp_path / "cell.robot.yaml"
    parameters = "parameters: {n: {type: number, default: 3}}\n"
    arm.write_text(
        ARM.replace("links:", f"{parameters}links:").replace("tip: {}", "tip: {visual: {sphere: $(1 / (n - 2))}}")
    )
    editor.open(cell, CELL.replace("prefix: left_", "prefix: left_, with: {n: 2}"))
    [fault] = editor.published(arm, bool)
    assert [info.location.uri for info in fault.related_information or ()] == [cell.as_uri()]
    editor.open(cell, CELL)
    assert editor.published(arm, lambda found: not found) == []


def test_a_fault_that_two_open_specs_share_is_reported_once_as_by_check(editor: Editor, tmp_path: Path):
    arm, cell = tmp_path / "arm.robot.yaml", tmp_path / "cell.robot.yaml"
    arm.write_text(ARM.replace("type: fixed", "type: revolute, limits: {effort: 1, velocity: 1}"))
    cell.write_text(CELL)
    expected = [((one.span.line, one.span.column), one.message) for one in check_files(arm, cell) if one.span]
    assert any(message.endswith("; the same for 'left_elbow'") for _, message in expected)
    editor.open(arm)
    editor.diagnostics(arm)
    editor.open(cell)
    found = editor.published(arm, lambda found: "the same" in str(found))
    assert [(place(one), one.message) for one in found] == expected
    assert not any("is here" in info.message for one in found for info in one.related_information or ())


def check_files(*files: Path) -> list[Diagnostic]:
    """Return what `check` reports of several specs."""
    return [*without_repeats(one for file in files for one in check_file(file).diagnostics)]


def test_a_part_without_a_name_is_checked_with_the_spec_that_includes_it(editor: Editor, tmp_path: Path):
    part, whole = tmp_path / "links.robot.yaml", tmp_path / "arm.robot.yaml"
    part.write_text("linkforge: 1\nlinks: {tip: {}}\n")
    whole.write_text(ARM.replace("  tip: {}\n", "").replace("links:", "include: [links.robot.yaml]\nlinks:"))
    editor.open(part)
    assert editor.diagnostics(part) == []
    editor.open(part, "linkforge: 1\nlinks: {top: {}}\n")
    assert "LF4102" in codes(editor.published(whole, bool))


def test_a_part_that_is_included_no_more_is_a_spec_without_a_name(editor: Editor, tmp_path: Path):
    part, whole = tmp_path / "links.robot.yaml", tmp_path / "arm.robot.yaml"
    part.write_text("linkforge: 1\nlinks: {tip: {}}\n")
    including = ARM.replace("  tip: {}\n", "").replace("links:", "include: [links.robot.yaml]\nlinks:")
    whole.write_text(including)
    editor.open(part)
    assert editor.diagnostics(part) == []
    editor.open(whole, ARM)
    assert codes(editor.published(part, bool)) == ["LF2003"]
    editor.open(whole, including)
    assert editor.published(part, lambda found: not found) == []


def test_a_file_that_changes_on_disk_is_read_again(editor: Editor, tmp_path: Path):
    arm, cell = tmp_path / "arm.robot.yaml", tmp_path / "cell.robot.yaml"
    editor.open(cell, CELL)
    assert codes(editor.diagnostics(cell))
    arm.write_text(ARM)
    change = types.FileEvent(arm.as_uri(), types.FileChangeType.Created)
    editor.notify_files([change])
    assert editor.published(cell, lambda found: not found) == []


def test_an_editor_that_can_watch_files_is_asked_to(tmp_path: Path):
    watching = types.DidChangeWatchedFilesClientCapabilities(dynamic_registration=True)
    abilities = types.ClientCapabilities(workspace=types.WorkspaceClientCapabilities(did_change_watched_files=watching))
    with Editor(tmp_path, abilities=abilities) as editor:
        editor.wait_for_registration(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)


def test_a_closed_file_loses_its_diagnostics(editor: Editor, tmp_path: Path):
    file = tmp_path / "arm.robot.yaml"
    editor.open(file, "links: [\n")
    assert editor.diagnostics(file)
    editor.close(file)
    assert editor.published(file, lambda found: not found) == []


def test_each_place_of_a_fault_that_many_parts_have_is_marked(editor: Editor, tmp_path: Path):
    file = tmp_path / "arm.robot.yaml"
    axis = "axis: z, limits: {effort: 1, velocity: 1, lower: 0, upper: 1}, mimic: {joint: knee}"
    text = ARM.replace("  tip: {}\n", "  tip: {}\n  foot: {}\n  f0: {}\n  f1: {}\n")
    text += "  knee: {type: fixed, parent: tip, child: foot}\n"
    text += "".join(f"  m{n}: {{type: revolute, parent: tip, child: f{n}, {axis}}}\n" for n in range(2))
    editor.open(file, text)
    file.write_text(text)
    report = check_file(file).diagnostics
    assert len(editor.diagnostics(file)) == sum(len(one.members) or 1 for one in report) > len(report)
