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
    def forgotten_expression(self) -> str | None:
        """The expression that a text taken from elsewhere looks like but for its `$(`; None for anything else."""
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

    def forgotten_expression(self, path: tuple[str | int, ...]) -> str | None:
        """Return the expression that the text at a path looks like but for its `$(`; None for anything else."""
        ...


class TracedSpan(Span):
    """The place of a value that an expression computes, or in which overrides changed something.

    `trace` follows the value of the expression, and `path` leads from its whole value to the part that stands here.
    """

    trace: Trace | None
    path: tuple[str | int, ...]
    _changes: tuple[Change, ...]

    @classmethod
    def computed(cls, place: Span, trace: Trace, path: tuple[str | int, ...] = ()) -> TracedSpan:
        """Return the place of a part of the value of an expression."""
        return cls._of(place, trace, path, ())

    @classmethod
    def overridden(cls, place: Span, changes: tuple[Change, ...]) -> Span:
        """Return a place with further changes by overrides; the place itself if there are none."""
        if not changes:
            return place
        trace, path = (place.trace, place.path) if isinstance(place, TracedSpan) else (None, ())
        return cls._of(place, trace, path, (*place.changes, *changes))

    @classmethod
    def _of(
        cls, place: Span, trace: Trace | None, path: tuple[str | int, ...], changes: tuple[Change, ...]
    ) -> TracedSpan:
        made = cls(*place)
        made.trace, made.path, made._changes = trace, path, changes
        return made

    def inside(self, key: str | int) -> Span:
        return TracedSpan.computed(self, self.trace, (*self.path, key)) if self.trace else Span(*self)

    @property
    def origin(self) -> Origin | None:
        return self.trace.origin(self.path) if self.trace else None

    @property
    def forgotten_expression(self) -> str | None:
        return self.trace.forgotten_expression(self.path) if self.trace else None

    @property
    def changes(self) -> tuple[Change, ...]:
        return self._changes

    def __reduce__(self) -> tuple[type[Span], tuple[object, ...]]:
        return Span, tuple(self)
