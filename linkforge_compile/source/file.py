"""A text that was read, under the name by which its user knows it."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field
from functools import cached_property
from itertools import accumulate
from pathlib import Path

from linkforge_compile.source.characters import on_one_line
from linkforge_compile.source.span import Span


@dataclass(frozen=True, eq=False)
class SourceFile:
    """A text and its name in messages; two are the same only if they are one object.

    `path` is None for text that is no file: standard input, a string, the command line.
    `order` counts the files that one compilation read before this one, so that messages keep reading order.
    `included` is the `include` that laid this file into another one, None for a file that stands by itself.
    """

    name: str
    text: str = field(repr=False)
    path: Path | None = None
    order: int = 0
    included: Span | None = None

    @property
    def shown(self) -> str:
        """The name as messages show it: who named the file has no say over a terminal or a build log."""
        return on_one_line(self.name)

    @cached_property
    def counted(self) -> str:
        """The text as places count it: a byte order mark belongs to no line, nor do editors count it as a column."""
        return self.text.removeprefix("\ufeff")

    @cached_property
    def lines(self) -> tuple[str, ...]:
        """The lines without their ends, split only where YAML and XML split: LF, CR LF, CR."""
        return tuple(self.counted.replace("\r\n", "\n").replace("\r", "\n").split("\n"))

    def line(self, number: int) -> str:
        """Return line `number`, counted from 1; empty behind the end of the file."""
        return self.lines[number - 1] if 0 < number <= len(self.lines) else ""

    def between(self, begin: int, end: int) -> Span:
        """Return the stretch between two indexes into what is counted of the text.

        What lies behind the end of the text is its end.
        """
        known = self._stretches.get((begin, end))
        if known is None:
            known = self._stretches[begin, end] = Span(self, *self._place(begin), *self._place(end))
        return known

    @cached_property
    def _stretches(self) -> dict[tuple[int, int], Span]:
        """What was asked for by the indexes: of what repeats, each copy asks again."""
        return {}

    def _place(self, index: int) -> tuple[int, int]:
        starts = self._line_starts
        index = min(index, starts[-1] - 1)
        line = bisect_right(starts, index)
        return line, index - starts[line - 1] + 1

    @cached_property
    def _line_starts(self) -> list[int]:
        """The index of the first character of each line, and of one more line behind the last."""
        text = self.counted.replace("\r\n", " \n").replace("\r", "\n")
        return [0, *accumulate(len(line) + 1 for line in text.split("\n"))]

    @cached_property
    def is_xml(self) -> bool:
        """Whether it is a URDF, an SRDF or a xacro, whatever its name: its author knows no words of the language."""
        from linkforge_compile.source.encoding import begins_xml

        return begins_xml(self.text)

    @property
    def includes(self) -> tuple[Span, ...]:
        """Every `include` that led to this file, the last one first."""
        return (self.included, *self.included.file.includes) if self.included else ()

    @property
    def outermost(self) -> SourceFile:
        """The file that this one was laid into in the end, itself if into none."""
        return self.includes[-1].file if self.included else self

    @property
    def whole(self) -> Span:
        """The span to blame where a file as a whole is at fault: its first character."""
        return Span(self, 1, 1, 1, 1)

    def __deepcopy__(self, memo: object) -> SourceFile:
        return self


def span_of(place: Span | SourceFile, begin: int, end: int) -> Span:
    """Return where something stands: its place, or what lies between two indexes where that is a file."""
    return place if isinstance(place, Span) else place.between(begin, end)
