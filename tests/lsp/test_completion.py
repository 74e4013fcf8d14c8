"""What the server offers at positions in specs of examples/, and what accepting an item makes of them."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from lsprotocol import types

from tests.lsp.completion_cases import CASES, EXAMPLES, Case
from tests.lsp.editor import Editor, split_at_cursor


@pytest.fixture(scope="module")
def examples() -> Iterator[Editor]:
    """A server whose workspace is examples/."""
    with Editor(EXAMPLES) as editor:
        yield editor


def completions(editor: Editor, file: Path, text: str, position: types.Position) -> list[types.CompletionItem]:
    """Return what is offered at a position of a text, in the order shown."""
    document = editor.open(file, text)
    params = types.CompletionParams(document, position)
    found = editor.ask(lambda client: client.text_document_completion_async(params))
    assert isinstance(found, list)
    return sorted(found, key=lambda item: item.sort_text or item.label)


def accept(item: types.CompletionItem, text: str) -> str:
    """Return the text after an item is accepted."""
    edit = item.text_edit
    assert isinstance(edit, types.TextEdit)
    start, end = edit.range.start, edit.range.end
    assert start.line == end.line
    lines = text.split("\n")
    line = lines[start.line]
    lines[start.line] = line[: start.character] + edit.new_text + line[end.character :]
    return "\n".join(lines)


def show(case: Case) -> str:
    return f"{case.file.partition('/')[0]}: {case.new.strip().splitlines()[0]}"


@pytest.mark.parametrize("case", CASES, ids=show)
def test_a_position_in_an_example(case: Case, examples: Editor):
    file = EXAMPLES / case.file
    saved = file.read_text("utf-8")
    assert saved.count(case.old) >= 1
    examples.open(file, saved)
    assert examples.diagnostics(file) == []
    text, position = split_at_cursor(saved.replace(case.old, case.new, 1))
    found = completions(examples, file, text, position)
    labels = [item.label for item in found]
    offered = case.offered.split()
    assert set(offered) <= set(labels), labels
    assert not set(case.hidden.split()) & set(labels), labels
    assert len(set(labels)) == len(labels)
    if case.accepted:
        accepted = accept(next(item for item in found if item.label == case.accepted), text)
        assert accepted == saved.replace(case.old, case.makes, 1)
        examples.open(file, accepted)
        codes = [str(one.code) for one in examples.diagnostics(file)]
        assert not [code for code in codes if code.startswith("LF1")] if not case.is_clean else not codes
