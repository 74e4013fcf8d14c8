"""Where a part of a scalar's text stands in the file."""

from __future__ import annotations

from linkforge_compile.frozen import dataclass
from linkforge_compile.source.span import Span


@dataclass(frozen=True, slots=True)
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
        if self.start is None:
            return self._part_of_block(offset, length) or self.span
        return self.span.within(self.start + offset, length)

    def _part_of_block(self, offset: int, length: int) -> Span | None:
        begin = self.text.rfind("\n", 0, offset) + 1
        said = self.text[begin:].partition("\n")[0]
        line = line_in_block(self.span, self.text.count("\n", 0, begin) + 1)
        if line is None or line.text != said.strip():
            # Of a text that values were laid into, the line that holds an expression is another.
            return line if line and "$(" in (line.text or "") else None
        indentation = len(said) - len(said.lstrip())
        return line.within(offset - begin - indentation, min(length, begin + len(said) - offset))


def line_in_block(whole: Span, number: int) -> Span | None:
    """Return where line `number`, counted from 1, of a text behind `|` stands, without the blanks around it.

    None where the text stands in no such block, and for a line that it does not have or that says nothing.
    """
    line = whole.line + number
    written = whole.file.line(line)
    is_block = whole.file.line(whole.line).startswith("|", whole.column - 1)
    if not is_block or line > whole.end_line or not written.strip():
        return None
    first, last = len(written) - len(written.lstrip()), len(written.rstrip())
    return Span(whole.file, line, first + 1, line, last + 1)
