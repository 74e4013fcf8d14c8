"""From the parser's marks to spans of the file."""

from __future__ import annotations

from bisect import bisect_right
from functools import cached_property

from yaml.events import Event, NodeEvent, ScalarEvent

from linkforge_compile.pattern import pattern
from linkforge_compile.source import SourceFile, Span

_LINE_BREAK = pattern("\r\n|\r|\n")
_TAG = pattern(r"!\S*")
_PROPERTIES = pattern(r"(?:[&!]\S*\s*|#[^\r\n]*\s*)+")
"""Anchors and tags before a value, and comments between them and it."""

_BLOCK_STYLES = ("|", ">")


class Marks:
    """Turns the parser's marks, which count lines, columns and characters from 0, into spans.

    `text` is the file's text without a byte order mark, as the parser saw it.
    """

    def __init__(self, file: SourceFile, text: str) -> None:
        self.file = file
        self.text = text
        self._last_index = len(text)

    def event(self, event: Event, last: Event | None = None) -> Span:
        """Return the span from the start of an event to its end, or to that of the last one."""
        start, end = event.start_mark, (last or event).end_mark
        assert start is not None, "the parser marks every event"
        assert end is not None, "the parser marks every event"
        # libyaml ends every file with a line break, be there one or not, and marks what comes behind it.
        last_index = self._last_index
        if end.index >= last_index:
            return self.part(min(start.index, last_index), last_index - min(start.index, last_index))
        # There is one for each event, and the constructor of a named tuple takes twice as long.
        return tuple.__new__(Span, (self.file, start.line + 1, start.column + 1, end.line + 1, end.column + 1))

    def part(self, index: int, length: int) -> Span:
        """Return the span of `length` characters, or as many as there are, from the one at `index`."""
        return Span(self.file, *self._place(index), *self._place(min(index + length, len(self.text))))

    def scalar(self, event: ScalarEvent) -> Span:
        """Return a scalar's span with its quotes, without its anchor; a block scalar ends with its last line."""
        if event.anchor is None and event.tag is None and event.style not in _BLOCK_STYLES:
            return self.event(event)
        start, end = event.start_mark, event.end_mark
        assert start is not None, "the parser marks every event"
        assert end is not None, "the parser marks every event"
        written = self.text[start.index : end.index].rstrip()
        properties = _PROPERTIES.match(written)
        skipped = properties.end() if properties else 0
        return self.part(start.index + skipped, len(written) - skipped)

    def tag(self, event: NodeEvent) -> Span:
        """Return the span of the tag that a node carries."""
        found = _TAG.search(self.text, event.start_mark.index) if event.start_mark else None
        return self.part(found.start(), len(found[0])) if found else self.event(event)

    def _place(self, index: int) -> tuple[int, int]:
        line = bisect_right(self._line_starts, index)
        return line, index - self._line_starts[line - 1] + 1

    @cached_property
    def _line_starts(self) -> list[int]:
        return [0, *(found.end() for found in _LINE_BREAK.finditer(self.text))]
