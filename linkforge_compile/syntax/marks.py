"""Spans of parser events in their file."""

from __future__ import annotations

import re

from yaml.events import Event, NodeEvent, ScalarEvent

from linkforge_compile.source import SourceFile, Span

_TAG = re.compile(r"!\S*")
_PROPERTIES = re.compile(r"(?:[&!]\S*\s*|#[^\r\n]*\s*)+")
"""Anchors and tags before a value, and comments between them and it."""

_BLOCK_STYLES = ("|", ">")


class Marks:
    """Turns the parser's marks, which count characters from 0, into spans; `text` is what the parser reads."""

    def __init__(self, file: SourceFile) -> None:
        self.file = file
        self.text = file.counted

    def event(self, event: Event, last: Event | None = None) -> Span:
        """Return the span from the start of an event to its end, or to the end of `last`."""
        return self.file.between(self.begin(event), self.end(last or event))

    def begin(self, event: Event) -> int:
        """Return the index of the first character of an event; a node's anchor and tag belong to it."""
        assert event.start_mark is not None, "the parser marks every event"
        return event.start_mark.index

    def end(self, event: Event) -> int:
        """Return the index after the last character of an event.

        It may lie beyond the end of the text: libyaml reads every file as if it ended with a line break.
        """
        assert event.end_mark is not None, "the parser marks every event"
        return event.end_mark.index

    def part(self, index: int, length: int) -> Span:
        """Return the span of up to `length` characters from `index`."""
        return self.file.between(index, index + length)

    def scalar(self, event: ScalarEvent) -> Span:
        """Return the span of a scalar with its quotes, without its anchor; a block scalar ends with its last line."""
        return self.file.between(*self.scalar_ends(event))

    def scalar_ends(self, event: ScalarEvent) -> tuple[int, int]:
        """Return the first index of a scalar and the index after it, as for `scalar`."""
        assert event.start_mark is not None, "the parser marks every event"
        assert event.end_mark is not None, "the parser marks every event"
        begin, end = event.start_mark.index, event.end_mark.index
        if event.anchor is None and event.tag is None and event.style not in _BLOCK_STYLES:
            return begin, end
        written = self.text[begin:end].rstrip()
        properties = _PROPERTIES.match(written)
        return begin + (properties.end() if properties else 0), begin + len(written)

    def tag(self, event: NodeEvent) -> Span:
        """Return the span of a node's tag."""
        found = _TAG.search(self.text, event.start_mark.index) if event.start_mark else None
        return self.part(found.start(), len(found[0])) if found else self.event(event)
