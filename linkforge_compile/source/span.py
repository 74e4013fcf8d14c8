"""A stretch of text in a file, as a person counts: lines and columns from 1, columns in characters."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

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

    def lies_in(self, other: Span) -> bool:
        """Whether the whole of it stands in another stretch of its file."""
        return self.file is other.file and other.start <= self.start and self.end <= other.end

    def within(self, offset: int, length: int) -> Span:
        """Return the part that begins `offset` characters in; for a span that lies on one line."""
        start = self.column + offset
        return Span(self.file, self.line, start, self.line, start + length)

    def inside(self, key: str | int) -> Span:
        """Return the place of a part of the value that stands here."""
        return self

    @property
    def origin(self) -> Origin | None:
        """Where the value was written that an expression here hands on; None where it was written or made here."""
        return None

    @property
    def meant(self) -> str | None:
        """The expression that the text seems meant for which an expression here hands on; None for anything else."""
        return None

    @property
    def changes(self) -> tuple[Change, ...]:
        """What overrides changed right in the object or list that stands here, in their order."""
        return ()

    def __str__(self) -> str:
        return f"{self.file.shown}:{self.line}:{self.column}"


class Change(NamedTuple):
    """What an override says of one key of an object, or of one item of a list, and where."""

    key: str
    span: Span


class Origin(NamedTuple):
    """Where a value was written that is used elsewhere; `is_data` in a file that says values only."""

    span: Span
    is_data: bool


class Trace(Protocol):
    """Follows the value of one expression back to where it was written."""

    def origin(self, path: tuple[str | int, ...]) -> Origin | None:
        """Return where the part at a path of the value was written; None where the expression itself made it."""
        ...

    def meant(self, path: tuple[str | int, ...]) -> str | None:
        """Return the expression that the part at a path seems meant for, which is text; None for anything else."""
        ...


class ComputedSpan(Span):
    """The place of an expression, for one part of its value: `path` leads to that from the whole."""

    trace: Trace
    path: tuple[str | int, ...]

    @classmethod
    def of(cls, place: Span, trace: Trace, path: tuple[str | int, ...] = ()) -> ComputedSpan:
        made = cls(*place)
        made.trace, made.path = trace, path
        return made

    def inside(self, key: str | int) -> ComputedSpan:
        return ComputedSpan.of(self, self.trace, (*self.path, key))

    @property
    def origin(self) -> Origin | None:
        return self.trace.origin(self.path)

    @property
    def meant(self) -> str | None:
        return self.trace.meant(self.path)

    def __reduce__(self) -> tuple[type[Span], tuple[object, ...]]:
        return Span, tuple(self)


class PatchedSpan(Span):
    """The place of an object or a list whose file wrote it here, and in which overrides changed something."""

    _written: Span
    _changes: tuple[Change, ...]

    @classmethod
    def of(cls, place: Span, changes: tuple[Change, ...]) -> Span:
        """Return a place with what was changed there behind what it knows already; the place itself for nothing."""
        if not changes:
            return place
        made = cls(*place)
        made._written, made._changes = place, (*place.changes, *changes)
        return made

    def inside(self, key: str | int) -> Span:
        return self._written.inside(key)

    @property
    def origin(self) -> Origin | None:
        return self._written.origin

    @property
    def meant(self) -> str | None:
        return self._written.meant

    @property
    def changes(self) -> tuple[Change, ...]:
        return self._changes

    def __reduce__(self) -> tuple[type[Span], tuple[object, ...]]:
        return Span, tuple(self)
