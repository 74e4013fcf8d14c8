"""Text that was read, and stretches of it.

Lines and columns count from 1, columns in characters.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field
from functools import cached_property
from itertools import accumulate
from pathlib import Path
from typing import NamedTuple, Protocol

from linkforge_compile.source.characters import begins_xml, on_one_line


@dataclass(frozen=True, eq=False)
class SourceFile:
    """A text and its name in messages; two are the same only if they are one object.

    `path` is None for text from standard input, a string or the command line. `order` counts the files that one
    compilation read before this one, so that messages keep reading order. `included` is the `include` that inserted
    this file into another one, None for a file of its own.
    """

    name: str
    text: str = field(repr=False)
    path: Path | None = None
    order: int = 0
    included: Span | None = None

    @property
    def place(self) -> tuple[str, Path | None, int]:
        """What is the same of a file that is read at the same place in another compile."""
        return self.name, self.path, self.order

    def has_text_of(self, other: SourceFile) -> bool:
        """Whether another file at its place has the same text and is included by the same file."""
        return (self.text, self.included) == (other.text, other.included)

    @property
    def shown(self) -> str:
        """The name as messages show it, without control characters that would reach a terminal or a build log."""
        return on_one_line(self.name)

    @cached_property
    def counted(self) -> str:
        """The text as places count it: without byte order mark, which editors do not count as a column either."""
        return self.text.removeprefix("\ufeff")

    @cached_property
    def lines(self) -> tuple[str, ...]:
        """The lines without their ends, split only where YAML and XML split: LF, CR LF, CR."""
        return tuple(self.counted.replace("\r\n", "\n").replace("\r", "\n").split("\n"))

    def line(self, number: int) -> str:
        """Return a line by its number; empty beyond the end of the file."""
        return self.lines[number - 1] if 0 < number <= len(self.lines) else ""

    @property
    def newline(self) -> str:
        """How its lines end."""
        return "\r\n" if "\r\n" in self.text else "\n"

    def between(self, begin: int, end: int) -> Span:
        """Return the span between two indexes into `counted`; an index beyond the text is its end."""
        known = self._spans.get((begin, end))
        if known is None:
            known = self._spans[begin, end] = Span(self, *self._place(begin), *self._place(end))
        return known

    def index_of(self, line: int, column: int) -> int:
        """Return the index into `counted` of a place."""
        return min(self._line_starts[line - 1] + column - 1, len(self.counted))

    @cached_property
    def _spans(self) -> dict[tuple[int, int], Span]:
        """The spans by their indexes: each copy of a repeated part asks for the same ones."""
        return {}

    def _place(self, index: int) -> tuple[int, int]:
        starts = self._line_starts
        index = min(index, starts[-1] - 1)
        line = bisect_right(starts, index)
        return line, index - starts[line - 1] + 1

    @cached_property
    def _line_starts(self) -> list[int]:
        """The index of the first character of each line, and of one more line after the last."""
        text = self.counted.replace("\r\n", " \n").replace("\r", "\n")
        return [0, *accumulate(len(line) + 1 for line in text.split("\n"))]

    @cached_property
    def is_xml(self) -> bool:
        """Whether it is a URDF, an SRDF or a xacro, whatever its name: messages then speak of elements, not of keys."""
        return begins_xml(self.text)

    @property
    def includes(self) -> tuple[Span, ...]:
        """Every `include` that led to this file, the last one first."""
        return (self.included, *self.included.file.includes) if self.included else ()

    @property
    def outermost(self) -> SourceFile:
        """The file that includes this one and is included by no other; itself if it is not included."""
        return self.includes[-1].file if self.included else self

    @property
    def whole(self) -> Span:
        """The span of a fault of the file as a whole: its first character."""
        return Span(self, 1, 1, 1, 1)

    def __deepcopy__(self, memo: object) -> SourceFile:
        return self


class Position(NamedTuple):
    """A place between two characters."""

    line: int
    column: int


class Span(NamedTuple):
    """A stretch of a file, from its first character to just after its last one.

    A flat tuple because there is one for every scalar of a spec: a 10,000-link robot makes half a million.
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
        """The text of the span; None for a span over several lines."""
        if self.line != self.end_line:
            return None
        return self.file.line(self.line)[self.column - 1 : self.end_column - 1]

    @property
    def range(self) -> tuple[int, int]:
        """The indexes of its begin and end in `counted` of the file."""
        return self.file.index_of(*self.start), self.file.index_of(*self.end)

    @property
    def full_text(self) -> str:
        """The text of the span, also over several lines, whose ends are as in the file."""
        begin, end = self.range
        return self.file.counted[begin:end]

    @property
    def is_flow(self) -> bool:
        """Whether it begins with a brace or bracket, as a map or list in flow style does."""
        return self.file.line(self.line).startswith(("{", "["), self.column - 1)

    @property
    def begins_line(self) -> bool:
        """Whether only spaces are before it on its line."""
        return not self.file.line(self.line)[: self.column - 1].strip(" ")

    def lies_in(self, other: Span) -> bool:
        """Whether all of it is inside another span."""
        return self.file is other.file and other.start <= self.start and self.end <= other.end

    def within(self, offset: int, length: int) -> Span:
        """Return the part that begins `offset` characters in; for a span that lies on one line."""
        start = self.column + offset
        return Span(self.file, self.line, start, self.line, start + length)

    def inside(self, key: str | int) -> Span:
        """Return the place of a part of the value that is written here."""
        return self

    @property
    def origin(self) -> Origin | None:
        """Where an expression here gets its value from; None for a value that is written or made here."""
        return None

    @property
    def forgotten_expression(self) -> str | None:
        """The expression that a text taken from elsewhere looks like but for its `$(`; None for anything else."""
        return None

    @property
    def changes(self) -> tuple[Change, ...]:
        """What overrides changed directly in the object or list that is written here, in their order."""
        return ()

    def __str__(self) -> str:
        return f"{self.file.shown}:{self.line}:{self.column}"


class Change(NamedTuple):
    """A key of an object, or the position of an item in a list, that an override sets, and where."""

    key: str
    span: Span


class Origin(NamedTuple):
    """Where a value was written that an expression uses; `is_data` if that is a file of data."""

    span: Span
    is_data: bool


class Trace(Protocol):
    """Follows the value of one expression back to where it was written."""

    def origin(self, path: tuple[str | int, ...]) -> Origin | None:
        """Return where the part at a path of the value was written; None if the expression itself made it."""
        ...

    def forgotten_expression(self, path: tuple[str | int, ...]) -> str | None:
        """Return the expression that the text at a path looks like but for its `$(`; None for anything else."""
        ...


class TracedSpan(Span):
    """The place of a value that an expression computes, or in which overrides changed something.

    `trace` follows the value of the expression, and `path` leads from its whole value to the part that is here.
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


class ModuleUse(Span):
    """The `use` that brings in a file, and the name of its module: those that a `for` makes have the same place."""

    module: str

    @classmethod
    def of(cls, place: Span, module: str) -> ModuleUse:
        made = cls(*place)
        made.module = module
        return made

    def __reduce__(self) -> tuple[object, ...]:
        return ModuleUse.of, (Span(*self), self.module)


def span_of(place: Span | SourceFile, begin: int, end: int) -> Span:
    """Return the place itself if it is a span, else the span between two indexes of the file."""
    return place if isinstance(place, Span) else place.between(begin, end)
