"""The file of a source map, written and read. docs/source-map.md describes it."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

from linkforge_compile.formats.source_map import SourceMap
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.source.provenance import Provenance

VERSION = 1
"""Of the format; a reader refuses any other."""

ENDING = ".map.json"
"""What follows the name of an output file in that of its map, which is in the same folder."""


def hash_of(text: str) -> str:
    return sha256(text.encode()).hexdigest()


# Writing


def map_text(text: str, source_map: SourceMap, name: str, folder: Path) -> str:
    """Return the file of the map of a document called `name`, for a folder, from which its paths start."""
    tables = _Tables(folder)
    rows = {
        str(number): [[segment.column, *tables.place(segment.place)] for segment in segments]
        for number, segments in enumerate(source_map.lines, start=1)
        if segments
    }
    head = {"version": VERSION, "file": name, "sha256": hash_of(text)}
    fields = [f"{json.dumps(key)}: {json.dumps(value)}" for key, value in head.items()]
    fields.append(_laid_out("sources", "[]", map(json.dumps, tables.sources.values())))
    fields.append(_laid_out("trails", "[]", map(json.dumps, tables.trails.values())))
    fields.append(_laid_out("mappings", "{}", (f"{json.dumps(line)}: {json.dumps(row)}" for line, row in rows.items())))
    return "{\n" + ",\n".join(fields) + "\n}\n"


def _laid_out(name: str, brackets: str, items: Iterator[str]) -> str:
    """Return a field with one item a line, in `[]` or `{}`."""
    content = ",\n".join(f"  {item}" for item in items)
    inside = f"\n{content}\n" if content else ""
    return f"{json.dumps(name)}: {brackets[0]}{inside}{brackets[1]}"


class _Tables:
    """The files and trails that places refer to, each once, by the numbers they get when they are first met."""

    def __init__(self, folder: Path) -> None:
        self._folder = os.path.realpath(folder)
        self._numbers: dict[SourceFile, int] = {}
        self._trail_numbers: dict[tuple[tuple[str, Span], ...], int] = {}
        self.sources: dict[SourceFile, dict[str, str]] = {}
        self.trails: dict[tuple[tuple[str, Span], ...], list[dict[str, list[int]]]] = {}

    def place(self, place: Provenance) -> list[int]:
        steps = tuple((link.key, link.span) for link in place if link.key)
        stretch = self._stretch(place.span)
        if steps not in self.trails:
            self._trail_numbers[steps] = len(self.trails)
            self.trails[steps] = [{how: self._stretch(span)} for how, span in steps]
        return [*stretch, self._trail_numbers[steps]]

    def _stretch(self, span: Span) -> list[int]:
        file = span.file
        if file not in self._numbers:
            self._numbers[file] = len(self._numbers)
            self.sources[file] = {"path": self._path(file), "sha256": hash_of(file.text)}
        length = span.end_column - span.column if span.line == span.end_line else 0
        return [self._numbers[file], span.line, span.column, length]

    def _path(self, file: SourceFile) -> str:
        if file.path is None:
            return file.name
        try:
            return Path(os.path.relpath(os.path.realpath(file.path), self._folder)).as_posix()
        except ValueError:  # two drives of Windows
            return file.path.name


# Reading


class NoMapError(ValueError):
    """A text is no source map that this version reads; says why."""


class Stretch(NamedTuple):
    """A stretch of a source, by its number; line and column from 1, `length` 0 where it ends on a later line."""

    source: int
    line: int
    column: int
    length: int


class Source(NamedTuple):
    """A file that the document was made from: its path from the folder of the map, and the hash of its text."""

    path: str
    sha256: str


@dataclass(frozen=True)
class MapFile:
    """A source map as it was read; `sha256` is of the document that it is for."""

    sha256: str
    sources: tuple[Source, ...]
    trails: tuple[tuple[tuple[str, Stretch], ...], ...]
    mappings: Mapping[int, tuple[tuple[int, Stretch, int], ...]]

    def at(self, line: int, column: int = 1) -> tuple[Stretch, tuple[tuple[str, Stretch], ...]] | None:
        """Return where a line was written, and how its file came in: `included` or `used` there; None for nothing."""
        begun = [segment for segment in self.mappings.get(line, ()) if segment[0] <= column]
        if not begun:
            return None
        _, stretch, trail = begun[-1]
        return stretch, self.trails[trail]


def read_map(text: str) -> MapFile:
    """Read the file of a map.

    Raises:
        NoMapError: for what is none, or of another version.

    """
    try:
        match json.loads(text):
            case {"version": version} if version != VERSION:
                raise NoMapError(f"it is of version {version}, and version {VERSION} is read")
            case {"sha256": str(sha256), "sources": sources, "trails": trails, "mappings": mappings}:
                return _map_file(sha256, sources, trails, mappings)
    except NoMapError:
        raise
    except (AttributeError, TypeError, ValueError, RecursionError):
        pass
    raise NoMapError("it is not the file that linkforge writes")


def _map_file(sha256: str, sources: Any, trails: Any, mappings: Any) -> MapFile:  # Any: what JSON has
    """Return a map; one of the errors of Python for what is none."""
    found = tuple(map(_source, sources))
    ways = tuple(
        tuple((how, _stretch(row, len(found))) for step in steps for how, row in step.items()) for steps in trails
    )
    rows = {int(line): tuple(_segment(row, len(found), len(ways)) for row in rows) for line, rows in mappings.items()}
    return MapFile(sha256, found, ways, rows)


def _source(item: object) -> Source:
    match item:
        case {"path": str(path), "sha256": str(sha256)}:
            return Source(path, sha256)
    raise ValueError("it is no source")


def _segment(row: object, sources: int, trails: int) -> tuple[int, Stretch, int]:
    match row:
        case [int(column), *stretch, int(trail)] if column >= 0 and 0 <= trail < trails:
            return column, _stretch(stretch, sources), trail
    raise ValueError("it is no segment, or of a trail that there is not")


def _stretch(row: object, sources: int) -> Stretch:
    match row:
        case [int(source), int(line), int(column), int(length)] if min(row) >= 0 and source < sources:
            return Stretch(source, line, column, length)
    raise ValueError("it is no stretch, or of a source that there is not")
