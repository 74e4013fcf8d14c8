"""What is known of a text that does not parse: the analysis of its last version that did, with its places moved.

A line that both versions have moves along. In a line that changed, the words before and after the change keep their
places. What was in other lines is now where these were.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable
from difflib import SequenceMatcher
from itertools import takewhile

from lsprotocol import types

from linkforge_compile.lsp.convert import Columns
from linkforge_compile.lsp.workspace import Document
from linkforge_compile.roots import identity
from linkforge_compile.source import Position, SourceFile


def as_last_read(document: Document, at: types.Position | None = None) -> Document:
    """Return a document, or what is known of its last version that parsed if it is malformed now.

    The version now is returned for a position in words that the last version does not have.
    """
    last = document.readable if document.is_malformed else None
    sources = last.sources if last is not None else ()
    file = next((one for one in sources if one.path and identity(one.path) == identity(document.path)), None)
    if last is None or file is None:
        return document
    columns = _MovedColumns(document.columns, _Changes(file, document.file))
    if at is not None and not columns.has(at):
        return document
    return document._replace(file=file, analyses=(last,), columns=columns)


class _Changes:
    """The differences between two versions of a file: the lines that correspond, and what changed in these."""

    def __init__(self, old: SourceFile, new: SourceFile) -> None:
        self.old = old
        self.new = new
        self._new_lines: dict[int, int] = {}
        for _, begin, end, first, last in SequenceMatcher(None, old.lines, new.lines).get_opcodes():
            self._new_lines |= zip(range(begin + 1, end + 1), range(first + 1, last + 1), strict=False)
        self._old_lines = {line: old_line for old_line, line in self._new_lines.items()}
        self._kept: dict[int, tuple[int, int]] = {}

    def to_new(self, at: Position) -> Position:
        """Return where a place in the old version is in the new one; the end of the line before for one in no line."""
        line = self._new_lines.get(at.line)
        if line is not None:
            return Position(line, _moved(at.column, self.old.line(at.line), self.new.line(line), self._common(at.line)))
        known = [*self._new_lines]
        index = bisect_left(known, at.line)
        before = self._new_lines[known[index - 1]] if index else 1
        return Position(before, len(self.new.line(before)) + 1 if index else 1)

    def to_old(self, at: Position) -> Position | None:
        """Return where a place in the new version was in the old one; None for one in words that it does not have."""
        old_line = self._old_lines.get(at.line)
        if old_line is None:
            return None
        line, (head, tail) = self.new.line(at.line), self._common(old_line)
        if head < at.column - 1 < len(line) - tail or head + tail == 0 < len(line):
            return None
        return Position(old_line, _moved(at.column, line, self.old.line(old_line), (head, tail)))

    def _common(self, old_line: int) -> tuple[int, int]:
        """Return how many characters a line kept at its beginning and, of the others, at its end."""
        if old_line not in self._kept:
            old, new = self.old.line(old_line), self.new.line(self._new_lines[old_line])
            head = _equal(old, new)
            self._kept[old_line] = head, _equal(reversed(old[head:]), reversed(new[head:]))
        return self._kept[old_line]


def _equal(one: Iterable[str], other: Iterable[str]) -> int:
    """Return how many characters are equal at the beginning."""
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(one, other, strict=False)))


def _moved(column: int, line: str, other: str, common: tuple[int, int]) -> int:
    """Return the column in another version of a line that has what is at a column of this one, or the nearest."""
    head, tail = common
    if column - 1 <= head:
        return column
    return max(column + len(other) - len(line), len(other) - tail + 1) if column - 1 >= len(line) - tail else head + 1


class _MovedColumns(Columns):
    """Converts places in the old version of a file to positions in the new one, and back; others as before."""

    def __init__(self, columns: Columns, changes: _Changes) -> None:
        self._columns = columns
        self._changes = changes

    def position(self, file: SourceFile, at: Position) -> types.Position:
        old = self._changes.old
        if file is old or (file.path == old.path and file.text == old.text):
            file, at = self._changes.new, self._changes.to_new(at)
        return self._columns.position(file, at)

    def has(self, at: types.Position) -> bool:
        """Whether the old version has what is at a position in the new one."""
        return self._changes.to_old(self._columns.place(self._changes.new, at)) is not None

    def place(self, file: SourceFile, at: types.Position) -> Position:
        if file is not self._changes.old:
            return self._columns.place(file, at)
        place = self._columns.place(self._changes.new, at)
        return self._changes.to_old(place) or place
