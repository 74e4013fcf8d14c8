"""Show what is at a position: a part of the robot, a value and its origin, a name, the meaning of a key.

parts      the parts of the robot that a name names
values     values and their origins, for each use of the file
names      parameters, variables and data, and the names and functions in expressions
keys       what the schema says of a key
codes      codes of diagnostics in comments
text       how these are laid out
"""

from __future__ import annotations

from collections.abc import Iterator

from lsprotocol import types

from linkforge_compile.analysis import Settings
from linkforge_compile.lsp.cursor import Cursor, find_cursor
from linkforge_compile.lsp.hover.codes import show_code
from linkforge_compile.lsp.hover.keys import describe_key, show_key
from linkforge_compile.lsp.hover.names import show_bound, show_declared, show_name
from linkforge_compile.lsp.hover.parts import show_parts
from linkforge_compile.lsp.hover.text import RULE, seen_from
from linkforge_compile.lsp.hover.values import show_values
from linkforge_compile.lsp.placed import placed_at
from linkforge_compile.lsp.workspace import Document
from linkforge_compile.source import Position


def hover(document: Document, position: types.Position, settings: Settings) -> types.Hover | None:
    """Return what is known of a position, in Markdown; `settings` are those that specs are analysed with."""
    at = document.place(position)
    if shown := show_code(document.file, at):
        return _hover(shown)
    cursor = find_cursor(document.file, at)
    if cursor is None or not document.file.line(at.line)[max(at.column - 2, 0) : at.column].strip():
        return None
    found = list(dict.fromkeys(filter(None, _parts_of(document, at, cursor, settings))))
    if not found:
        return None
    sources = (source for analysis in document.analyses for source in analysis.sources)
    text = seen_from(document.path.parent, RULE.join(found), sources)
    return _hover(text, document.columns.range(cursor.word))


def _parts_of(document: Document, at: Position, cursor: Cursor, settings: Settings) -> Iterator[str]:
    if cursor.expression is not None:
        yield show_name(document, at)
        yield show_values(document, at) or show_bound(document, cursor, settings)
        return
    if declared := show_declared(document, cursor, settings):
        yield declared
        return
    yield show_parts(document, at, cursor) or show_values(document, at) or show_bound(document, cursor, settings)
    # What an alias inserts is described where it is used.
    yield show_key(cursor) or next((describe_key(one.path) for one in placed_at(document, at)), "")


def _hover(text: str, range_: types.Range | None = None) -> types.Hover:
    return types.Hover(types.MarkupContent(types.MarkupKind.Markdown, text), range_)
