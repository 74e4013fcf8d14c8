"""The functions of expressions: pure, each with how it is written and how many values it takes."""

from __future__ import annotations

import keyword
import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from linkforge_compile.diagnostics.codes import expressions as codes
from linkforge_compile.expressions.operators import Number, bounded, number, shared_dimension, with_dimension
from linkforge_compile.expressions.types import RefusedError, Value, as_text, dimension_name, kind_name
from linkforge_compile.units import Dimension, Quantity, number_text

_WHOLE_NUMBER = re.compile(r"\s*[+-]?[0-9]{1,300}\s*")
_DECIMAL_NUMBER = re.compile(r"\s*[+-]?(?:[0-9]{1,300}(?:\.[0-9]{0,300})?|\.[0-9]{1,300})(?:[eE][+-]?[0-9]{1,3})?\s*")


@dataclass(frozen=True)
class Function:
    """A function: how it is written, what it computes, and how many values it takes (`most` None: any number)."""

    signature: str
    compute: Callable[..., Value]
    least: int = 1
    most: int | None = 1

    def __call__(self, *values: Value) -> Value:
        taker = self.signature.partition("(")[0] + "()"
        return bounded(lambda: self.compute(*values), taker)

    def takes(self, count: int) -> bool:
        return count >= self.least and (self.most is None or count <= self.most)


@dataclass(frozen=True)
class FileFunction:
    """A function of one text that means something only in the file around the expression: its scope computes it."""

    signature: str

    def takes(self, count: int) -> bool:
        return count == 1


def _values(values: Sequence[Value], taker: str) -> tuple[list[Number], Dimension | None]:
    """Return the numbers of several values, or of the one list, and their dimension."""
    if len(values) == 1 and isinstance(values[0], tuple):
        pairs = [number(value, taker, 0) for value in values[0]]
        if not pairs:
            raise RefusedError(codes.OUTSIDE_DOMAIN, taker=taker, expected="at least one number", found="an empty list")
    else:
        pairs = [number(value, taker, operand) for operand, value in enumerate(values)]
    return [value for value, _ in pairs], shared_dimension([dimension for _, dimension in pairs], taker)


def _min(*values: Value) -> Value:
    numbers, dimension = _values(values, "min()")
    return with_dimension(min(numbers), dimension)


def _max(*values: Value) -> Value:
    numbers, dimension = _values(values, "max()")
    return with_dimension(max(numbers), dimension)


def _abs(value: Value) -> Value:
    magnitude, dimension = number(value, "abs()", 0)
    return with_dimension(abs(magnitude), dimension)


def _round(value: Value, digits: Value = None) -> Value:
    """Round half to even, as Python does; a quantity is rounded in its SI unit."""
    magnitude, dimension = number(value, "round()", 0)
    if digits is None:
        return with_dimension(round(magnitude), dimension)
    if isinstance(digits, bool) or not isinstance(digits, int) or abs(digits) > 400:
        expected, found = "a small whole number of digits", kind_name(digits)
        raise RefusedError(codes.WRONG_KIND, operand=1, taker="round()", expected=expected, found=found)
    return with_dimension(round(magnitude, digits), dimension)


def _floor(value: Value) -> Value:
    magnitude, dimension = number(value, "floor()", 0)
    return with_dimension(math.floor(magnitude), dimension)


def _ceil(value: Value) -> Value:
    magnitude, dimension = number(value, "ceil()", 0)
    return with_dimension(math.ceil(magnitude), dimension)


def _sqrt(value: Value) -> Value:
    """The square root of a quantity has a dimension that no field has: a bare number."""
    radicand, _ = number(value, "sqrt()", 0)
    if radicand < 0:
        raise RefusedError(
            codes.OUTSIDE_DOMAIN, operand=0, taker="sqrt()", expected="0 or more", found=number_text(radicand)
        )
    return math.sqrt(radicand)


def _of_angle(function: Callable[[float], float], taker: str) -> Callable[[Value], Value]:
    """Make a function of an angle, or of a bare number in radians."""

    def compute(value: Value) -> Value:
        return function(_in_dimension(value, Dimension.ANGLE, taker))

    return compute


def _in_dimension(value: Value, wanted: Dimension | None, taker: str) -> Number:
    """Return the number of a bare number or of a quantity of one dimension (None: of none)."""
    magnitude, dimension = number(value, taker, 0)
    if dimension not in (None, wanted):
        expected, found = dimension_name(wanted), dimension_name(dimension)
        raise RefusedError(codes.WRONG_DIMENSION, operand=0, taker=taker, expected=expected, found=found)
    return magnitude


def _to_angle(function: Callable[[float], float], taker: str) -> Callable[[Value], Value]:
    """Make a function of a bare number from -1 to 1 that gives an angle."""

    def compute(value: Value) -> Value:
        ratio = _in_dimension(value, None, taker)
        if not -1 <= ratio <= 1:
            raise RefusedError(
                codes.OUTSIDE_DOMAIN, operand=0, taker=taker, expected="-1 to 1", found=number_text(ratio)
            )
        return Quantity(function(ratio), Dimension.ANGLE)

    return compute


def _atan2(y: Value, x: Value) -> Value:
    (rise, run), _ = _values((y, x), "atan2()")
    return Quantity(math.atan2(rise, run), Dimension.ANGLE)


def _radians(degrees: Value) -> Value:
    return Quantity(math.radians(_in_dimension(degrees, None, "radians()")), Dimension.ANGLE)


def _degrees(angle: Value) -> Value:
    return math.degrees(_in_dimension(angle, Dimension.ANGLE, "degrees()"))


def _len(value: Value) -> Value:
    if isinstance(value, str | tuple | Mapping):
        return len(value)
    expected = "a list, a map or text"
    raise RefusedError(codes.WRONG_KIND, operand=0, taker="len()", expected=expected, found=kind_name(value))


def _int(value: Value) -> Value:
    """Cut off the decimals; a quantity gives the bare number of its SI unit."""
    if not isinstance(value, str):
        return int(number(value, "int()", 0)[0])
    if _WHOLE_NUMBER.fullmatch(value):
        return int(value)
    found = kind_name(value)
    raise RefusedError(codes.WRONG_KIND, operand=0, taker="int()", expected="a number or text that is one", found=found)


def _float(value: Value) -> Value:
    """The bare number of a quantity in its SI unit, of text, of a whole number."""
    if not isinstance(value, str):
        return float(number(value, "float()", 0)[0])
    if _DECIMAL_NUMBER.fullmatch(value):
        return float(value)
    expected, found = "a number or text that is one", kind_name(value)
    raise RefusedError(codes.WRONG_KIND, operand=0, taker="float()", expected=expected, found=found)


def _str(value: Value) -> Value:
    text = as_text(value)
    if text is None:
        expected, found = "a single value", kind_name(value)
        raise RefusedError(codes.WRONG_KIND, operand=0, taker="str()", expected=expected, found=found)
    return text


FUNCTIONS: dict[str, Function] = {
    "min": Function("min(a, b, ...) or min(list)", _min, most=None),
    "max": Function("max(a, b, ...) or max(list)", _max, most=None),
    "abs": Function("abs(number)", _abs),
    "round": Function("round(number) or round(number, digits)", _round, most=2),
    "floor": Function("floor(number)", _floor),
    "ceil": Function("ceil(number)", _ceil),
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
    "int": Function("int(number)", _int),
    "float": Function("float(number)", _float),
    "str": Function("str(value)", _str),
}
"""Every function by its name."""

CONSTANTS: dict[str, Value] = {"pi": math.pi, "true": True, "false": False, "null": None}
"""The names that mean the same everywhere."""

FILE_FUNCTIONS: dict[str, FileFunction] = {
    "path": FileFunction("path(file)"),
    "link": FileFunction("link(name)"),
    "joint": FileFunction("joint(name)"),
}
"""The functions that ask the file: where a file of the disk is, and what a link or joint is called in the end."""

SIGNATURES: dict[str, Function | FileFunction] = {**FUNCTIONS, **FILE_FUNCTIONS}

RESERVED_NAMES: frozenset[str] = frozenset({*SIGNATURES, *CONSTANTS, *keyword.kwlist, "prefix", "name", "standalone"})
"""What nobody may declare as a parameter, variable, data or `for` name."""
