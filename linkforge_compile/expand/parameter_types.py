"""The types of parameters: which values each accepts, its constraints, and the regular expressions of `pattern`."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

from linkforge_compile.expressions import Value
from linkforge_compile.expressions.types import as_text, dimension_name
from linkforge_compile.units import Dimension, Quantity, units_of


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
    if not isinstance(value, tuple) or len(value) != 3:
        return None
    sizes = [item.value if isinstance(item, Quantity) else item for item in value]
    return value if all(_number(size) is not None for size in sizes) else None


def _boolean(value: Value) -> Value:
    return value if isinstance(value, bool) else None


def _list(value: Value) -> Value:
    return value if isinstance(value, tuple) else None


def _map(value: Value) -> Value:
    return value if isinstance(value, Mapping) else None


def _dimension_words(dimension: Dimension) -> str:
    *others, last = units_of(dimension)[:3]
    return f"{dimension_name(dimension)} in {', '.join(others)} or {last}"


_BOUNDED = frozenset({"minimum", "maximum", "enum"})
_MATCHED = frozenset({"pattern", "enum"})

_TABLE = (
    ParameterType("number", "a bare number", _number, _BOUNDED),
    ParameterType("integer", "a whole number", _integer, _BOUNDED),
    ParameterType("boolean", "true or false", _boolean),
    ParameterType("string", "text", as_text, _MATCHED),
    ParameterType("file", "a path", as_text, _MATCHED),
    ParameterType("vector", "three numbers", _vector),
    ParameterType("list", "a list", _list),
    ParameterType("map", "a map", _map),
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
