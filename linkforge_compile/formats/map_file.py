"""The file of a source map, written and read. docs/source-map.md describes it."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

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
        whole = _object(json.loads(text))
        if (version := whole.get("version")) != VERSION:
            raise NoMapError(f"it is of version {version}, and version {VERSION} is read")
        sources = tuple(_source(_object(item)) for item in _list(whole["sources"]))
        trails = tuple(
            tuple(
                (how, _stretch(_list(numbers), sources))
                for step in _list(steps)
                for how, numbers in _object(step).items()
            )
            for steps in _list(whole["trails"])
        )
        mappings = {
            int(line): tuple(_segment(_list(row), sources, len(trails)) for row in _list(rows))
            for line, rows in _object(whole["mappings"]).items()
        }
        return MapFile(_text(whole["sha256"]), sources, trails, mappings)
    except NoMapError:
        raise
    except (KeyError, ValueError, RecursionError) as error:
        raise NoMapError("it is not the file that linkforge writes") from error


def _segment(row: list[object], sources: tuple[Source, ...], trails: int) -> tuple[int, Stretch, int]:
    column, *stretch, trail = _numbers(row, 6)
    if trail >= trails:
        raise ValueError("there is no such trail")
    return column, _stretch(list(stretch), sources), trail


def _source(item: Mapping[str, object]) -> Source:
    return Source(_text(item["path"]), _text(item["sha256"]))


def _stretch(row: list[object], sources: tuple[Source, ...]) -> Stretch:
    stretch = Stretch(*_numbers(row, 4))
    if stretch.source >= len(sources):
        raise ValueError("there is no such source")
    return stretch


def _numbers(row: list[object], count: int) -> list[int]:
    numbers = [number for number in row if isinstance(number, int) and number >= 0]
    if len(numbers) != count or len(row) != count:
        raise ValueError(f"expected {count} numbers")
    return numbers


def _object(value: object) -> dict[str, object]:
    if not isinstance(value, dict):
        raise ValueError("expected an object")
    return value


def _list(value: object) -> list[object]:
    if not isinstance(value, list):
        raise ValueError("expected a list")
    return value


def _text(value: object) -> str:
    if not isinstance(value, str):
        raise ValueError("expected a text")
    return value
