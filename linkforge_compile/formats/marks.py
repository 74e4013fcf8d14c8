"""Marks: where a piece of a document was written, riding along in its text while it is rendered for a source map.

A mark is a number between two characters that XML cannot hold, so no text can look like one. To `str.strip` and to
patterns they are white space: what lays a document out takes a tag with a mark for one with an attribute.
What leaves no mark anywhere, `recording`, is the only state: every function that makes a piece of a document would
have to hand it on otherwise, for the sake of the few documents that are rendered with a map.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from typing import TYPE_CHECKING

from linkforge_compile.source.provenance import Kind, Provenance, written_at

if TYPE_CHECKING:
    from linkforge_compile.source import SourceRef, Span

MARK = re.compile("\x1c([0-9]+)\x1d")


class Marks:
    """The places that the marks of one document stand for."""

    def __init__(self) -> None:
        self._places: dict[tuple[Span, tuple[Span, ...]], tuple[int, Provenance]] = {}

    def mark(self, place: Provenance) -> str:
        """Return the mark of a place; of one that is met again with other overrides, that of the first time."""
        key = (place.span, place.spans(Kind.USE))
        number, _ = self._places.setdefault(key, (len(self._places), place))
        return f"\x1c{number}\x1d"

    @property
    def places(self) -> tuple[Provenance, ...]:
        """The places in the order of their numbers."""
        return tuple(place for _, place in self._places.values())


_RECORDED: ContextVar[Marks | None] = ContextVar("_RECORDED", default=None)


@contextmanager
def recording() -> Iterator[Marks]:
    """Have marks left in all that is rendered within."""
    marks = Marks()
    token = _RECORDED.set(marks)
    try:
        yield marks
    finally:
        _RECORDED.reset(token)


recorded: Callable[[], Marks | None] = _RECORDED.get
"""Return the marks of the document that is rendered; None where no map is made. Asked for every part of a robot."""


def mark(source: SourceRef | None, *path: str | int) -> str:
    """Return the mark of the deepest thing written on the path; nothing where none was, or where no map is made."""
    marks = recorded()
    if marks is None or source is None:
        return ""
    span = source.at(*path)
    return marks.mark(written_at(span, source))


def mark_of_attribute(source: SourceRef | None, name: str) -> str:
    """Return the mark of what an attribute says: it has the name of its key, but for those that are listed."""
    if source is not None and source.node.child(name) is None:
        name = _KEYS.get(name, name)
    return mark(source, name)


_KEYS = {"filename": "file"}


def marks_of_lines(text: str, source: SourceRef | None, path: tuple[str | int, ...]) -> Callable[[int], str]:
    """Return what gives the mark of one line, counted from 1, of a text of several written under a path.

    It is that of the whole text where the file does not have the line as one.
    """
    marks = recorded()
    if marks is None or source is None:
        return lambda _: ""
    from linkforge_compile.source.text_place import TextPlace

    place = TextPlace.of(text, source.at(*path))

    def mark_of_line(number: int) -> str:
        span = place.line(number) or place.span
        return marks.mark(written_at(span, source))

    return cache(mark_of_line)
