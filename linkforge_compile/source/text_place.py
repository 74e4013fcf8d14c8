"""Where a part of a scalar's text stands in the file."""

from __future__ import annotations

import re
from array import array
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from linkforge_compile.source.span import Span

_LINE = re.compile(r"^.*$", re.MULTILINE)


@dataclass(frozen=True, eq=False)
class TextPlace:
    """The span of a scalar, its text, and where in it that begins.

    `start` is None where the text does not stand on one line of the file as it is: of a text behind `|` each line still
    does; where escapes or folding changed it, the whole scalar is the best place there is.
    """

    span: Span
    text: str
    start: int | None

    @classmethod
    def of(cls, text: str, span: Span) -> TextPlace:
        written = span.text
        if written == text:
            return cls(span, text, 0)
        quoted = written is not None and written[1:-1] == text and written[:1] in "'\""
        return cls(span, text, 1 if quoted else None)

    def part(self, offset: int, length: int) -> Span:
        """Return the span of `length` characters from the one at `offset` in the text."""
        if self.start is not None:
            return self.span.within(self.start + offset, length)
        return self._block.part(offset, length) if self._block else self.span

    def line(self, number: int) -> Span | None:
        """Return where line `number`, counted from 1, of a text behind `|` stands, without the blanks around it.

        None where no line of the text surely stands in the file, and for one that says nothing.
        """
        return self._block.line(number) if self._block else None

    @cached_property
    def _block(self) -> _Block | None:
        return _Block.of(self.text, self.span)


@dataclass(frozen=True)
class _Block:
    """A text behind `|`, each line of which is one of the file, indented by as much as all others.

    `starts` are the indexes at which the lines begin in the text, and one line more behind the last; `changed` are the
    numbers of those into which values of expressions were laid.
    """

    span: Span
    starts: Sequence[int]
    indentation: int
    changed: frozenset[int]

    @classmethod
    def of(cls, text: str, span: Span) -> _Block | None:
        """Return None for another text, and where an expression has more lines than its value."""
        file = span.file
        if not file.line(span.line).startswith("|", span.column - 1):
            return None
        written = file.lines[span.line : span.end_line]
        indentation = _blanks(next(filter(str.strip, written), "")) - _blanks(text.lstrip("\n"))
        # A block may have millions of lines: no list holds those of the text.
        starts, changed, end = array("L"), set[int](), 0
        for line, said in zip(written, _LINE.finditer(text), strict=False):
            starts.append(said.start())
            end = said.end()
            if line[indentation:] != said[0]:
                changed.add(len(starts))
                if "$(" not in line:
                    return None
        if len(starts) < len(written) or text[end:].strip():
            return None
        starts.append(end + 1)
        return cls(span, starts, indentation, frozenset(changed))

    def part(self, offset: int, length: int) -> Span:
        number = bisect_right(self.starts, offset)
        if number in self.changed or number == len(self.starts):
            return self.line(number) or self.span
        line = self.span.line + number
        column = self.indentation + offset - self.starts[number - 1] + 1
        return Span(self.span.file, line, column, line, column + min(length, self.starts[number] - 1 - offset))

    def line(self, number: int) -> Span | None:
        line = self.span.line + number
        written = self.span.file.line(line) if line <= self.span.end_line else ""
        if not written.strip():
            return None
        return Span(self.span.file, line, _blanks(written) + 1, line, len(written.rstrip()) + 1)


def _blanks(line: str) -> int:
    """Return how many a line begins with."""
    return len(line) - len(line.lstrip())
