"""Read the declarations of `parameters`; check values against their types and constraints."""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes.model import WIDE_ANGLE
from linkforge_compile.diagnostics.codes.modules import (
    PARAMETER_CHOICE,
    PARAMETER_KIND,
    PARAMETER_PATTERN,
    PARAMETER_TOO_LARGE,
    PARAMETER_TOO_SMALL,
    PARAMETER_WITHOUT_TYPE,
)
from linkforge_compile.diagnostics.fix import Replacement
from linkforge_compile.expand.evaluate import Evaluator
from linkforge_compile.expand.values import describe
from linkforge_compile.expressions import FAULT, Value, forgotten_expression
from linkforge_compile.expressions.types import as_text, dimension_name
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlEntry, YamlFault, YamlMap, YamlNode, YamlScalar, has_expression
from linkforge_compile.syntax.nodes import YAML_1_1_BOOLEANS
from linkforge_compile.units import WIDEST_ANGLE, Dimension, Quantity, number_text, unit_text, units_of

_CONSTRAINTS = ("minimum", "maximum", "enum", "pattern")


@dataclass(frozen=True)
class Declaration:
    """A parameter as declared; `type` is None if it follows from the default.

    `is_faulty` if a part that decides on valid values was reported: then neither a value nor a missing one is.
    """

    key: YamlScalar
    type: ParameterType | None = None
    default: YamlNode | None = None
    constraints: Mapping[str, YamlEntry] = field(default_factory=dict)
    is_faulty: bool = False

    @property
    def name(self) -> str:
        return self.key.text

    @property
    def is_file(self) -> bool:
        return self.type is not None and self.type.name == "file"


def declarations(section: YamlNode | None) -> dict[str, Declaration]:
    """Return the declarations of the section `parameters` by name."""
    return {entry.name: _declaration(entry) for entry in section} if isinstance(section, YamlMap) else {}


def _declaration(entry: YamlEntry) -> Declaration:
    declared = entry.value
    if isinstance(declared, YamlFault):
        return Declaration(entry.key, is_faulty=True)
    if isinstance(declared, YamlScalar) and declared.value is None:
        return Declaration(entry.key)
    if not isinstance(declared, YamlMap):
        return Declaration(entry.key, default=declared)
    word = declared.get("type")
    type_ = PARAMETER_TYPES.get(word.text) if isinstance(word, YamlScalar) else None
    constraints = {name: declared.entries[name] for name in _CONSTRAINTS if declared.get(name) is not None}
    default = declared.get("default")
    # An unknown key, already reported, may be a misspelled `default`.
    is_misspelled = default is None and any(isinstance(part.value, YamlFault) for part in declared)
    is_faulty = is_misspelled or (word is not None and type_ is None)
    return Declaration(entry.key, type_, default, constraints, is_faulty)


def resolve_type(declaration: Declaration, evaluator: Evaluator) -> ParameterType | None:
    """Return the declared type, else that of the default; None after a reported error."""
    if declaration.type or declaration.is_faulty:
        return declaration.type
    if declaration.default is None:
        evaluator.sink.report(PARAMETER_WITHOUT_TYPE.at(declaration.key.span, name=declaration.name))
        return None
    value = evaluator.value(declaration.default)
    return None if value is FAULT else infer_type(value)


@dataclass(frozen=True)
class Parameter:
    """A parameter with computed constraints; None for those that are absent or faulty."""

    name: str
    type: ParameterType
    minimum: Value = None
    maximum: Value = None
    choices: tuple[Value, ...] | None = None
    pattern: Pattern | None = None

    def convert(self, value: Value, where: Span, sink: Diagnostics, names: Container[str]) -> Value:
        """Return the value converted to the parameter's type; None if it does not fit, which is reported.

        `names` are those that expressions may use where the value was written.
        """
        converted = self.type.convert(value)
        if converted is None:
            measured = f", which is {dimension_name(value.dimension)}" if isinstance(value, Quantity) else ""
            remedy = self._remedy(value, where, names)
            shown = f"'{remedy.new}'" if remedy and has_expression(remedy.new) else remedy and remedy.new
            found = f"{self._found(value)}{measured}{f'; write {shown}' if shown else ''}"
            fault = PARAMETER_KIND.at(where, parameter=self.name, expected=self.type.words, found=found)
            sink.report(fault.with_fix(remedy.within(fault.span)) if remedy else fault)
            return None
        violation = next(self._violations(converted, where), None)
        if violation:
            sink.report(violation)
            return None
        if self.type.name == Dimension.ANGLE and isinstance(value, int | float) and abs(value) > WIDEST_ANGLE:
            sink.report(WIDE_ANGLE.at(where, field=f"parameter '{self.name}'", found=number_text(value)))
        return converted

    def _found(self, value: Value) -> str:
        """Return a value that does not fit as messages quote it, of a vector only the first item that is no number."""
        if self.type.name == "vector" and isinstance(value, tuple) and len(value) == 3:
            axis, item = next((axis, item) for axis, item in zip("xyz", value, strict=True) if not _is_size(item))
            return f"{describe(item)} for {axis}"
        return describe(value)

    def _remedy(self, value: Value, where: Span, names: Container[str]) -> Replacement | None:
        """Return what to write for a text that looks like a value of another type, None for any other value."""
        if not isinstance(value, str):
            return None
        if self.type.name == "boolean" and (truth := YAML_1_1_BOOLEANS.get(value.lower())):
            return Replacement(value, truth, is_safe=True, is_whole=True)
        expression = forgotten_expression(value, where, names)
        return Replacement(value, expression, is_whole=True) if expression else None

    def _violations(self, value: Value, where: Span) -> Iterator[Diagnostic]:
        name, found = self.name, describe(value)
        if self.minimum is not None and number_of(value) < number_of(self.minimum):
            bound, shown = _comparison(self.minimum, value)
            yield PARAMETER_TOO_SMALL.at(where, parameter=name, bound=bound, found=shown)
        if self.maximum is not None and number_of(value) > number_of(self.maximum):
            bound, shown = _comparison(self.maximum, value)
            yield PARAMETER_TOO_LARGE.at(where, parameter=name, bound=bound, found=shown)
        if self.choices is not None and value not in self.choices:
            choices = [unquoted(choice) for choice in self.choices]
            near = choices if self.type.is_text else ()
            words = ", ".join(choices)
            yield PARAMETER_CHOICE.at(where, parameter=name, choices=words, name=unquoted(value), near=near)
        if self.pattern is not None and not self.pattern.is_in(str(value)):
            yield PARAMETER_PATTERN.at(where, parameter=name, pattern=self.pattern.text, found=found)


def number_of(value: Value) -> float:
    number = value.value if isinstance(value, Quantity) else value
    assert isinstance(number, int | float), "only numbers have a minimum or a maximum"
    return number


def _comparison(bound: Value, value: Value) -> tuple[str, str]:
    """Return a bound and a value outside of it for a message, with SI units added if their units differ."""
    plain, quoted = unquoted(bound), describe(value)
    if not isinstance(bound, Quantity) or not isinstance(value, Quantity):
        return plain, quoted
    if unit_text(str(bound)) == unit_text(str(value)):
        return plain, quoted
    if str(bound) != bound.in_si:
        plain += f", which is {bound.in_si}"
    if str(value) != value.in_si:
        quoted += f", which is {value.in_si}"
    return plain, quoted


def unquoted(value: Value) -> str:
    return describe(value).strip("'")


@dataclass(frozen=True)
class ParameterType:
    """A type: `words` describe it in messages, `convert` returns a value of it, None for one that does not fit."""

    name: str
    words: str
    convert: Callable[[Value], Value]
    constraints: frozenset[str] = frozenset({"enum"})

    @property
    def is_text(self) -> bool:
        """Whether a plain scalar is accepted as written: `1.10` keeps its zero, `3 kg` is not a mass."""
        return self.convert is as_text

    @property
    def is_structured(self) -> bool:
        return self.name in ("vector", "list", "map")


def infer_type(value: Value) -> ParameterType:
    """Return the type of a parameter that is declared by its default only."""
    match value:
        case bool():
            return PARAMETER_TYPES["boolean"]
        case int() | float():
            return PARAMETER_TYPES["number"]
        case Quantity():
            return PARAMETER_TYPES[value.dimension]
        case tuple():
            return PARAMETER_TYPES["list" if _vector(value) is None else "vector"]
        case Mapping():
            return PARAMETER_TYPES["map"]
    return PARAMETER_TYPES["string"]


def _number(value: Value) -> Value:
    """Accept finite numbers; others cannot be compared with a minimum or maximum."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return value if math.isfinite(value) else None


def _integer(value: Value) -> Value:
    """Accept whole numbers, 3.0 too, as JSON Schema does."""
    if isinstance(value, float) and value.is_integer():
        return int(value)
    return None if isinstance(value, bool) or not isinstance(value, int) else value


def _quantity(dimension: Dimension, value: Value) -> Value:
    """Accept quantities of the dimension, and bare numbers in SI units."""
    if isinstance(value, Quantity):
        return value if value.dimension is dimension and math.isfinite(value.value) else None
    number = _number(value)
    return Quantity(float(number), dimension) if isinstance(number, int | float) else None


def _vector(value: Value) -> Value:
    return value if isinstance(value, tuple) and len(value) == 3 and all(map(_is_size, value)) else None


def _is_size(value: Value) -> bool:
    """Whether a value is a finite number or quantity."""
    return _number(value.value if isinstance(value, Quantity) else value) is not None


def _instance(kind: type, value: Value) -> Value:
    return value if isinstance(value, kind) else None


def _dimension_words(dimension: Dimension) -> str:
    *others, last = units_of(dimension)[:3]
    return f"{dimension_name(dimension)} in {', '.join(others)} or {last}"


_BOUNDED = frozenset({"minimum", "maximum", "enum"})
_MATCHED = frozenset({"pattern", "enum"})

_TABLE = (
    ParameterType("number", "a bare number", _number, _BOUNDED),
    ParameterType("integer", "a whole number", _integer, _BOUNDED),
    ParameterType("boolean", "true or false", partial(_instance, bool)),
    ParameterType("string", "text", as_text, _MATCHED),
    ParameterType("file", "a path", as_text, _MATCHED),
    ParameterType("vector", "three numbers", _vector),
    ParameterType("list", "a list", partial(_instance, tuple)),
    ParameterType("map", "a map", partial(_instance, Mapping)),
    *(ParameterType(one, _dimension_words(one), partial(_quantity, one), _BOUNDED) for one in Dimension),
)

PARAMETER_TYPES = {one.name: one for one in _TABLE}
"""Every type by the word that declares it."""

MAX_PATTERN = 500
MAX_TEXT = 1_000
REFUSED_STEPS = 20_000
"""The most that rejecting a pattern costs, in steps of expressions."""

_MEMORY = 256 * 1024
"""What RE2 may use for one pattern [byte]; enough for a program of some thousand instructions, which runs 0.2 s."""

_CHARACTERS_PER_STEP = 25
"""How many characters each instruction of a pattern is matched against in the time of one step of an expression."""


class PatternError(Exception):
    """A text is not a valid pattern; the message says why."""


class Pattern:
    """A regular expression of a spec, run by RE2, since that takes linear time on patterns of untrusted specs."""

    def __init__(self, text: str) -> None:
        """Compile it; raise PatternError if it is invalid."""
        self.text = text
        if len(text) > MAX_PATTERN:
            raise PatternError(f"it is longer than {MAX_PATTERN} characters")
        try:
            import re2
        except ImportError as missing:
            raise PatternError("patterns need the package google-re2, which is not installed") from missing
        options = re2.Options()
        options.max_mem, options.log_errors, options.never_capture = _MEMORY, False, True
        try:
            self._compiled = re2.compile(_encode(text), options)
        except re2.error as error:
            reason, _, part = error.args[0].decode(errors="replace").partition(": ")
            raise PatternError(f"{reason} at '{part}'" if part else reason) from error

    def steps(self, text: str) -> int:
        """Return the most that searching a text costs, in steps of expressions."""
        instructions: int = self._compiled.programsize
        return instructions * (1 + min(len(text), MAX_TEXT) // _CHARACTERS_PER_STEP)

    def is_in(self, text: str) -> bool:
        """Whether the pattern matches anywhere in the text; never in a text longer than MAX_TEXT."""
        return len(text) <= MAX_TEXT and self._compiled.search(_encode(text)) is not None


def _encode(text: str) -> bytes:
    """Encode for RE2, including lone surrogates, which Python makes of undecodable bytes."""
    return text.encode(errors="surrogatepass")
