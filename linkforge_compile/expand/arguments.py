"""Read what a user sets: values of parameters, and the variants of a file."""

from __future__ import annotations

import os
from collections.abc import Collection, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics, Note
from linkforge_compile.diagnostics.codes.modules import NOT_AN_ASSIGNMENT, SET_TWICE, UNKNOWN_VARIANT
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.expand.loader import Loader, SpecFile
from linkforge_compile.expand.uses import XACRO
from linkforge_compile.schema.shapes import alternatives
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax import YamlEntry, YamlMap, YamlNode, YamlScalar, scalar_value
from linkforge_compile.units import Quantity

if TYPE_CHECKING:
    from linkforge_compile.expressions import Value

COMMAND_LINE = "<command line>"


class Unset(Enum):
    """How to report required parameters of the compiled file that have no value."""

    ERROR = "error"
    NOTE = "note"
    """One note for all; what depends on them is not checked."""


class CliArgument(NamedTuple):
    """A value that another program sets, spelled as there: `left_reach:=1 m` at `place`."""

    place: str
    name: str
    text: str


@dataclass(frozen=True)
class Arguments:
    """Values by parameter name, each with its place.

    `folder` is where relative paths among them start, None for nowhere. With `as_text` they were typed: a list or map
    is still text, to be read once the parameter's type is known. `is_partial` if some had reported errors, so that
    missing ones are not reported. `from_python` selects the wording of messages about missing ones.
    """

    entries: Mapping[str, YamlEntry] = field(default_factory=dict)
    folder: Path | None = None
    as_text: bool = False
    is_partial: bool = False
    from_python: bool = False

    def without(self, names: Collection[str]) -> Arguments:
        return replace(self, entries={name: entry for name, entry in self.entries.items() if name not in names})

    @property
    def named_files(self) -> Iterator[Path]:
        """The paths that text values would name if they were paths."""
        for entry in self.entries.values():
            if isinstance(entry.value, YamlScalar) and "\0" not in entry.value.text:
                yield (self.folder or Path()) / entry.value.text.removeprefix("file://")


def arguments_from_text(pairs: Sequence[str], sink: Diagnostics) -> Arguments:
    """Read `name=value` or ROS's `name:=value`; malformed and duplicate ones are reported."""
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
        entries[name] = YamlEntry(key, _scalar(text, _span(file, len(pair) - len(text), len(text))))
    return Arguments(entries, Path(), as_text=True)


def arguments_from_values(values: Mapping[str, object]) -> Arguments:
    """Read Python values; text is read as on the command line, None sets nothing.

    If all of them are CliArguments, they are reported as the other program spells them. Raises TypeError for a value
    that no spec can hold.
    """
    if not values:
        return Arguments(folder=Path(), as_text=True, from_python=True)
    cli_arguments = {name: value for name, value in values.items() if isinstance(value, CliArgument)}
    if len(cli_arguments) == len(values):
        return _from_cli_arguments(cli_arguments)
    from linkforge_compile.expand.values import node_of

    entries: dict[str, YamlEntry] = {}
    for name, item in values.items():
        if not isinstance(name, str):
            raise TypeError(f"a parameter is set by its name, which is text, found {name!r}")
        value = _spec_value(name, item)
        shown = value if isinstance(value, str) else repr(item)
        file = SourceFile("<parameters>", f"{name}={shown}")
        key = YamlScalar(name, name, _span(file, 0, len(name)))
        span = _span(file, len(name) + 1, len(shown))
        entries[name] = YamlEntry(key, _scalar(value, span) if isinstance(value, str) else node_of(value, span))
    return Arguments(entries, Path(), as_text=True, from_python=True)


def _from_cli_arguments(values: Mapping[str, CliArgument]) -> Arguments:
    entries: dict[str, YamlEntry] = {}
    for name, (place, spelled, text) in values.items():
        file = SourceFile(place, f"{spelled}:={text}")
        value = _scalar(text, _span(file, len(spelled) + 2, len(text)))
        entries[name] = YamlEntry(YamlScalar(name, name, _span(file, 0, len(spelled))), value)
    return Arguments(entries, Path(), as_text=True)


def _scalar(text: str, span: Span) -> YamlNode:
    """Read a typed scalar; `name=` and `name=null` are text, because leaving the argument out sets nothing."""
    value = scalar_value(text)
    return YamlScalar(text, text if value is None else value, span)


def _span(file: SourceFile, start: int, length: int) -> Span:
    """Return a part of a text that may contain line breaks."""
    ends = []
    for offset in (start, start + length):
        before = file.text[:offset].split("\n")
        ends += [len(before), len(before[-1]) + 1]
    return Span(file, *ends)


def _spec_value(name: str, value: object) -> Value:
    if value is None or isinstance(value, bool | int | float | str | Quantity):
        return value
    if isinstance(value, os.PathLike):
        return str(value)
    from numbers import Real

    if isinstance(value, Real):  # such as numpy's
        return float(value)
    if isinstance(value, Mapping):
        return {str(key): _spec_value(name, item) for key, item in value.items()}
    if isinstance(value, Iterable):
        return tuple(_spec_value(name, item) for item in value)
    raise TypeError(f"parameter {name!r} cannot be {type(value).__name__}")


_MAX_LISTED = 8


class Variants(NamedTuple):
    """The settings of each variant of a file, and the names of the selected ones, of which the last one decides."""

    by_name: Mapping[str, YamlMap] = MappingProxyType({})
    selected: tuple[str, ...] = ()

    @classmethod
    def of(cls, spec: SpecFile, variant: str | None) -> Variants:
        """Return the variants of a file with those selected by `--variant`, None for the defaults."""
        by_name = variants_of(spec)
        return cls(by_name, tuple(name for name in names_in_variant(variant, by_name) if name in by_name))

    def values_of(self, parameter: str) -> tuple[tuple[str, YamlNode], ...]:
        """Return the selected variants that set a parameter, with the values; the one that decides comes first."""
        values = ((name, self.by_name[name].get(parameter)) for name in reversed(self.selected))
        return tuple((name, value) for name, value in values if value is not None)

    def other_values_of(self, parameter: str) -> tuple[YamlNode, ...]:
        """Return what the other variants set a parameter to."""
        others = (variant.get(parameter) for name, variant in self.by_name.items() if name not in self.selected)
        return tuple(value for value in others if value is not None)

    def entries(self) -> Iterator[YamlEntry]:
        """Yield every setting of every variant."""
        for variant in self.by_name.values():
            yield from variant


def variants_of(spec: SpecFile) -> dict[str, YamlMap]:
    """Return the variants of a file by name; an empty one has no settings."""
    section = spec.tree.get("variants")
    return {
        entry.name: entry.value if isinstance(entry.value, YamlMap) else YamlMap({}, entry.value.span)
        for entry in (section if isinstance(section, YamlMap) else ())
    }


def names_in_variant(variant: str | None, known: Container[str]) -> tuple[str, ...]:
    """Return the names in `a+b`, each once; a variant may have such a name itself."""
    if variant is None:
        return ()
    return (variant,) if variant in known else tuple(dict.fromkeys(variant.split("+")))


def names_of_variants(path: Path, loader: Loader) -> Iterable[str]:
    """Return the names of the variants of a file; none if it cannot be read, which its compile reports."""
    if path.suffix.lower() == XACRO:
        return ()
    try:
        spec = loader.open(path, Diagnostics())
    except BeyondLimitError:
        return ()
    return variants_of(spec) if spec else ()


def report_unknown_variants(variant: str | None, spec: SpecFile, sink: Diagnostics) -> bool:
    """Report each name in `--variant` that the compiled file does not have; return whether there is one."""
    known = variants_of(spec)
    unknown = [name for name in names_in_variant(variant, known) if name not in known]
    for name in unknown:
        _report_unknown_variant(name, f"--variant {variant}", spec, sink)
    return bool(unknown)


def _report_unknown_variant(name: str, text: str, spec: SpecFile, sink: Diagnostics) -> None:
    where = _span(SourceFile(COMMAND_LINE, text), text.index(name, len("--variant ")), len(name))
    known = variants_of(spec)
    names = [f"'{each}'" for each in known]
    shown = [*names[:_MAX_LISTED], f"{len(names) - _MAX_LISTED} more"] if len(names) > _MAX_LISTED else names
    hint = f"; its variants are {alternatives(shown, 'and')}" if shown else "; it declares no variants"
    near = nearest(name, known)
    sink.report(UNKNOWN_VARIANT.at(where, spec=spec.file.name, name=name, hint="" if near else hint, near=known))
