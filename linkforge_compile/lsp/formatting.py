"""The edits that format a text: of the lines that change only, so that cursors and marks on others stay."""

from __future__ import annotations

from difflib import SequenceMatcher
from itertools import accumulate

from lsprotocol import types

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.formatter import format_source
from linkforge_compile.lsp.workspace import Document


def format_edits(document: Document) -> list[types.TextEdit]:
    """Return the edits that format a text; none if it is not YAML."""
    file = document.file
    formatted = format_source(file, Diagnostics())
    if formatted is None:
        return []
    # A formatted text has none of the other characters at which splitlines splits.
    before, after = file.counted.splitlines(keepends=True), formatted.removeprefix("\ufeff").splitlines(keepends=True)
    starts = [0, *accumulate(map(len, before))]
    changes = SequenceMatcher(None, before, after).get_opcodes()
    return [
        types.TextEdit(document.columns.range(file.between(starts[begin], starts[end])), "".join(after[first:last]))
        for change, begin, end, first, last in changes
        if change != "equal"
    ]
