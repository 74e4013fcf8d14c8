"""What an editor can fold: entries and items over several lines, and comments."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

from lsprotocol import types
from yaml.events import (
    CollectionEndEvent,
    CollectionStartEvent,
    Event,
    MappingStartEvent,
    NodeEvent,
    ScalarEvent,
)

from linkforge_compile.source import SourceFile
from linkforge_compile.syntax.parser import readable_events


def folding_ranges(file: SourceFile) -> list[types.FoldingRange]:
    """Return the ranges of a text; those that are open at a fault of YAML end with the text."""
    lines = [line.strip() for line in file.lines]
    found = {begin: _last_line(lines, begin, end) for begin, end in _nodes(file)}
    ranges = [types.FoldingRange(begin, end) for begin, end in sorted(found.items()) if end > begin]
    return [*ranges, *_comments(lines)]


def _last_line(lines: list[str], begin: int, end: int) -> int:
    """Return the last line of a node without the empty lines and comments that follow it."""
    while end > begin and (not lines[end] or lines[end].startswith("#")):
        end -= 1
    return end


def _nodes(file: SourceFile) -> Iterator[tuple[int, int]]:
    """Yield the first and last line of each node, from the key of an entry on; the innermost of a line come first."""
    open_nodes: list[_Open] = []
    for event in readable_events(file.counted):
        if isinstance(event, CollectionEndEvent):
            closed = open_nodes.pop()
            if open_nodes:  # the whole text does not fold
                yield closed.line, _end_line(event, file)
            continue
        if not isinstance(event, NodeEvent):
            continue
        line = open_nodes[-1].line_of_child(_line(event)) if open_nodes else _line(event)
        if isinstance(event, CollectionStartEvent):
            open_nodes.append(_Open(line, is_map=isinstance(event, MappingStartEvent)))
        elif isinstance(event, ScalarEvent):
            yield line, _end_line(event, file)
    last = len(file.lines) - 1
    yield from ((one.line, last) for one in reversed(open_nodes[1:]))


class _Open:
    """A map or list that has not ended; `line` is that of its key, or its own."""

    def __init__(self, line: int, *, is_map: bool) -> None:
        self.line = line
        self._is_map = is_map
        self._key_line: int | None = None

    def line_of_child(self, line: int) -> int:
        """Return the line from which a child that begins in a line folds: that of its key if it has one."""
        if not self._is_map:
            return line
        key_line, self._key_line = self._key_line, line if self._key_line is None else None
        return line if key_line is None else key_line


def _line(event: Event) -> int:
    assert event.start_mark is not None, "the parser marks every event"
    return int(event.start_mark.line)


def _end_line(event: Event, file: SourceFile) -> int:
    """Return the last line of an event; a node in block style ends where the next one begins."""
    mark = event.end_mark
    assert mark is not None, "the parser marks every event"
    line = int(mark.line)
    return line if file.line(line + 1)[: mark.column].strip() else line - 1


def _comments(lines: list[str]) -> Iterator[types.FoldingRange]:
    """Yield the blocks of comments over several lines."""
    for is_comment, block in groupby(enumerate(lines), key=lambda line: line[1].startswith("#")):
        numbers = [number for number, _ in block]
        if is_comment and len(numbers) > 1:
            yield types.FoldingRange(numbers[0], numbers[-1], kind=types.FoldingRangeKind.Comment)
