"""PyYAML's parser: the places of its events, and the comments that it drops."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Callable, Iterator
from typing import TypeAlias

import yaml
from yaml.events import CollectionEndEvent, CollectionStartEvent, Event, NodeEvent, ScalarEvent

from linkforge_compile.diagnostics.reports import Suppression
from linkforge_compile.limits import Budget, Limit
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax.nodes import MAX_DEPTH

MAX_READ_TWICE = 250_000
"""The largest file, in characters, that PyYAML's slow parser reads after libyaml has failed."""

Parser: TypeAlias = type["yaml.BaseLoader | yaml.CBaseLoader"]

PARSER: Parser = getattr(yaml, "CBaseLoader", yaml.BaseLoader)
"""libyaml's parser; PyYAML's own, which gives the same events, where libyaml is not installed."""

_TAG = re.compile(r"!\S*")
_PROPERTIES = re.compile(r"(?:[&!]\S*\s*|#[^\r\n]*\s*)+")
"""Anchors and tags before a value, and comments between them and it."""

_BLOCK_STYLES = ("|", ">")


class TooDeepError(yaml.YAMLError):
    """Lists and maps are nested deeper than a spec may nest them."""


def limited_events(text: str, parser: Parser = PARSER) -> Iterator[Event]:
    """Yield the events of a text; yaml.YAMLError if it is malformed or too deep.

    The time of libyaml grows with the square of the depth.
    """
    depth = 0
    for event in yaml.parse(text, Loader=parser):
        depth += isinstance(event, CollectionStartEvent) - isinstance(event, CollectionEndEvent)
        if depth > MAX_DEPTH:
            raise TooDeepError
        yield event


def readable_events(text: str) -> Iterator[Event]:
    """Yield the events of a text up to what is malformed or too deep."""
    try:
        yield from limited_events(text)
    except yaml.YAMLError:
        return


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


IGNORE_WORDS = re.compile(r"linkforge[: \t]+(?:ignore|disable|suppress|skip|noqa|nolint)\b")
"""Found in every text that has such a comment; a search for it is much faster than for a whole comment."""

_COMMENT = re.compile(r"(?<!\S)#[ \t]*linkforge:[ \t]*ignore(?!\w)(?P<codes>(?:[ \t,]+(?i:LF)\w+)*)")
_LIKE_A_COMMENT = re.compile(rf"(?<!\S)#[^#\r\n]*?(?<!\w){IGNORE_WORDS.pattern}(?:[ \t,:=]+(?i:LF)\w+)*")
_CODE = re.compile(r"LF\w+", re.IGNORECASE)
_NOTHING_BUT_COMMENT = re.compile(r"\s*(#.*)?")


def suppressions_in(file: SourceFile, budget: Budget | None = None) -> Iterator[Suppression]:
    """Yield the comments that name codes to ignore, on their own line or, if alone on it, on the next.

    The text after the codes is the author's reason. Comments that are spelled otherwise, such as
    `# linkforge: disable LF6003`, are yielded as not understood. Each is charged to the budget.
    """
    marks = Marks(file)
    if not _LIKE_A_COMMENT.search(marks.text) or (texts := find_scalars(marks)) is None:
        return
    budget = budget or Budget()
    starts, line_of = [text.start for text in texts], _find_lines(file)
    for found in _LIKE_A_COMMENT.finditer(marks.text):
        comment = _COMMENT.match(marks.text, found.start())
        comment, is_understood = comment or found, comment is not None
        span = marks.part(comment.start(), len(comment[0]))
        before = bisect_right(starts, span.start)
        if before and span.start < texts[before - 1].end:
            continue
        # A comment without a code is reported as well.
        budget.spend(Limit.IGNORED_CODES, max(1, len(_CODE.findall(comment[0]))), span)
        codes = (
            (code[0], marks.part(code.start(), len(code[0]))) for code in _CODE.finditer(marks.text, *comment.span())
        )
        yield Suppression(span, line_of(span.line), tuple(codes), is_understood)


def _find_lines(file: SourceFile) -> Callable[[int], int]:
    """Return a function from the line of a comment to the line that it is about.

    It must be called with increasing lines, and looks at each line once, however many comments there are.
    """
    target = 0

    def line_of(line: int) -> int:
        nonlocal target
        target = max(target, line)
        while target < len(file.lines) and _NOTHING_BUT_COMMENT.fullmatch(file.line(target)):
            target += 1
        return target

    return line_of


def find_scalars(marks: Marks) -> tuple[Span, ...] | None:
    """Return the spans of the file's scalars, in which a `#` begins no comment; None if it is not YAML."""
    for parser in (PARSER, yaml.BaseLoader):
        try:
            events = yaml.parse(marks.text, Loader=parser)
            return tuple(marks.scalar(event) for event in events if isinstance(event, ScalarEvent))
        except yaml.YAMLError:
            # As in the reader: what libyaml rejects, PyYAML's slow parser may accept.
            if len(marks.text) > MAX_READ_TWICE:
                break
    return None
