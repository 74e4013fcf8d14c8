"""The outline of a spec, and the search for parts in a workspace."""

from collections.abc import Sequence
from pathlib import Path

import pytest
from lsprotocol import types
from pygls.workspace import PositionCodec

from linkforge_compile.lsp.convert import Columns
from linkforge_compile.lsp.symbols import MAX_FOUND, find_symbols
from linkforge_compile.lsp.workspace import Workspace
from linkforge_compile.source import Position, SourceFile
from tests.lsp.editor import Editor
from tests.lsp.test_navigation import ARM, CELL

EXAMPLES = Path(__file__).parents[2] / "examples"


def outline(editor: Editor, path: Path, text: str | None = None) -> list[str]:
    """Return the outline as lines, each part with its detail and the line of its name."""
    params = types.DocumentSymbolParams(editor.open(path, text))
    found = editor.ask(lambda client: client.text_document_document_symbol_async(params)) or []
    return [line for one in found for line in lines_of(one, "")]


def lines_of(symbol: object, indent: str) -> list[str]:
    assert isinstance(symbol, types.DocumentSymbol)
    selection, whole = symbol.selection_range, symbol.range
    assert whole.start <= selection.start <= selection.end <= whole.end
    own = f"{indent}{symbol.name} ({symbol.detail}) {selection.start.line + 1}"
    return [own, *(line for child in symbol.children or () for line in lines_of(child, f"{indent}  "))]


def test_links_and_joints_are_a_tree_and_the_rest_follows(editor: Editor, tmp_path: Path):
    assert outline(editor, tmp_path / "arm.robot.yaml", "variables: {v: 1}\n" + ARM) == [
        "base (link) 5",
        "  elbow (revolute joint) 8",
        "    tip (link) 6",
        "v (variable) 1",
        "all (group) 10",
        "home (state) 11",
    ]


def test_the_parts_of_modules_have_their_final_names_at_the_use(editor: Editor, tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(ARM)
    assert outline(editor, tmp_path / "cell.robot.yaml", CELL) == [
        "world (link) 4",
        "  left_joint (fixed joint) 6",
        "    left_base (link) 6",
        "      left_elbow (revolute joint) 6",
        "        left_tip (link) 6",
        "  neck (fixed joint) 7",
        "    right_base (link) 7",
        "      right_elbow (revolute joint) 7",
        "        right_tip (link) 7",
        "left (module) 6",
        "right (module) 7",
        "up (state) 10",
    ]


def test_repeated_links_are_in_the_outline_once_each(editor: Editor, tmp_path: Path):
    repeated = ARM.replace("  tip: {}\n", "  tip: {}\n  spare_$(i): {for: {i: [1, 2]}}\n")
    assert [line for line in outline(editor, tmp_path / "arm.robot.yaml", repeated) if "spare" in line] == [
        "spare_1 (link) 6",
        "spare_2 (link) 6",
    ]


def test_links_without_a_joint_are_in_the_outline(editor: Editor, tmp_path: Path):
    cycle = ARM.replace("parent: base", "parent: tip")
    assert outline(editor, tmp_path / "arm.robot.yaml", cycle)[:2] == ["base (link) 4", "tip (link) 5"]


def test_a_long_chain_has_an_outline(editor: Editor, tmp_path: Path):
    links = "".join(f"  l{number}: {{}}\n" for number in range(600))
    joints = "".join(f"  j{n}: {{type: fixed, parent: l{n}, child: l{n + 1}}}\n" for n in range(599))
    found = outline(editor, tmp_path / "chain.robot.yaml", f"linkforge: 1\nname: c\nlinks:\n{links}joints:\n{joints}")
    assert len(found) == 600 + 599


def test_a_spec_with_errors_has_an_outline_of_what_was_read(editor: Editor, tmp_path: Path):
    found = outline(editor, tmp_path / "arm.robot.yaml", ARM.replace("child: tip", "child: top"))
    assert "base (link) 4" in found
    assert "tip (link) 5" in found


def test_a_text_that_does_not_parse_has_the_outline_of_the_last_one_that_did(editor: Editor, tmp_path: Path):
    file = tmp_path / "arm.robot.yaml"
    assert outline(editor, file, "links: [") == []
    before = outline(editor, file, ARM)
    assert outline(editor, file, ARM + "links: [") == before
    moved = ["base (link) 6", "  elbow (revolute joint) 9", "    tip (link) 7", "all (group) 11", "home (state) 12"]
    assert outline(editor, file, ARM.replace("links:\n", "# two\n# lines [\nlinks: [\n")) == moved


def test_what_a_malformed_text_lacks_is_at_the_end_of_the_line_before(editor: Editor, tmp_path: Path):
    file = tmp_path / "arm.robot.yaml"
    assert "  elbow (revolute joint) 7" in outline(editor, file, ARM)
    lines = ARM.splitlines()
    found = outline(editor, file, "\n".join([*lines[:5], *lines[7:9], "  broken: [", *lines[9:]]))
    assert "  elbow (revolute joint) 5" in found
    assert "home (state) 9" in found


def search(editor: Editor, query: str) -> list[str]:
    params = types.WorkspaceSymbolParams(query)
    found = editor.ask(lambda client: client.workspace_symbol_async(params))
    assert isinstance(found, Sequence)
    return [f"{one.container_name}:{one.name}" for one in found]


def test_parts_of_all_specs_of_the_workspace_are_found_by_their_letters(editor: Editor, tmp_path: Path):
    (tmp_path / "arm.robot.yaml").write_text(ARM)
    (tmp_path / "cell.robot.yaml").write_text(CELL)
    assert search(editor, "elb") == ["arm.robot.yaml:elbow"]
    assert search(editor, "wd") == ["cell.robot.yaml:world"]
    assert search(editor, "nothing") == []
    editor.open(tmp_path / "arm.robot.yaml", ARM.replace("elbow", "wrist"))
    assert search(editor, "wri") == ["arm.robot.yaml:wrist"]


def found_in(folder: Path, query: str) -> list[str]:
    found = find_symbols(query, [folder], Workspace().settings(), Columns(PositionCodec()))
    return [one.name for one in found]


def test_places_in_a_long_line_are_converted_without_counting_it(tmp_path: Path):
    links = [f"l{number}: {{}}" for number in range(2000)]
    begin = "linkforge: 1\nname: h\nlinks: "
    (tmp_path / "x.robot.yaml").write_text(f"{begin}{{{', '.join(links)}}}\n")
    file = SourceFile("x", (tmp_path / "x.robot.yaml").read_text())
    units = _CountingCodec()
    assert Columns(units).position(file, Position(3, 9)) == types.Position(2, 8)
    assert Columns(units).place(file, types.Position(2, 8)) == Position(3, 9)
    assert units.counted == 0
    assert len(found_in(tmp_path, "l")) == MAX_FOUND
    assert found_in(tmp_path, "1999") == ["l1999"]


def test_columns_beyond_ascii_are_in_the_unit_of_the_client():
    file, columns = SourceFile("x", "a: 𝄞b\nab"), Columns(PositionCodec())
    assert columns.position(file, Position(1, 5)) == types.Position(0, 5)
    assert columns.place(file, types.Position(0, 5)) == Position(1, 5)
    assert columns.position(file, Position(2, 9)) == types.Position(1, 2)
    assert columns.place(file, types.Position(1, 9)) == Position(2, 3)


def test_a_search_counts_columns_only_of_what_it_finds(tmp_path: Path):
    (tmp_path / "x.robot.yaml").write_text("linkforge: 1\nname: h\nlinks: {l𝄞: {}, m: {}}\n")
    codec = _CountingCodec()
    assert find_symbols("zzz", [tmp_path], Workspace().settings(), Columns(codec)) == []
    assert codec.counted == 0


def test_a_search_reads_a_limited_part_of_a_workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    for name in "abc":
        (tmp_path / f"{name}.robot.yaml").write_text(f"linkforge: 1\nname: {name}\nlinks: {{link_{name}: {{}}}}\n")
    monkeypatch.setattr("linkforge_compile.lsp.symbols.MAX_CHARACTERS", 50)
    assert len(found_in(tmp_path, "link")) == 2


class _CountingCodec(PositionCodec):
    """Counts how often units are counted, which takes time for each character of a text."""

    counted = 0

    def client_num_units(self, chars: Sequence[str]) -> int:
        self.counted += 1
        return super().client_num_units(chars)


def test_a_text_that_never_parsed_has_the_parts_of_the_sections_that_do(editor: Editor, tmp_path: Path):
    text = "linkforge: 1\nname: arm\nlinks:\n  base: {}\nmaterials: {red: [\njoints:\n  elbow: {type: fixed}\n"
    (tmp_path / "arm.robot.yaml").write_text(text)
    assert outline(editor, tmp_path / "arm.robot.yaml") == ["base (link) 4", "elbow (joint) 7"]


def test_every_example_has_an_outline_with_all_its_links(editor: Editor):
    for path in sorted(EXAMPLES.rglob("*.robot.yaml")):
        assert outline(editor, path), path
