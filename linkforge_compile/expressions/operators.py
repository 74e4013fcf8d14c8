"""What the operators do, to numbers and to quantities: the rules of dimensions in one place."""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from linkforge_compile.diagnostics.codes import expressions as codes
from linkforge_compile.diagnostics.suggest import did_you_mean
from linkforge_compile.expressions.types import (
    RefusedError,
    Value,
    dimension_name,
    joined,
    kind_name,
    seen_from_compiled,
)
from linkforge_compile.syntax.scalars import TRUTHS_OF_YAML_1_1
from linkforge_compile.units import UNITS, Dimension, Quantity, parse_quantity, unit_meant, unit_text

Number: TypeAlias = int | float

MAX_INTEGER_BITS = 1023
"""Whole numbers may be as large as a double, so that each can become one."""

MAX_TEXT = 65_536
"""How many characters an expression may put together."""


def number(value: Value, taker: str, operand: int | None = None) -> tuple[Number, Dimension | None]:
    """Return the number in SI units and its dimension; refuse what is no number, true and false included."""
    if isinstance(value, Quantity):
        return value.value, value.dimension
    if isinstance(value, bool) or not isinstance(value, int | float):
        found = kind_name(value) + _unit_hint(value)
        raise RefusedError(codes.WRONG_KIND, operand=operand, taker=taker, expected="a number", found=found)
    return value, None


def _unit_hint(value: Value) -> str:
    """Return what is wrong with the unit of what was meant as a quantity; "" for any other value."""
    unit = unit_text(value) if isinstance(value, str) else None
    if unit is None or not isinstance(value, str) or parse_quantity(value):
        return ""
    meant = unit_meant(unit)
    hint = f"; did you mean '{meant.name}'?" if meant else did_you_mean(unit, UNITS)
    return f"; there is no unit '{unit}'{hint}"


def with_dimension(value: Number, dimension: Dimension | None) -> Value:
    return value if dimension is None else Quantity(float(value), dimension)


def shared_dimension(dimensions: Sequence[Dimension | None], taker: str) -> Dimension | None:
    """Return the one dimension of all; a bare number takes that of its neighbours, two different ones are refused."""
    found = list(dict.fromkeys(dimension for dimension in dimensions if dimension is not None))
    if len(found) > 1:
        left, right = map(dimension_name, found[:2])
        raise RefusedError(codes.DIMENSIONS_DIFFER, taker=taker, left=left, right=right)
    return found[0] if found else None


def is_too_long(text: str) -> bool:
    """Whether a text is more than an expression may put together, as its file writes it or as the compiled one."""
    return max(len(text), len(seen_from_compiled(text))) > MAX_TEXT


def bounded(compute: Callable[[], Value], taker: str) -> Value:
    """Return a result unless it goes beyond what a double, or our patience with digits and text, can hold."""
    try:
        value = compute()
    except (OverflowError, ValueError):  # so Python says for the sine of infinity, and of what has no whole number
        raise RefusedError(codes.RESULT_TOO_LARGE, taker=taker) from None
    match value.value if isinstance(value, Quantity) else value:
        case float() as size if not math.isfinite(size):
            raise RefusedError(codes.RESULT_TOO_LARGE, taker=taker)
        case int() as size if size.bit_length() > MAX_INTEGER_BITS:
            raise RefusedError(codes.RESULT_TOO_LARGE, taker=taker)
        case str() as text if is_too_long(text):
            raise RefusedError(codes.TEXT_TOO_LONG, limit=f"{MAX_TEXT:,}")
    return value


def _shared(left: Dimension | None, right: Dimension | None, taker: str) -> Dimension | None:
    return shared_dimension((left, right), taker)


def _product(left: Dimension | None, right: Dimension | None, _taker: str) -> Dimension | None:
    return (left or right) if left is None or right is None else None


def _quotient(left: Dimension | None, right: Dimension | None, _taker: str) -> Dimension | None:
    return left if right is None else None


def _power(_left: Dimension | None, right: Dimension | None, taker: str) -> None:
    """A power is a product, so it forgets its dimension; an exponent that has one means nothing."""
    if right is not None:
        found = dimension_name(right)
        raise RefusedError(codes.WRONG_DIMENSION, operand=1, taker=taker, expected="a bare exponent", found=found)


def _raised(base: Number, exponent: Number) -> Number:
    if isinstance(base, int) and isinstance(exponent, int) and _is_beyond_reach(base, exponent):
        raise OverflowError
    result = base**exponent
    if isinstance(result, complex):
        raise RefusedError(codes.OUTSIDE_DOMAIN, operand=0, taker="'**'", expected="a base of 0 or more", found=base)
    return result


def _is_beyond_reach(base: int, exponent: int) -> bool:
    """Judged beforehand: the digits of 9**9**9 would fill the memory."""
    return abs(base) > 1 and base.bit_length() * exponent > 2 * MAX_INTEGER_BITS


@dataclass(frozen=True)
class Arithmetic:
    """An operator on two numbers, and the dimension of its result."""

    symbol: str
    compute: Callable[[Number, Number], Number]
    dimension: Callable[[Dimension | None, Dimension | None, str], Dimension | None]

    def __call__(self, left: Value, right: Value) -> Value:
        taker = f"'{self.symbol}'"
        return bounded(lambda: self._result(left, right, taker), taker)

    def _result(self, left: Value, right: Value, taker: str) -> Value:
        if self.symbol == "+" and isinstance(left, str) and isinstance(right, str):
            return joined(left, right)
        (a, left_dimension), (b, right_dimension) = number(left, taker, 0), number(right, taker, 1)
        dimension = self.dimension(left_dimension, right_dimension, taker)
        try:
            return with_dimension(self.compute(a, b), dimension)
        except ZeroDivisionError:
            raise RefusedError(codes.DIVISION_BY_ZERO, operand=1, taker=taker) from None


ARITHMETIC: dict[type[ast.operator], Arithmetic] = {
    ast.Add: Arithmetic("+", operator.add, _shared),
    ast.Sub: Arithmetic("-", operator.sub, _shared),
    ast.Mod: Arithmetic("%", operator.mod, _shared),
    ast.Mult: Arithmetic("*", operator.mul, _product),
    ast.Div: Arithmetic("/", operator.truediv, _quotient),
    ast.FloorDiv: Arithmetic("//", operator.floordiv, _quotient),
    ast.Pow: Arithmetic("**", _raised, _power),
}
"""The operators between two numbers; `+` joins two texts as well."""


def signed(sign: ast.unaryop, value: Value) -> Value:
    """Return a number or quantity with its sign kept or turned."""
    magnitude, dimension = number(value, "'-'" if isinstance(sign, ast.USub) else "'+'", 0)
    return with_dimension(-magnitude if isinstance(sign, ast.USub) else magnitude, dimension)


def truth(value: Value, taker: str, operand: int | None = None) -> bool:
    """Return a boolean; refuse what only Python would take for one, such as the text 'false'."""
    if isinstance(value, bool):
        return value
    if isinstance(value, str) and (meant := TRUTHS_OF_YAML_1_1.get(value.lower())):
        raise RefusedError(codes.TRUTH_AS_TEXT, operand=operand, name=value, meant=meant)
    expected = "true or false"
    raise RefusedError(codes.WRONG_KIND, operand=operand, taker=taker, expected=expected, found=kind_name(value))
