"""The classes of names, numbers and texts in expressions."""

from pathlib import Path

from lsprotocol import types

from linkforge_compile.lsp.semantic_tokens import LEGEND
from tests.lsp.editor import Editor


def tokens(editor: Editor, path: Path, text: str) -> list[str]:
    """Return the tokens of a text, as `KIND WORD`."""
    params = types.SemanticTokensParams(editor.open(path, text))
    found = editor.ask(lambda client: client.text_document_semantic_tokens_full_async(params))
    assert found is not None
    shown, line, character, lines = [], 0, 0, text.split("\n")
    for index in range(0, len(found.data), 5):
        down, right, length, kind, _ = found.data[index : index + 5]
        line, character = line + down, right + (0 if down else character)
        shown.append(
            f"{types.SemanticTokenTypes(LEGEND.token_types[kind]).value} {lines[line][character : character + length]}"
        )
    return shown


def test_expressions_have_tokens(editor: Editor, tmp_path: Path):
    text = """\
linkforge: 1
name: a
description: é $(max(reach, 2) * rows[0].size) $(link('tip'))
parameters: {reach: {type: number, default: 1}}
variables: {rows: [{size: 3}], folded: "$(reach
  + 1)"}
links: {tip: {}, part_$(i): {for: {i: [1, $(pi)]}}}
"""
    assert tokens(editor, tmp_path / "a.robot.yaml", text) == [
        "function max",
        "parameter reach",
        "number 2",
        "variable rows",
        "number 0",
        "property size",
        "function link",
        "string 'tip'",
        "variable i",
        "number pi",
    ]
    assert tokens(editor, tmp_path / "a.robot.yaml", "links: [") == []
