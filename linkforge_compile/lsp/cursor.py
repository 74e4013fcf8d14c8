"""Find what a position in a text is: the path of keys that leads to it, and whether a key or a value is there.

The text need not parse. PyYAML reads it up to a marker in place of the word at the position, so that what follows does
not matter; if what precedes is malformed, it reads from the last line that begins a section, and else only the keys
that are around the position by their indentation.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import Enum, auto
from typing import NamedTuple, TypeAlias

from yaml.events import (
    AliasEvent,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    SequenceStartEvent,
)

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.source import Position, SourceFile, Span
from linkforge_compile.syntax import YamlEntry, YamlMap, read_data
from linkforge_compile.syntax.parser import readable_events

_Path: TypeAlias = tuple[str | int, ...]

MARKER = "linkforge_marker"
"""No word of a spec: its name is not one that a person gives to a part."""

_WORD = re.compile(r"[^\s,\[\]{}()'\"#:$*+]*")
_SECTION = re.compile(r"^(?=[^\s#\-\]}])", re.MULTILINE)
"""The first character of a line that begins a section."""

_KEY = re.compile(r"(?P<indent>\s*)(?:-\s+)*[^\s#\-\[\]{},][^#]*?:(?=\s|$)")
"""A key that begins a line."""

_OWN_LINE = re.compile(r"\s*(-\s+)*")


class Role(Enum):
    """What is at a position."""

    KEY = auto()
    VALUE = auto()
    ITEM = auto()
    """The beginning of an item of a list, which may be a value or the first key of an object."""


class Cursor(NamedTuple):
    """What is at a position.

    `path` leads to the value or item there, for a key to the map that has it. `word` is the place of the word at the
    position. `before` is what is written of the scalar up to the position, with the words before it. `siblings` are the
    keys that precede a key in its map. `is_own_line` tells whether nothing else precedes it in its line, `is_flow`
    whether it is in braces or brackets.
    """

    path: _Path
    role: Role
    word: Span
    before: str
    siblings: tuple[str, ...] = ()
    is_own_line: bool = False
    is_flow: bool = False

    @property
    def typed(self) -> str:
        """The word up to the position."""
        begin = max((self.before.rfind(mark) for mark in " \t,[]{}()'\"#:$*+"), default=-1)
        return self.before[begin + 1 :]

    @property
    def expression(self) -> str | None:
        """What is written, up to the position, of the expression that the position is in; None if it is in none."""
        return open_expression(self.before)


def find_cursor(file: SourceFile, at: Position) -> Cursor | None:
    """Return what is at a position; None for a comment, and where nothing can be read."""
    line = file.line(at.line)
    begin = at.column - 1
    while begin and _WORD.fullmatch(line[begin - 1]):
        begin -= 1
    word = _WORD.match(line, begin)
    assert word is not None, "the pattern matches an empty word"
    span = Span(file, at.line, begin + 1, at.line, word.end() + 1)
    lines = [*file.lines[: at.line - 1], line[:begin]]
    rest, is_own_line = line[word.end() :], _OWN_LINE.fullmatch(line[:begin]) is not None
    begins_item = line[:begin].lstrip().startswith("-") and not rest.lstrip().startswith(":")
    for beginning in _beginnings("\n".join(lines)):
        for marked in _marked(rest, is_own_line=is_own_line):
            found = _find_marker(beginning + marked)
            if found is not None:
                path, role, before, siblings, is_flow = found
                role = Role.ITEM if role is Role.KEY and begins_item and is_own_line else role
                typed = before + line[begin : at.column - 1]
                return Cursor(path, role, span, typed, siblings, is_own_line, is_flow)
    return None


def _beginnings(text: str) -> Iterator[str]:
    """Yield a text, what of it begins with the last line that begins a section, and the keys around its last line."""
    yield text
    sections = [found.start() for found in _SECTION.finditer(text)]
    if sections and sections[-1]:
        yield text[sections[-1] :]
    yield _keys_around(text.split("\n"))


def _keys_around(lines: list[str]) -> str:
    """Return the last of the lines with the keys above it that are indented less, each less than those below it."""
    last = lines[-1]
    kept, indent = [last], len(last) - len(last.lstrip())
    for line in reversed(lines[:-1]):
        key = _KEY.match(line)
        if key and len(key["indent"]) < indent:
            kept.append(key[0])
            indent = len(key["indent"])
    return "\n".join(reversed(kept))


def _marked(rest: str, *, is_own_line: bool) -> Iterator[str]:
    """Yield the marker with each end that may make it a scalar; `rest` is what follows the word in its line."""
    if is_own_line:
        yield f"{MARKER}: "
    yield from (MARKER, f"{MARKER}{rest}", f'{MARKER}"', f"{MARKER}'")


_Found: TypeAlias = tuple[_Path, Role, str, tuple[str, ...], bool]


def _find_marker(text: str) -> _Found | None:
    """Return what a Cursor needs to know of the marker."""
    levels: list[_Level] = []
    before = _read_to_marker(text, levels)
    return None if before is None else _found(levels, before)


def _read_to_marker(text: str, levels: list[_Level]) -> str | None:
    """Read a text and keep the `levels` that are open; return what precedes the marker in its scalar, None for none.

    If the text is malformed, they are those that are open there.
    """
    for event in readable_events(text):
        match event:
            case ScalarEvent(value=value) if MARKER in value:
                return str(value.partition(MARKER)[0])
            case ScalarEvent(value=value):
                if levels:
                    levels[-1].pass_node(value)
            case AliasEvent():
                levels[-1].pass_node("")
            case MappingStartEvent() | SequenceStartEvent():
                is_map = isinstance(event, MappingStartEvent)
                levels.append(_Level(is_map=is_map, is_flow=bool(event.flow_style)))
            case MappingEndEvent() | SequenceEndEvent():
                levels.pop()
                if levels:
                    levels[-1].pass_node("")
    return None


def closed(text: str) -> str | None:
    """Return a text that ends with the marker, with the quote and the brackets that close what is open there."""
    for quote in ("", '"', "'"):
        levels: list[_Level] = []
        if _read_to_marker(text + quote, levels) is not None:
            return text + quote + "".join("}" if level.is_map else "]" for level in reversed(levels) if level.is_flow)
    return None


def section_lines(file: SourceFile, line: int) -> tuple[int, int]:
    """Return the first and the last line of the section that a line is in; those of the file for one above all."""
    starts = [number for number, text in enumerate(file.lines, start=1) if _SECTION.match(text)]
    first = max((start for start in starts if start <= line), default=1)
    last = min((start for start in starts if start > line), default=len(file.lines) + 1) - 1
    return first, last


def lines_of_section(file: SourceFile, name: str) -> tuple[str, ...]:
    """Return the lines of a section by its key; none if there is no such section."""
    for number, text in enumerate(file.lines, start=1):
        if text.startswith(name) and text[len(name) :].lstrip().startswith(":"):
            return file.lines[number - 1 : section_lines(file, number)[1]]
    return ()


def section_names(file: SourceFile, line: int) -> tuple[str, ...]:
    """Return the keys of the sections of a file, but for one in a line."""
    lines = (text for number, text in enumerate(file.lines, start=1) if number != line and _SECTION.match(text))
    return tuple(text.partition(":")[0].strip() for text in lines)


def read_sections(file: SourceFile) -> YamlMap:
    """Read the sections of a text each by itself; return those that can be read, at their places."""
    entries: dict[str, YamlEntry] = {}
    for first in (number for number, text in enumerate(file.lines, start=1) if _SECTION.match(text)):
        text = "\n" * (first - 1) + "\n".join(file.lines[first - 1 : section_lines(file, first)[1]])
        section = read_data(SourceFile(file.name, text, file.path), Diagnostics(), {})
        entries |= section.entries if isinstance(section, YamlMap) else {}
    return YamlMap(entries, file.whole)


@dataclass
class _Level:
    """A map or list that the parser is in; `step` is its key or the position of its item, None before a key."""

    is_map: bool
    is_flow: bool = False
    keys: list[str] = field(default_factory=list)
    items: int = 0
    is_value: bool = False

    @property
    def step(self) -> str | int | None:
        if self.is_map:
            return self.keys[-1] if self.is_value else None
        return self.items

    def pass_node(self, text: str) -> None:
        """Go on after a node; `text` is that of a scalar."""
        if not self.is_map:
            self.items += 1
            return
        if not self.is_value:
            self.keys.append(text)
        self.is_value = not self.is_value


def _found(levels: list[_Level], before: str) -> _Found:
    path = tuple(level.step for level in levels if level.step is not None)
    if not levels or (levels[-1].is_map and not levels[-1].is_value):
        keys, is_flow = (tuple(levels[-1].keys), levels[-1].is_flow) if levels else ((), False)
        return path, Role.KEY, before, keys, is_flow
    return path, Role.VALUE if levels[-1].is_map else Role.ITEM, before, (), levels[-1].is_flow


def open_expression(text: str) -> str | None:
    """Return what follows the last `$(` of a text that is not closed in it; None if there is none."""
    starts: list[int] = []
    index = 0
    while index < len(text):
        if text.startswith("$$(", index):
            index += 3
            continue
        if text.startswith("$(", index):
            starts.append(index + 2)
            index += 2
            continue
        if starts and text[index] == "(":
            starts.append(starts[-1])
        elif starts and text[index] == ")":
            starts.pop()
        index += 1
    return text[starts[-1] :] if starts else None
