"""Formatting a document: edits of the lines that change."""

from pathlib import Path

import pytest
from lsprotocol import types

from linkforge_compile.formatter import format_text
from tests.lsp.editor import Editor

OPTIONS = types.FormattingOptions(tab_size=8, insert_spaces=False)

WRITTEN = """\
linkforge: 1
name:   arm
description: größer als 😀   # 😀 linkforge: ignore LF6003



links: { base: }
joints: {}"""


def edits_of(editor: Editor, path: Path, text: str) -> list[types.TextEdit]:
    params = types.DocumentFormattingParams(editor.open(path, text), OPTIONS)
    return list(editor.ask(lambda client: client.text_document_formatting_async(params)) or [])


def applied(text: str, edits: list[types.TextEdit]) -> str:
    """Return the text after edits whose columns are all 0, or at the end of the text."""
    lines = text.splitlines(keepends=True)
    starts = [sum(map(len, lines[:number])) for number in range(len(lines) + 1)]

    def index(at: types.Position) -> int:
        is_end = at.line == len(lines) - 1 and at.character == len(lines[-1].encode("utf-16-le")) // 2
        assert is_end or at.character == 0
        return len(text) if is_end else starts[at.line]

    for edit in sorted(edits, key=lambda one: one.range.start, reverse=True):
        text = text[: index(edit.range.start)] + edit.new_text + text[index(edit.range.end) :]
    return text


@pytest.mark.parametrize("text", [WRITTEN, WRITTEN + "\n", WRITTEN + "\n\n\n", WRITTEN.replace("\n", "\r\n"), "", "\n"])
def test_the_edits_give_what_the_command_gives(editor: Editor, tmp_path: Path, text: str):
    edits = edits_of(editor, tmp_path / "arm.robot.yaml", text)
    assert applied(text, edits) == format_text(text)


def test_only_lines_that_change_are_edited(editor: Editor, tmp_path: Path):
    edits = edits_of(editor, tmp_path / "arm.robot.yaml", WRITTEN + "\n")
    lines = [(one.range.start.line + 1, one.range.end.line + 1, one.new_text) for one in edits]
    assert lines == [(2, 3, "name: arm\n"), (5, 8, "links: {base: }\n")]
    assert edits_of(editor, tmp_path / "arm.robot.yaml", format_text(WRITTEN)) == []


def test_a_text_that_does_not_parse_stays(editor: Editor, tmp_path: Path):
    assert edits_of(editor, tmp_path / "arm.robot.yaml", "links: [\n  {a:   1]\n") == []
