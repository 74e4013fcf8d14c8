"""Source maps: which line of a spec wrote a line of a document.

While one is made, templates render tags with attributes that say by a number where a thing was written, and the writer
of the document takes them off. Whether one is made is the only state outside of arguments: nearly every function that
makes a piece of a document would have to hand it on otherwise.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

from linkforge_compile.formats.xml_text import RESERVED
from linkforge_compile.source import SourceRef, Span
from linkforge_compile.source.provenance import Kind, Provenance, outward, written_at


class Segment(NamedTuple):
    """What begins at a column of a line, counted from 1, and goes on to the next segment; the first begins at 1."""

    column: int
    place: Provenance


@dataclass(frozen=True)
class SourceMap:
    """Where each line of a document was written, and each attribute on it; `lines` has () for a line without origin."""

    lines: tuple[tuple[Segment, ...], ...]

    def at(self, line: int, column: int | None = None) -> Provenance | None:
        """Return where a line was written, or, for a column, where the attribute there was written.

        Both count from 1. None for a line without origin, and beyond the document.
        """
        segments = self.lines[line - 1] if 0 < line <= len(self.lines) else ()
        places = [place for begin, place in segments if begin <= (column or 1)]
        return places[-1] if places else None


class Mapped(NamedTuple):
    """A document and its map."""

    text: str
    map: SourceMap


class Origins:
    """Where the pieces of one document were written, by number."""

    def __init__(self) -> None:
        self._numbers: dict[Provenance, int] = {}

    def attribute(self, place: Provenance, of: str = "") -> str:
        """Return an attribute for a tag: what follows it was written there. Within a tag, each has another `of`."""
        return f' {RESERVED}at{of and f".{of}"}="{self._numbers.setdefault(place, len(self._numbers))}"'

    @property
    def places(self) -> tuple[Provenance, ...]:
        """The places in the order of their numbers."""
        return tuple(self._numbers)


_ORIGIN = re.compile(rf' {RESERVED}at[^\s=]*="(\d+)"')


def split_origins(text: str) -> Iterator[tuple[str, int | None]]:
    """Yield the pieces of a text between the attributes of `origin_of`, each with the number before it, if any."""
    first, *noted = _ORIGIN.split(text)
    yield first, None
    for number, rest in zip(noted[::2], noted[1::2], strict=True):
        yield rest, int(number)


_ACTIVE: ContextVar[Origins | None] = ContextVar("_ACTIVE", default=None)


@contextmanager
def recording() -> Iterator[Origins]:
    """Have origins noted in all that is rendered within."""
    origins = Origins()
    token = _ACTIVE.set(origins)
    try:
        yield origins
    finally:
        _ACTIVE.reset(token)


active_origins: Callable[[], Origins | None] = _ACTIVE.get
"""Return the origins of the document that is rendered with a map; None where no map is made."""


def origin_of(source: SourceRef | None, *path: str | int, of: str = "") -> str:
    """Return the attribute for the deepest thing written on a path; "" for none, and where no map is made."""
    origins = active_origins()
    if origins is None or source is None:
        return ""
    return origins.attribute(written_at(source.at(*path), source), of)


def origin_of_use(uses: Sequence[Span]) -> str:
    """Return the attribute for what the use of a file makes: the first of `uses`, before those that led to it."""
    origins = active_origins()
    if origins is None or not uses:
        return ""
    return origins.attribute(Provenance(Kind.WRITTEN, uses[0], "", outward(uses[0], tuple(uses[1:]))))


def origins_of_lines(text: str, source: SourceRef | None, path: tuple[str | int, ...]) -> Callable[[int], str]:
    """Return what gives the attribute for one line, counted from 1, of a text of several written under a path.

    It is that of the whole text where the file does not have the line as one.
    """
    origins = active_origins()
    if origins is None or source is None:
        return lambda _: ""
    from linkforge_compile.source.text_place import TextPlace

    place = TextPlace.of(text, source.at(*path))
    return cache(lambda number: origins.attribute(written_at(place.line(number) or place.span, source)))
