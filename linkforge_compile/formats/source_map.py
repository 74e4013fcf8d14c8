"""Source maps: which line of a spec wrote a line of a document."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from linkforge_compile.formats.marks import MARK, Marks
from linkforge_compile.formats.markup import restored
from linkforge_compile.source.provenance import Provenance


class Segment(NamedTuple):
    """What begins at a column of a line, counted from 1, and goes on to the next segment; the first begins at 1."""

    column: int
    place: Provenance


@dataclass(frozen=True)
class SourceMap:
    """Where each line of a document was written, and each attribute on it; `lines` has none for what nobody wrote."""

    lines: tuple[tuple[Segment, ...], ...]

    def at(self, line: int, column: int | None = None) -> Provenance | None:
        """Return where what stands on a line was written, or more closely what stands at a column of it.

        Both count from 1. None for what nobody wrote, and beyond the document.
        """
        segments = self.lines[line - 1] if 0 < line <= len(self.lines) else ()
        places = [place for begin, place in segments if begin <= (column or 1)]
        return places[-1] if places else None


class Mapped(NamedTuple):
    """A document and its map."""

    text: str
    map: SourceMap


def unmarked(text: str, marks: Marks) -> Mapped:
    """Take the marks out of a document that is laid out, one tag a line.

    A line without a mark is part of the element around it, and a closing tag of its element: both by the indent.
    """
    places = marks.places
    lines: list[str] = []
    segments: list[tuple[Segment, ...]] = []
    around: dict[int, tuple[Segment, ...]] = {}
    for marked in text.split("\n"):
        line, own = _line(marked, places)
        content = line.lstrip(" ")
        indent = len(line) - len(content)
        if content.startswith("</"):
            own = around.get(indent, ())
        elif content:
            own = own or around.get(indent - 2, ())[:1]
            around[indent] = own[:1]
        for part in restored(line).split("\n"):
            lines.append(part)
            segments.append(own)
            own = own[-1:] and (own[-1]._replace(column=1),)
    return Mapped("\n".join(lines), SourceMap(tuple(segments)))


def _line(marked: str, places: tuple[Provenance, ...]) -> tuple[str, tuple[Segment, ...]]:
    pieces = MARK.split(marked)
    if len(pieces) == 1:
        return marked, ()
    line = pieces[0]
    segments: list[Segment] = []
    for number, piece in zip(pieces[1::2], pieces[2::2], strict=True):
        place = places[int(number)]
        if not segments or segments[-1].place != place:
            segments.append(Segment(len(line) + 1 if segments else 1, place))
        line += piece
    return line, tuple(segments)
