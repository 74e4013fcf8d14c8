"""Places of parts of a scalar's text in the file, and of a byte that is no text."""

from __future__ import annotations

import re
from array import array
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from linkforge_compile.source.span import SourceFile, Span

_LINE = re.compile(r"^.*$", re.MULTILINE)


@dataclass(frozen=True, eq=False)
class TextPlace:
    """The span of a scalar, its text, and the offset in the span at which the text begins.

    `start` is None if the file does not hold the text as it is on one line. The lines of a block (`|`) still have
    places of their own; text that was changed by escapes or folding only has that of the whole scalar.
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
        """Return the place of a line of a block (`|`), counted from 1, without the blanks around it.

        None for a blank line, and for other texts, whose lines are not those of the file.
        """
        return self._block.line(number) if self._block else None

    @cached_property
    def _block(self) -> _Block | None:
        return _Block.of(self.text, self.span)


@dataclass(frozen=True)
class _Block:
    """A block (`|`): each line of its text is one of the file, all with the same indentation.

    `starts` are the indexes at which the lines begin in the text, and of one more line after the last; `changed` are
    the numbers of the lines that hold values of expressions.
    """

    span: Span
    starts: Sequence[int]
    indentation: int
    changed: frozenset[int]

    @classmethod
    def of(cls, text: str, span: Span) -> _Block | None:
        """Return None for text that is no block, or if an expression has more lines than its value."""
        file = span.file
        if not file.line(span.line).startswith("|", span.column - 1):
            return None
        written = file.lines[span.line : span.end_line]
        indentation = _blanks(next(filter(str.strip, written), "")) - _blanks(text.lstrip("\n"))
        # A block may have millions of lines, so no list of them is built.
        starts, changed, end = array("L"), set[int](), 0
        for line, found in zip(written, _LINE.finditer(text), strict=False):
            starts.append(found.start())
            end = found.end()
            if line[indentation:] != found[0]:
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
    """Return the number of blanks that a line begins with."""
    return len(line) - len(line.lstrip())


def place_of_byte(error: UnicodeDecodeError, name: str) -> Span:
    """Return the place of the byte that a decoder refused, in a file of that name with the text that can be read."""
    before, text = (data.decode(error.encoding, "replace") for data in (error.object[: error.start], error.object))
    lines = before.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    line, column = len(lines), len(lines[-1]) + 1
    return Span(SourceFile(name, text), line, column, line, column + 1)
