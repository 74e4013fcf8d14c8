"""Functions and constants of expressions: pure, each with its signature and number of arguments."""

from __future__ import annotations

import keyword
import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from linkforge_compile.diagnostics.codes import expressions as codes
from linkforge_compile.expressions.operators import (
    Number,
    bounded,
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


@dataclass(frozen=True)
class Function:
    """A function: its signature, what it computes, and how many arguments it accepts (`most` None: any number)."""

    signature: str
    compute: Callable[..., Value]
    least: int = 1
    most: int | None = 1

    def __call__(self, *values: Value) -> Value:
        taker = self.signature.partition("(")[0] + "()"
        return bounded(lambda: self.compute(*values), taker)

    def accepts(self, count: int) -> bool:
        """Whether the function may be called with this many arguments."""
        return count >= self.least and (self.most is None or count <= self.most)


@dataclass(frozen=True)
class FileFunctionSignature:
    """A function of one text whose value depends on the file around the expression; the scope computes it."""

    signature: str

    def accepts(self, count: int) -> bool:
        """Whether the function may be called with this many arguments."""
        return count == 1


def _numbers(values: Sequence[Value], taker: str) -> tuple[list[Number], Dimension | None]:
    """Return the numbers of several arguments, or of one list, and their common dimension."""
    if len(values) == 1 and isinstance(values[0], tuple):
        pairs = [number(value, taker, 0) for value in values[0]]
        if not pairs:
            raise RefusedError(codes.OUTSIDE_DOMAIN, taker=taker, expected="at least one number", found="an empty list")
    else:
        pairs = [number(value, taker, operand) for operand, value in enumerate(values)]
    return [value for value, _ in pairs], shared_dimension([dimension for _, dimension in pairs], taker)


def _extreme(choose: Callable[[Iterable[Number]], Number], taker: str) -> Callable[..., Value]:
    """Make min() or max()."""

    def compute(*values: Value) -> Value:
        numbers, dimension = _numbers(values, taker)
        return with_dimension(choose(numbers), dimension)

    return compute


def _keeping_dimension(function: Callable[[Number], Number], taker: str) -> Callable[[Value], Value]:
    """Make a function of one number whose result has the dimension of its argument."""

    def compute(value: Value) -> Value:
        magnitude, dimension = number(value, taker, 0)
        return with_dimension(function(magnitude), dimension)

    return compute


def _round(value: Value, digits: Value = None) -> Value:
    """Round half to even, as Python does; a quantity is rounded in its SI unit."""
    magnitude, dimension = number(value, "round()", 0)
    if digits is None:
        return with_dimension(round(magnitude), dimension)
    if isinstance(digits, bool) or not isinstance(digits, int) or abs(digits) > _MOST_DIGITS:
        raise wrong_kind("round()", "a small whole number of digits", digits, operand=1)
    return with_dimension(round(magnitude, digits), dimension)


def _sqrt(value: Value) -> Value:
    """Return a bare number: no field has the dimension of a quantity's square root."""
    radicand, _ = number(value, "sqrt()", 0)
    if radicand < 0:
        raise _outside("0 or more", radicand, "sqrt()")
    return math.sqrt(radicand)


def _of_angle(function: Callable[[float], float], taker: str) -> Callable[[Value], Value]:
    """Make a function of an angle, or of a bare number [rad]."""

    def compute(value: Value) -> Value:
        return function(_in_dimension(value, Dimension.ANGLE, taker))

    return compute


def _in_dimension(value: Value, wanted: Dimension | None, taker: str) -> Number:
    """Return a bare number, or that of a quantity of the wanted dimension (None: no quantity)."""
    magnitude, dimension = number(value, taker, 0)
    if dimension not in (None, wanted):
        expected, found = dimension_name(wanted), dimension_name(dimension)
        raise RefusedError(codes.WRONG_DIMENSION, operand=0, taker=taker, expected=expected, found=found)
    return magnitude


def _outside(expected: str, value: Number, taker: str) -> RefusedError:
    return RefusedError(codes.OUTSIDE_DOMAIN, operand=0, taker=taker, expected=expected, found=number_text(value))


def _to_angle(function: Callable[[float], float], taker: str) -> Callable[[Value], Value]:
    """Make a function of a bare number from -1 to 1 that gives an angle."""

    def compute(value: Value) -> Value:
        ratio = _in_dimension(value, None, taker)
        if not -1 <= ratio <= 1:
            raise _outside("-1 to 1", ratio, taker)
        return Quantity(function(ratio), Dimension.ANGLE)

    return compute


def _atan2(y: Value, x: Value) -> Value:
    (rise, run), _ = _numbers((y, x), "atan2()")
    return Quantity(math.atan2(rise, run), Dimension.ANGLE)


def _radians(degrees: Value) -> Value:
    return Quantity(math.radians(_in_dimension(degrees, None, "radians()")), Dimension.ANGLE)


def _degrees(angle: Value) -> Value:
    return math.degrees(_in_dimension(angle, Dimension.ANGLE, "degrees()"))


def _len(value: Value) -> Value:
    if isinstance(value, str | tuple | Mapping):
        return len(value)
    raise wrong_kind("len()", "a list, a map or text", value, operand=0)


def _to_number(convert: Callable[[Any], Number], pattern: re.Pattern[str], taker: str) -> Callable[[Value], Value]:
    """Make int() or float(), of a number, a quantity in its SI unit, or text that is a number."""

    def compute(value: Value) -> Value:
        if not isinstance(value, str):
            return convert(number(value, taker, 0)[0])
        if pattern.fullmatch(value):
            return convert(value)
        raise wrong_kind(taker, "a number or text that is one", value, operand=0)

    return compute


def _str(value: Value) -> Value:
    text = as_text(value)
    if text is None:
        raise wrong_kind("str()", "a single value", value, operand=0)
    return text


FUNCTIONS: dict[str, Function] = {
    "min": Function("min(a, b, ...) or min(list)", _extreme(min, "min()"), most=None),
    "max": Function("max(a, b, ...) or max(list)", _extreme(max, "max()"), most=None),
    "abs": Function("abs(number)", _keeping_dimension(abs, "abs()")),
    "round": Function("round(number) or round(number, digits)", _round, most=2),
    "floor": Function("floor(number)", _keeping_dimension(math.floor, "floor()")),
    "ceil": Function("ceil(number)", _keeping_dimension(math.ceil, "ceil()")),
    "sqrt": Function("sqrt(number)", _sqrt),
    "sin": Function("sin(angle)", _of_angle(math.sin, "sin()")),
    "cos": Function("cos(angle)", _of_angle(math.cos, "cos()")),
    "tan": Function("tan(angle)", _of_angle(math.tan, "tan()")),
    "asin": Function("asin(ratio)", _to_angle(math.asin, "asin()")),
    "acos": Function("acos(ratio)", _to_angle(math.acos, "acos()")),
    "atan2": Function("atan2(y, x)", _atan2, least=2, most=2),
    "radians": Function("radians(degrees)", _radians),
    "degrees": Function("degrees(angle)", _degrees),
    "len": Function("len(list)", _len),
    "int": Function("int(number)", _to_number(int, _WHOLE_NUMBER, "int()")),
    "float": Function("float(number)", _to_number(float, _DECIMAL_NUMBER, "float()")),
    "str": Function("str(value)", _str),
}
"""The functions by name."""

CONSTANTS: dict[str, Value] = {"pi": math.pi, "true": True, "false": False, "null": None}
"""Names with the same value in every scope."""

FILE_FUNCTIONS: dict[str, FileFunctionSignature] = {
    "path": FileFunctionSignature("path(file)"),
    "link": FileFunctionSignature("link(name)"),
    "joint": FileFunctionSignature("joint(name)"),
}
"""Functions of the file: the path of a file on disk, and the final name of a link or joint."""

SIGNATURES: dict[str, Function | FileFunctionSignature] = {**FUNCTIONS, **FILE_FUNCTIONS}

RESERVED_NAMES: frozenset[str] = frozenset({*SIGNATURES, *CONSTANTS, *keyword.kwlist, "prefix", "name", "standalone"})
"""Names that no parameter, variable, data or `for` may declare."""
