"""What an editor shows beside the text, and where the paths in it lead."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from lsprotocol import types

from tests.lsp.editor import Editor
from tests.lsp.test_hover import ARM_TEXT, CELL_TEXT, LEG, MOBILE, URDF_TEXT

ALL = {"inlayHints": {"si": True, "mass": True, "names": True}}
BODY = "  tip: {visual: {box: [10 cm, 0.1, 0.1]}, inertial: {density: 1000}}\n"


@pytest.fixture
def cell(tmp_path: Path) -> Path:
    """A folder with a cell of two arms and a URDF."""
    arm = ARM_TEXT.replace("  tip: {}\n", BODY)
    for name, text in (("arm.robot.yaml", arm), ("cell.robot.yaml", CELL_TEXT), ("old.urdf", URDF_TEXT)):
        (tmp_path / name).write_text(text)
    return tmp_path


def hints(editor: Editor, path: Path, first: int = 0, last: int = 10_000) -> Iterator[str]:
    """Yield the hints between two lines, as `LINE:COLUMN LABEL`."""
    visible = types.Range(types.Position(first, 0), types.Position(last, 0))
    params = types.InlayHintParams(editor.open(path), visible)
    for one in editor.ask(lambda client: client.text_document_inlay_hint_async(params)) or []:
        yield f"{one.position.line + 1}:{one.position.character} {one.label}"


def test_there_are_no_hints_unless_an_editor_wants_them(cell: Path):
    with Editor(cell) as editor:
        assert not list(hints(editor, cell / "arm.robot.yaml"))


def test_a_change_of_the_configuration_turns_hints_on_and_off(cell: Path):
    with Editor(cell) as editor:
        for wanted in (ALL, {}, ALL, {"inlayHints": None}):
            params = types.DidChangeConfigurationParams({"linkforge": wanted})
            editor.send(lambda client, params=params: client.workspace_did_change_configuration(params))
            assert bool(list(hints(editor, cell / "arm.robot.yaml"))) == (wanted is ALL)
        other = types.DidChangeConfigurationParams({"yaml": ALL})
        editor.send(lambda client: client.workspace_did_change_configuration(other))
        assert not list(hints(editor, cell / "arm.robot.yaml"))


LINKED = """\
linkforge: 1
name: linked
packages: {parts: parts}
include: [¦part.yaml]
data: {sizes: ¦sizes.yaml}
links:
  base: {}
  tip: {visual: {mesh: {file: ¦"package://parts/tip.stl"}}}
  end: {visual: {mesh: {file: ¦end.stl}}}
modules:
  old: {use: ¦old.urdf, srdf: ¦old.srdf, parent: base}
"""


def test_each_kind_of_path_links_to_its_file(tmp_path: Path):
    (tmp_path / "parts").mkdir()
    names = ["part.yaml", "sizes.yaml", "parts/tip.stl", "end.stl", "old.urdf", "old.srdf"]
    texts = {"part.yaml": "links: {part: {}}\n", "sizes.yaml": "a: 1\n", "old.urdf": URDF_TEXT}
    for name in names:
        (tmp_path / name).write_text(texts.get(name, '<robot name="old"/>'))
    places = [(line, len(text.split("¦")[0])) for line, text in enumerate(LINKED.split("\n")) if "¦" in text]
    with Editor(tmp_path) as editor:
        params = types.DocumentLinkParams(editor.open(tmp_path / "linked.robot.yaml", LINKED.replace("¦", "")))
        found = editor.ask(lambda client: client.text_document_document_link_async(params)) or []
    assert {one.target for one in found} == {(tmp_path / name).as_uri() for name in names}
    assert {(one.range.start.line, one.range.start.character) for one in found} >= set(places)


def test_hints_show_si_values_masses_and_final_names(cell: Path):
    with Editor(cell, options=ALL) as editor:
        editor.open(cell / "cell.robot.yaml")
        found = list(hints(editor, cell / "arm.robot.yaml"))
        assert list(hints(editor, cell / "arm.robot.yaml", 4, 4)) == [one for one in found if one.startswith("5:")]
    assert "5:6 left_base, right_base" in found
    assert "6:5 1 kg, inertia 0.00166667, 0.00166667, 0.00166667 kg·m², left_tip, right_tip" in found
    assert "6:28 = 0.1 m" in found
    assert any(one.endswith("= 50 N*m, = 60 N*m") for one in found), found
    assert any(one.endswith(" = 1.0471975511965976 rad/s") for one in found), found


def test_paths_link_to_their_files(cell: Path):
    with Editor(cell) as editor:
        params = types.DocumentLinkParams(editor.open(cell / "cell.robot.yaml"))
        found = editor.ask(lambda client: client.text_document_document_link_async(params)) or []
    assert [one.target for one in found] == [(cell / name).as_uri() for name in ("arm.robot.yaml",) * 2 + ("old.urdf",)]
    assert [one.tooltip for one in found][-1] == str(cell / "old.urdf")


@pytest.mark.parametrize(("path", "linked"), [(MOBILE, ["rover.robot.yaml", "gripper.robot.yaml"]), (LEG, [])])
def test_paths_in_the_examples_are_linked(path: Path, linked: list[str]):
    with Editor(path.parents[1], options=ALL) as editor:
        params = types.DocumentLinkParams(editor.open(path))
        found = editor.ask(lambda client: client.text_document_document_link_async(params)) or []
        assert list(hints(editor, path))
    names = {Path(str(one.target)).name for one in found}
    assert names >= set(linked)
    assert bool(names) == bool(linked)
