"""A stretch of text in a file, as a person counts: lines and columns from 1, columns in characters."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from linkforge_compile.source.file import SourceFile


class Position(NamedTuple):
    """A place between two characters; line and column count from 1."""

    line: int
    column: int


class Span(NamedTuple):
    """Half-open: from the first character to just behind the last one.

    Flat and a tuple because there is one for every scalar of a spec: a 10,000-link robot makes half a million.
    """

    file: SourceFile
    line: int
    column: int
    end_line: int
    end_column: int

    @property
    def start(self) -> Position:
        return Position(self.line, self.column)

    @property
    def end(self) -> Position:
        return Position(self.end_line, self.end_column)

    @property
    def order(self) -> tuple[int, str, int, int]:
        """A sort key: by file in the order they were read, then by place in the file."""
        return self.file.order, self.file.name, self.line, self.column

    @property
    def text(self) -> str | None:
        """What stands there; None for a span over several lines."""
        if self.line != self.end_line:
            return None
        return self.file.line(self.line)[self.column - 1 : self.end_column - 1]

    def within(self, offset: int, length: int) -> Span:
        """Return the part that begins `offset` characters in; for a span that lies on one line."""
        return self._replace(column=self.column + offset, end_line=self.line, end_column=self.column + offset + length)

    def __str__(self) -> str:
        return f"{self.file.name}:{self.line}:{self.column}"
