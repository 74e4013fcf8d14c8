"""Read what a user sets: values of parameters, and the variants of a file."""

from __future__ import annotations

import math
import os
import re
import sys
from collections.abc import Collection, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple, cast

from linkforge_compile.diagnostics import BeyondLimitError, Diagnostics, Note
from linkforge_compile.diagnostics.codes.importing import XACRO_ARGUMENT
from linkforge_compile.diagnostics.codes.modules import NOT_AN_ASSIGNMENT, SET_TWICE, UNKNOWN_VARIANT
from linkforge_compile.diagnostics.enumerations import listed
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.load.loader import Loader, SpecFile
from linkforge_compile.load.locations import is_xacro
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax import YamlEntry, YamlMap, YamlNode, YamlScalar, scalar_value
from linkforge_compile.units import Dimension, Quantity, number_text, parse_quantity

if TYPE_CHECKING:
    from linkforge_compile.expand.evaluate import Evaluator
    from linkforge_compile.expressions import Fault, Value
    from linkforge_compile.load.xacro import XacroArgument

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

    `folder` is where relative paths among them start, None for nowhere. `evaluator` has the scope of the place where
    they are written, None if they hold no expressions. With `as_text` they were typed: a list or map is still text, to
    be read once the parameter's type is known. `is_partial` if some had reported errors, so that missing ones are not
    reported. `from_python` selects the wording of messages about missing ones.
    """

    entries: Mapping[str, YamlEntry] = field(default_factory=dict)
    folder: Path | None = None
    evaluator: Evaluator | None = None
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


@lru_cache(maxsize=1_000)
def typed_file(name: str, text: str) -> SourceFile:
    """Return the file of a text that was typed: the same one in every compile, so that places in it are equal."""
    return SourceFile(name, text)


def arguments_from_text(pairs: Sequence[str], sink: Diagnostics) -> Arguments:
    """Read `name=value` or ROS's `name:=value`; malformed and duplicate ones are reported."""
    entries: dict[str, YamlEntry] = {}
    for pair in pairs:
        name, equals, text = pair.partition("=")
        name = name.removesuffix(":").strip()
        file = typed_file(COMMAND_LINE, pair)
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

    A CliArgument is reported as the other program spells it. Raises TypeError for a value that no spec can hold.
    """
    entries: dict[str, YamlEntry] = {}
    for name, item in values.items():
        if not isinstance(name, str):
            raise TypeError(f"a parameter is set by its name, which is text, found {name!r}")
        typed = item if isinstance(item, CliArgument) else None
        value = typed.text if typed else _spec_value(name, item)
        shown = value if isinstance(value, str) else _shown(item)
        begin = f"{typed.name}:=" if typed else f"{name}="
        file = SourceFile(typed.place if typed else "<parameters>", begin + shown)
        key = YamlScalar(name, name, _span(file, 0, len(begin.rstrip(":="))))
        entries[name] = YamlEntry(key, _node(value, _span(file, len(begin), len(shown))))
    is_typed = bool(values) and all(isinstance(item, CliArgument) for item in values.values())
    return Arguments(entries, Path(), as_text=True, from_python=not is_typed)


def _node(value: Value, span: Span) -> YamlNode:
    if isinstance(value, str):
        return _scalar(value, span)
    from linkforge_compile.expand.values import node_of  # with the expressions, which plain robots do not need

    return node_of(value, span)


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
    if value is None or isinstance(value, bool | float | str | Quantity):
        return value
    if isinstance(value, int) and abs(value) <= sys.float_info.max:
        return value
    if isinstance(value, os.PathLike):
        return str(value)
    from numbers import Real

    if isinstance(value, Real):  # such as numpy's, and integers beyond any double
        try:
            return float(value)
        except OverflowError:  # infinite, as text with too many digits is; no parameter accepts it
            return math.inf if cast("int", value) > 0 else -math.inf
    if isinstance(value, Mapping):
        return {str(key): _spec_value(name, item) for key, item in value.items()}
    if isinstance(value, Iterable) and not isinstance(value, bytes | bytearray):
        return tuple(_spec_value(name, item) for item in value)
    raise TypeError(f"parameter {name!r} cannot be {type(value).__name__}")


def _shown(item: object) -> str:
    try:
        return repr(item)
    except ValueError:  # Python refuses to write an integer of thousands of digits
        return "…"


def xacro_arguments(
    arguments: Arguments, sink: Diagnostics, *, takes_maps: bool = False
) -> dict[str, XacroArgument] | None:
    """Return arguments as text, the only type that xacro has; None after a reported error.

    `takes_maps` for a macro, to which a map goes as an expression.
    """
    from linkforge_compile.load.xacro import XacroArgument

    texts: dict[str, XacroArgument] = {}
    for name, entry in arguments.entries.items():
        text = _xacro_text(entry.value, arguments)
        expression = _xacro_expression(entry.value, arguments) if text is None and takes_maps else None
        if isinstance(text, str):
            texts[name] = XacroArgument(text, entry.key.span, quantity=_quantity(entry.value, arguments))
        elif expression:
            origin = _origin_element(entry.value, arguments)
            texts[name] = XacroArgument(expression, entry.key.span, is_expression=True, origin=origin)
        elif text is None:
            sink.report(XACRO_ARGUMENT.at(entry.value.span, name=name))
    return None if arguments.is_partial or len(texts) < len(arguments.entries) else texts


def _xacro_text(node: YamlNode, arguments: Arguments) -> str | Fault | None:
    """Return an argument as text; FAULT after a reported error, None for a map or nothing."""
    from linkforge_compile.expand.values import plain_value  # with the expressions, as below
    from linkforge_compile.expressions import Fault

    if arguments.as_text and isinstance(node, YamlScalar):
        quantity = parse_quantity(node.text)
        return number_text(quantity.value) if quantity else node.text
    value = arguments.evaluator.value(node) if arguments.evaluator else plain_value(node)
    if isinstance(value, tuple):  # such as the three numbers of an `xyz`
        texts = [_text_of(item) for item in value]
        return " ".join(text for text in texts if text) if None not in texts else None
    return value if isinstance(value, Fault) else _text_of(value)


def _quantity(node: YamlNode, arguments: Arguments) -> Quantity | None:
    """Return an argument that has a unit; None for any other one."""
    from linkforge_compile.expand.values import plain_value  # with the expressions

    value = arguments.evaluator.value(node) if arguments.evaluator else plain_value(node)
    return value if isinstance(value, Quantity) else None


def _xacro_expression(node: YamlNode, arguments: Arguments) -> str | None:
    """Return the expression of xacro for a map, or a list of them; None for anything else."""
    from linkforge_compile.expand.values import plain_value  # with the expressions

    value = arguments.evaluator.value(node) if arguments.evaluator else plain_value(node)
    literal = _python_literal(value) if isinstance(value, Mapping | tuple) else None
    return literal and f"${{{f'xacro.dotify({literal})' if isinstance(value, Mapping) else literal}}}"


_POSE = {"xyz": Dimension.LENGTH, "rpy": Dimension.ANGLE}


def _origin_element(node: YamlNode, arguments: Arguments) -> str | None:
    """Return a map of `xyz` [m] and `rpy` [rad] as the element `origin`; None for anything else."""
    from linkforge_compile.expand.values import plain_value  # with the expressions

    value = arguments.evaluator.value(node) if arguments.evaluator else plain_value(node)
    if not isinstance(value, Mapping) or not value or not value.keys() <= _POSE.keys():
        return None
    texts = {key: _three_numbers(value[key], dimension) for key, dimension in _POSE.items() if key in value}
    attributes = " ".join(f'{key}="{text}"' for key, text in texts.items())
    return None if None in texts.values() else f"<origin {attributes}/>"


def _three_numbers(value: Value, dimension: Dimension) -> str | None:
    if not isinstance(value, tuple) or len(value) != 3 or any(isinstance(one, bool | str) for one in value):
        return None
    if any(isinstance(one, Quantity) and one.dimension is not dimension for one in value):
        return None
    texts = [_text_of(one) for one in value]
    return None if None in texts else " ".join(filter(None, texts))


def _python_literal(value: Value | Fault) -> str | None:
    """Return a value as Python without braces, which would end an expression of xacro; None for a fault."""
    if isinstance(value, Mapping):
        items = [(_python_literal(key), _python_literal(item)) for key, item in value.items()]
        return (
            f"dict([{', '.join(f'({key}, {item})' for key, item in items)}])"
            if all(all(one) for one in items)
            else None
        )
    if isinstance(value, tuple):
        literals = [_python_literal(item) for item in value]
        return f"[{', '.join(filter(None, literals))}]" if all(literals) else None
    if isinstance(value, str):
        return re.sub(r"[{}$]", lambda found: f"\\x{ord(found[0]):02x}", repr(value))
    number = value.value if isinstance(value, Quantity) else value
    return repr(number) if number is None or isinstance(number, bool | int | float) else None


def _text_of(value: Value) -> str | None:
    if isinstance(value, bool):
        return "true" if value else "false"
    number = value.value if isinstance(value, Quantity) else value
    if isinstance(number, int | float):
        return number_text(number)
    return value if isinstance(value, str) else None


class Variants(NamedTuple):
    """The settings of each variant of a file, and the names of the selected ones, of which the last one decides."""

    by_name: Mapping[str, YamlMap] = MappingProxyType({})
    selected: tuple[str, ...] = ()

    @classmethod
    def of(cls, spec: SpecFile, variant: str | None = None) -> Variants:
        """Return those of a file, with those that `--variant` selects; an empty one has no settings."""
        entries = spec.tree.section("variants").values()
        maps = {
            one.name: one.value if isinstance(one.value, YamlMap) else YamlMap({}, one.value.span) for one in entries
        }
        return cls(maps, tuple(name for name in names_in_variant(variant, maps) if name in maps))

    def settings_of(self, parameter: str) -> tuple[tuple[str, YamlNode], ...]:
        """Return the variants that set a parameter, and the values; the selected ones first, from the last one back."""
        names = dict.fromkeys((*reversed(self.selected), *self.by_name))
        values = ((name, self.by_name[name].get(parameter)) for name in names)
        return tuple((name, value) for name, value in values if value is not None)

    @property
    def entries(self) -> Iterator[YamlEntry]:
        """Every setting of every variant."""
        return (entry for variant in self.by_name.values() for entry in variant)


def names_in_variant(variant: str | None, known: Container[str]) -> tuple[str, ...]:
    """Return the names in `a+b`, each once; a variant may have such a name itself."""
    if variant is None:
        return ()
    return (variant,) if variant in known else tuple(dict.fromkeys(variant.split("+")))


def names_of_variants(path: Path, loader: Loader) -> Iterable[str]:
    """Return the names of the variants of a file; none if it cannot be read, which its compile reports."""
    if is_xacro(path):
        return ()
    try:
        spec = loader.open(path, Diagnostics())
    except BeyondLimitError:
        return ()
    return Variants.of(spec).by_name if spec else ()


def report_unknown_variants(variant: str | None, spec: SpecFile, sink: Diagnostics) -> bool:
    """Report each name in `--variant` that the compiled file does not have; return whether there is one."""
    known, text = Variants.of(spec).by_name, f"--variant {variant}"
    unknown = [name for name in names_in_variant(variant, known) if name not in known]
    for name in unknown:
        where = _span(SourceFile(COMMAND_LINE, text), text.index(name, len("--variant ")), len(name))
        hint = f"; its variants are {listed([*known], 'and')}" if known else "; it declares no variants"
        hint = "" if nearest(name, known) else hint
        sink.report(UNKNOWN_VARIANT.at(where, spec=spec.file.name, name=name, hint=hint, near=known))
    return bool(unknown)
