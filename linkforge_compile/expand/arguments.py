"""What sets the parameters of a file, before the declarations give it a type."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.diagnostics import Diagnostics, Note
from linkforge_compile.diagnostics.codes.modules import NOT_AN_ASSIGNMENT, SET_TWICE
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax import YamlEntry, YamlNode, YamlScalar, scalar_value
from linkforge_compile.units import Quantity

if TYPE_CHECKING:
    from linkforge_compile.expressions import Value

COMMAND_LINE = "<command line>"


class Unset(Enum):
    """What it is when nothing sets a required parameter of the compiled file."""

    ERROR = "error"
    NOTE = "note"
    """Told once for all of them; what depends on them is not judged."""


class CliArgument(NamedTuple):
    """What another program sets, and how that says it, for diagnostics to name: `left_reach:=1 m` at `place`."""

    place: str
    name: str
    text: str


@dataclass(frozen=True)
class Arguments:
    """Values by parameter name, each with its place.

    `folder` is where their relative paths start, None for nowhere. Typed on a command line (`as_text`), a list or
    map is still text: what it means is known only with the parameter's type. `is_partial` where some could not be
    had, which was reported: then nobody asks for those that are missing. `from_python` says how others are set.
    """

    entries: Mapping[str, YamlEntry] = field(default_factory=dict)
    folder: Path | None = None
    as_text: bool = False
    is_partial: bool = False
    from_python: bool = False

    def without(self, names: Collection[str]) -> Arguments:
        """Return the others."""
        return replace(self, entries={name: entry for name, entry in self.entries.items() if name not in names})

    @property
    def named_files(self) -> Iterator[Path]:
        """The files that would be meant by values that are text, were they paths."""
        for entry in self.entries.values():
            if isinstance(entry.value, YamlScalar) and "\0" not in entry.value.text:
                yield (self.folder or Path()) / entry.value.text.removeprefix("file://")


def arguments_from_text(pairs: Sequence[str], sink: Diagnostics) -> Arguments:
    """Read `name=value` or ROS's `name:=value`; what is neither, and what is set twice, is reported."""
    entries: dict[str, YamlEntry] = {}
    for pair in pairs:
        name, equals, text = pair.partition("=")
        name = name.removesuffix(":").strip()
        file = SourceFile(COMMAND_LINE, pair)
        if not (name and equals):
            sink.report(NOT_AN_ASSIGNMENT.at(_span(file, 0, len(pair)), text=pair))
            continue
        key = YamlScalar(name, name, _span(file, pair.index(name), len(name)))
        if name in entries:
            first = Note("set here first", entries[name].key.span)
            sink.report(SET_TWICE.at(key.span, name=name, notes=[first]))
            continue
        entries[name] = YamlEntry(key, _typed(text, _span(file, len(pair) - len(text), len(text))))
    return Arguments(entries, Path(), as_text=True)


def _from_told(values: Mapping[str, CliArgument]) -> Arguments:
    """Take values by parameter name, which are read as on the command line."""
    entries: dict[str, YamlEntry] = {}
    for name, (place, spelt, text) in values.items():
        file = SourceFile(place, f"{spelt}:={text}")
        value = _typed(text, _span(file, len(spelt) + 2, len(text)))
        entries[name] = YamlEntry(YamlScalar(name, name, _span(file, 0, len(spelt))), value)
    return Arguments(entries, Path(), as_text=True)


def arguments_from_values(values: Mapping[str, object]) -> Arguments:
    """Take Python values: text is read as on the command line, None sets nothing; TypeError for what no spec says.

    Where all of them are what another program told, they are read as it says them.
    """
    if not values:
        return Arguments(folder=Path(), as_text=True, from_python=True)
    told = {name: value for name, value in values.items() if isinstance(value, CliArgument)}
    if len(told) == len(values):
        return _from_told(told)
    from linkforge_compile.expand.values import node_of

    entries: dict[str, YamlEntry] = {}
    for name, given in values.items():
        if not isinstance(name, str):
            raise TypeError(f"a parameter is set by its name, which is text, found {name!r}")
        value = _spec_value(name, given)
        shown = value if isinstance(value, str) else repr(given)
        file = SourceFile("<parameters>", f"{name}={shown}")
        key = YamlScalar(name, name, _span(file, 0, len(name)))
        span = _span(file, len(name) + 1, len(shown))
        entries[name] = YamlEntry(key, _typed(value, span) if isinstance(value, str) else node_of(value, span))
    return Arguments(entries, Path(), as_text=True, from_python=True)


def _typed(text: str, span: Span) -> YamlNode:
    """Read a scalar that was typed; `name=` and `name=null` are text, since to set nothing one need not say so."""
    value = scalar_value(text)
    return YamlScalar(text, text if value is None else value, span)


def _span(file: SourceFile, start: int, length: int) -> Span:
    """Return a stretch of text that may hold line breaks."""
    ends = []
    for offset in (start, start + length):
        before = file.text[:offset].split("\n")
        ends += [len(before), len(before[-1]) + 1]
    return Span(file, *ends)


def _spec_value(name: str, given: object) -> Value:
    if given is None or isinstance(given, bool | int | float | str | Quantity):
        return given
    if isinstance(given, os.PathLike):
        return str(given)
    from numbers import Real

    if isinstance(given, Real):  # numpy's, among others
        return float(given)
    if isinstance(given, Mapping):
        return {str(key): _spec_value(name, item) for key, item in given.items()}
    if isinstance(given, Iterable):
        return tuple(_spec_value(name, item) for item in given)
    raise TypeError(f"parameter {name!r} cannot be {type(given).__name__}")
