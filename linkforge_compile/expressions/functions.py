"""Functions and constants of expressions: pure, each with its signature and number of arguments."""

from __future__ import annotations

import keyword
import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any

from linkforge_compile.diagnostics.codes import expressions as codes
from linkforge_compile.expressions.operators import (
    MAX_TEXT,
    Number,
    Operation,
    number,
    shared_dimension,
    with_dimension,
    wrong_kind,
)
from linkforge_compile.expressions.types import RefusedError, Value, as_text, dimension_name
from linkforge_compile.units import Dimension, Quantity, number_text

_WHOLE_NUMBER = re.compile(r"\s*[+-]?[0-9]{1,300}\s*")
_DECIMAL_NUMBER = re.compile(r"\s*[+-]?(?:[0-9]{1,300}(?:\.[0-9]{0,300})?|\.[0-9]{1,300})(?:[eE][+-]?[0-9]{1,3})?\s*")
_MOST_DIGITS = 400
"""What round() accepts as its second argument, positive or negative."""


def _numbers(values: Sequence[Value]) -> tuple[list[Number], Dimension | None]:
    """Return the numbers of several arguments, or of one list, and their common dimension."""
    if len(values) == 1 and isinstance(values[0], tuple):
        pairs = [number(value) for value in values[0]]
        if not pairs:
            raise RefusedError(codes.OUTSIDE_DOMAIN, expected="at least one number", found="an empty list")
    else:
        pairs = [number(value, operand) for operand, value in enumerate(values)]
    return [value for value, _ in pairs], shared_dimension(*(dimension for _, dimension in pairs))


def _extreme(choose: Callable[[Iterable[Number]], Number], *values: Value) -> Value:
    numbers, dimension = _numbers(values)
    return with_dimension(choose(numbers), dimension)


def _keep_dimension(function: Callable[[Number], Number], value: Value) -> Value:
    magnitude, dimension = number(value)
    return with_dimension(function(magnitude), dimension)


def _round(value: Value, digits: Value = None) -> Value:
    """Round half to even, as Python does; a quantity is rounded in its SI unit."""
    magnitude, dimension = number(value)
    if digits is None:
        return with_dimension(round(magnitude), dimension)
    if isinstance(digits, bool) or not isinstance(digits, int) or abs(digits) > _MOST_DIGITS:
        raise wrong_kind("a small whole number of digits", digits, operand=1)
    return with_dimension(round(magnitude, digits), dimension)


def _sqrt(value: Value) -> Value:
    """Return a bare number: no field has the dimension of a quantity's square root."""
    radicand, _ = number(value)
    if radicand < 0:
        raise RefusedError(codes.OUTSIDE_DOMAIN, operand=0, expected="0 or more", found=number_text(radicand))
    return math.sqrt(radicand)


def _in_dimension(value: Value, wanted: Dimension | None) -> Number:
    """Return a bare number, or that of a quantity of the wanted dimension (None: no quantity)."""
    magnitude, dimension = number(value)
    if dimension not in (None, wanted):
        expected, found = dimension_name(wanted), dimension_name(dimension)
        raise RefusedError(codes.WRONG_DIMENSION, operand=0, expected=expected, found=found)
    return magnitude


def _of_angle(function: Callable[[float], float], value: Value) -> Value:
    """Compute a function of an angle, or of a bare number [rad]."""
    return function(_in_dimension(value, Dimension.ANGLE))


def _to_angle(function: Callable[[float], float], value: Value) -> Value:
    """Compute the angle that a function gives for a bare number from -1 to 1."""
    ratio = _in_dimension(value, None)
    if not -1 <= ratio <= 1:
        raise RefusedError(codes.OUTSIDE_DOMAIN, operand=0, expected="-1 to 1", found=number_text(ratio))
    return Quantity(function(ratio), Dimension.ANGLE)


def _atan2(y: Value, x: Value) -> Value:
    (rise, run), _ = _numbers((y, x))
    return Quantity(math.atan2(rise, run), Dimension.ANGLE)


def _radians(degrees: Value) -> Value:
    return Quantity(math.radians(_in_dimension(degrees, None)), Dimension.ANGLE)


def _len(value: Value) -> Value:
    if isinstance(value, str | tuple | Mapping):
        return len(value)
    raise wrong_kind("a list, a map or text", value, operand=0)


def _merge(*maps: Value) -> Value:
    """Return the entries of all maps; of two with one key, that of the later map."""
    merged: dict[str, Value] = {}
    for operand, entries in enumerate(maps):
        if not isinstance(entries, Mapping):
            raise wrong_kind("a map", entries, operand)
        merged |= entries
    return merged


def _to_number(convert: Callable[[Any], Number], pattern: re.Pattern[str], value: Value) -> Value:
    """Convert a number, a quantity in its SI unit, or text that is a number."""
    if not isinstance(value, str):
        return convert(number(value)[0])
    if pattern.fullmatch(value):
        return convert(value)
    raise wrong_kind("a number or text that is one", value, operand=0)


def _str(value: Value) -> Value:
    text = as_text(value)
    if text is None:
        raise wrong_kind("a single value", value, operand=0)
    return text


def _join(values: Value, separator: Value = " ") -> Value:
    """Return the items of a list as one text, as URDF and most plugins write a vector."""
    if not isinstance(values, tuple):
        raise wrong_kind("a list", values, operand=0)
    if not isinstance(separator, str):
        raise wrong_kind("text between the items", separator, operand=1)
    texts: list[str] = []
    for value in values:
        text = as_text(value)
        if text is None:
            raise wrong_kind("a list of single values", value, operand=0)
        texts.append(text)
    # Few items, each of them long, would be a text that exhausts memory.
    if sum(map(len, texts)) + len(texts) * len(separator) > MAX_TEXT:
        raise RefusedError(codes.TEXT_TOO_LONG, limit=f"{MAX_TEXT:,}")
    return separator.join(texts)


def _split(text: Value) -> Value:
    """Return the words of a text as a list, those that are numbers as numbers."""
    if not isinstance(text, str):
        raise wrong_kind("text", text, operand=0)
    return tuple(map(_word, text.split()))


def _word(word: str) -> Value:
    if _WHOLE_NUMBER.fullmatch(word):
        return int(word)
    if not _DECIMAL_NUMBER.fullmatch(word):
        return word
    if not math.isfinite(found := float(word)):
        raise OverflowError
    return found


def _text(value: Value) -> Value:
    """Return the argument of a function of the file."""
    if isinstance(value, str):
        return value
    raise wrong_kind("text", value, operand=0)


def _function(signature: str, compute: Callable[..., Value], least: int = 1, most: int | None = 1) -> Operation:
    return Operation(f"{signature.partition('(')[0]}()", compute, signature, least, most)


def _by_name(*functions: Operation) -> dict[str, Operation]:
    return {function.name.removesuffix("()"): function for function in functions}


FUNCTIONS = _by_name(
    _function("min(a, b, ...) or min(list)", partial(_extreme, min), most=None),
    _function("max(a, b, ...) or max(list)", partial(_extreme, max), most=None),
    _function("abs(number)", partial(_keep_dimension, abs)),
    _function("round(number) or round(number, digits)", _round, most=2),
    _function("floor(number)", partial(_keep_dimension, math.floor)),
    _function("ceil(number)", partial(_keep_dimension, math.ceil)),
    _function("sqrt(number)", _sqrt),
    _function("sin(angle)", partial(_of_angle, math.sin)),
    _function("cos(angle)", partial(_of_angle, math.cos)),
    _function("tan(angle)", partial(_of_angle, math.tan)),
    _function("asin(ratio)", partial(_to_angle, math.asin)),
    _function("acos(ratio)", partial(_to_angle, math.acos)),
    _function("atan2(y, x)", _atan2, least=2, most=2),
    _function("radians(degrees)", _radians),
    _function("degrees(angle)", partial(_of_angle, math.degrees)),
    _function("len(list)", _len),
    _function("merge(map, other, ...)", _merge, least=2, most=None),
    _function("int(number)", partial(_to_number, int, _WHOLE_NUMBER)),
    _function("float(number)", partial(_to_number, float, _DECIMAL_NUMBER)),
    _function("str(value)", _str),
    _function("join(list) or join(list, separator)", _join, most=2),
    _function("split(text)", _split),
)
"""The functions by name."""

CONSTANTS: dict[str, Value] = {"pi": math.pi, "true": True, "false": False, "null": None}
"""Names with the same value in every scope."""

FILE_FUNCTIONS = _by_name(
    _function("path(file)", _text), _function("link(name)", _text), _function("joint(name)", _text)
)
"""Functions whose value the scope computes: the path of a file on disk, and the final name of a link or joint."""

SIGNATURES = {**FUNCTIONS, **FILE_FUNCTIONS}

RESERVED_NAMES = frozenset({*SIGNATURES, *CONSTANTS, *keyword.kwlist, "prefix", "name", "standalone"})
"""Names that no parameter, variable, data or `for` may declare."""
