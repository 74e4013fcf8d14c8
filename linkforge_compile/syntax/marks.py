"""From the parser's marks to spans of the file."""

from __future__ import annotations

import re

from yaml.events import Event, NodeEvent, ScalarEvent

from linkforge_compile.source import SourceFile, Span

_TAG = re.compile(r"!\S*")
_PROPERTIES = re.compile(r"(?:[&!]\S*\s*|#[^\r\n]*\s*)+")
"""Anchors and tags before a value, and comments between them and it."""

_BLOCK_STYLES = ("|", ">")


class Marks:
    """Turns the parser's marks, which count lines, columns and characters from 0, into spans.

    `text` is what the parser sees of the file.
    """

    def __init__(self, file: SourceFile) -> None:
        self.file = file
        self.text = file.counted

    def event(self, event: Event, last: Event | None = None) -> Span:
        """Return the span from the start of an event to its end, or to that of the last one."""
        return self.file.between(self.begin(event), self.end(last or event))

    def begin(self, event: Event) -> int:
        """Return the index of the first character of an event, of a node with its anchor and tag."""
        assert event.start_mark is not None, "the parser marks every event"
        return event.start_mark.index

    def end(self, event: Event) -> int:
        """Return the index behind the last character of an event.

        libyaml ends every file with a line break, be there one or not: it may lie behind the end of the text.
        """
        assert event.end_mark is not None, "the parser marks every event"
        return event.end_mark.index

    def part(self, index: int, length: int) -> Span:
        """Return the span of `length` characters, or as many as there are, from the one at `index`."""
        return self.file.between(index, index + length)

    def scalar(self, event: ScalarEvent) -> Span:
        """Return a scalar's span with its quotes, without its anchor; a block scalar ends with its last line."""
        return self.file.between(*self.ends(event))

    def ends(self, event: ScalarEvent) -> tuple[int, int]:
        """Return the indexes between which a scalar stands, as in `scalar`."""
        begin, end = self.begin(event), self.end(event)
        if self.are_its_ends(event):
            return begin, end
        written = self.text[begin:end].rstrip()
        properties = _PROPERTIES.match(written)
        return begin + (properties.end() if properties else 0), begin + len(written)

    def are_its_ends(self, event: ScalarEvent) -> bool:
        """Whether a scalar stands right between the marks of its event."""
        return event.anchor is None and event.tag is None and event.style not in _BLOCK_STYLES

    def tag(self, event: NodeEvent) -> Span:
        """Return the span of the tag that a node carries."""
        found = _TAG.search(self.text, event.start_mark.index) if event.start_mark else None
        return self.part(found.start(), len(found[0])) if found else self.event(event)
