"""Where a part of a scalar's text stands in the file."""

from __future__ import annotations

from linkforge_compile.frozen import dataclass
from linkforge_compile.source import Span


@dataclass(frozen=True, slots=True)
class TextPlace:
    """The span of a scalar and where in it its text begins.

    `start` is None where the text does not stand in the file as it is, because of escapes or several lines:
    then the whole scalar is the best place there is.
    """

    span: Span
    start: int | None

    @classmethod
    def of(cls, text: str, span: Span) -> TextPlace:
        written = span.text
        if written == text:
            return cls(span, 0)
        quoted = written is not None and written[1:-1] == text and written[:1] in "'\""
        return cls(span, 1 if quoted else None)

    def part(self, offset: int, length: int) -> Span:
        """Return the span of `length` characters from the one at `offset` in the text."""
        return self.span if self.start is None else self.span.within(self.start + offset, length)
