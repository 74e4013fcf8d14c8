"""Edits that format a text or make another of it, of changed lines only: cursors and marks on others stay."""

from __future__ import annotations

from difflib import SequenceMatcher
from itertools import accumulate

from lsprotocol import types

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.formatter import format_source
from linkforge_compile.lsp.workspace import Document


def format_edits(document: Document) -> list[types.TextEdit]:
    """Return the edits that format a text; none if it is not YAML."""
    formatted = format_source(document.file, Diagnostics())
    return [] if formatted is None else edits_to(formatted, document)


def edits_to(text: str, document: Document) -> list[types.TextEdit]:
    """Return the edits of whole lines that make another text of a document."""
    file = document.file
    before, after = file.counted.splitlines(keepends=True), text.removeprefix("\ufeff").splitlines(keepends=True)
    starts = [0, *accumulate(map(len, before))]
    changes = SequenceMatcher(None, before, after).get_opcodes()
    return [
        types.TextEdit(document.columns.range(file.between(starts[begin], starts[end])), "".join(after[first:last]))
        for change, begin, end, first, last in changes
        if change != "equal"
    ]
