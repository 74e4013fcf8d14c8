"""Operators of expressions: arithmetic with dimensions, comparisons, and access to items and fields.

An operation raises a RefusedError for operands that it does not accept.
"""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any, TypeAlias

from linkforge_compile.diagnostics.codes import expressions as codes
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.expressions.types import (
    RefusedError,
    Value,
    dimension_name,
    joined,
    kind_name,
    seen_from_compiled,
)
from linkforge_compile.syntax.nodes import YAML_1_1_BOOLEANS
from linkforge_compile.units import UNITS, Dimension, Quantity, parse_quantity, suggested_unit, unit_text

Number: TypeAlias = int | float

_Predicate: TypeAlias = Callable[[Any, Any], bool]
"""A comparison of the operator module, whose types are no narrower."""

_DimensionOf: TypeAlias = Callable[[Dimension | None, Dimension | None], Dimension | None]
"""Gives the dimension of a result by those of the operands."""

MAX_INTEGER_BITS = 1023
"""Integers may be as large as a double, so that each can be converted to one."""

MAX_TEXT = 65_536
"""The longest text that an expression may make, in characters."""


@dataclass(frozen=True)
class Operation:
    """An operator or a function: its name in messages and what it computes.

    A function has a signature and accepts `least` to `most` arguments (None: any number).
    """

    name: str
    compute: Callable[..., Value]
    signature: str = ""
    least: int = 1
    most: int | None = 1

    def __call__(self, *values: Value) -> Value:
        """Compute the value; reject a number beyond a double and a text beyond MAX_TEXT."""
        try:
            value = self.compute(*values)
        except ZeroDivisionError:
            raise RefusedError(codes.DIVISION_BY_ZERO, operand=1, operation=self.name) from None
        except (OverflowError, ValueError):  # ValueError: the sine of infinity, the integer of nan
            raise RefusedError(codes.RESULT_TOO_LARGE, operation=self.name) from None
        except RefusedError as refused:
            refused.facts.setdefault("operation", self.name)
            raise
        match value.value if isinstance(value, Quantity) else value:
            case float() as size if not math.isfinite(size):
                raise RefusedError(codes.RESULT_TOO_LARGE, operation=self.name)
            case int() as size if size.bit_length() > MAX_INTEGER_BITS:
                raise RefusedError(codes.RESULT_TOO_LARGE, operation=self.name)
            case str() as text if is_too_long(text):
                raise RefusedError(codes.TEXT_TOO_LONG, limit=f"{MAX_TEXT:,}")
        return value

    def accepts(self, count: int) -> bool:
        """Whether the function may be called with this many arguments."""
        return count >= self.least and (self.most is None or count <= self.most)


def wrong_kind(expected: str, value: Value, operand: int | None = None, **facts: str) -> RefusedError:
    """Return the error for an operand of the wrong kind."""
    return RefusedError(codes.WRONG_KIND, operand=operand, expected=expected, found=kind_name(value), **facts)


# Numbers and dimensions


def number(value: Value, operand: int = 0, **facts: str) -> tuple[Number, Dimension | None]:
    """Return the number in SI units and its dimension; reject anything else, booleans included."""
    if isinstance(value, Quantity):
        return value.value, value.dimension
    if isinstance(value, bool) or not isinstance(value, int | float):
        hint, unit, intended = _unknown_unit(value)
        facts |= {"expected": "a number", "found": kind_name(value) + hint, "written": unit, "instead": intended}
        raise RefusedError(codes.WRONG_KIND, operand=operand, **facts)
    return value, None


def _unknown_unit(value: Value) -> tuple[str, str, str]:
    """Return what is wrong with the unit in a text such as "3 inchs", the unit and the intended one; "" for none."""
    unit = unit_text(value) if isinstance(value, str) else None
    if unit is None or not isinstance(value, str) or parse_quantity(value):
        return "", "", ""
    known = suggested_unit(unit)
    intended = known.name if known else nearest(unit, UNITS) or ""
    hint = f"; did you mean '{intended}'?" if intended else ""
    return f"; there is no unit '{unit}'{hint}", unit, intended


def with_dimension(value: Number, dimension: Dimension | None) -> Value:
    """Return a quantity, or the bare number where there is no dimension."""
    return value if dimension is None else Quantity(float(value), dimension)


def shared_dimension(*dimensions: Dimension | None) -> Dimension | None:
    """Return the common dimension; bare numbers (None) adopt it, two different dimensions are rejected."""
    found = list(dict.fromkeys(dimension for dimension in dimensions if dimension is not None))
    if len(found) > 1:
        left, right = map(dimension_name, found[:2])
        raise RefusedError(codes.DIMENSIONS_DIFFER, left=left, right=right)
    return found[0] if found else None


def is_too_long(text: str) -> bool:
    """Whether a text exceeds MAX_TEXT, relative to its own file or to the compiled one."""
    return max(len(text), len(seen_from_compiled(text))) > MAX_TEXT


# Arithmetic


def _calculate(
    compute: Callable[[Number, Number], Number], dimension_of: _DimensionOf, left: Value, right: Value
) -> Value:
    (a, left_dimension), (b, right_dimension) = number(left), number(right, 1)
    dimension = dimension_of(left_dimension, right_dimension)
    return with_dimension(compute(a, b), dimension)


def _add(left: Value, right: Value) -> Value:
    if isinstance(left, str) and isinstance(right, str):
        return joined(left, right)
    return _calculate(operator.add, shared_dimension, left, right)


def _product(left: Dimension | None, right: Dimension | None) -> Dimension | None:
    return (left or right) if left is None or right is None else None


def _quotient(left: Dimension | None, right: Dimension | None) -> Dimension | None:
    return left if right is None else None


def _power_dimension(_left: Dimension | None, right: Dimension | None) -> None:
    """Drop the dimension, as a product does; reject an exponent that has one."""
    if right is not None:
        raise RefusedError(codes.WRONG_DIMENSION, operand=1, expected="a bare exponent", found=dimension_name(right))


def _power(base: Number, exponent: Number) -> Number:
    # Computing the digits of 9**9**9 would fill the memory, so the size is estimated first.
    is_whole = isinstance(base, int) and isinstance(exponent, int)
    if is_whole and abs(base) > 1 and int(base).bit_length() * exponent > 2 * MAX_INTEGER_BITS:
        raise OverflowError
    result = base**exponent
    if isinstance(result, complex):
        raise RefusedError(codes.OUTSIDE_DOMAIN, operand=0, expected="a base of 0 or more", found=base)
    return result


ARITHMETIC = {
    ast.Add: Operation("'+'", _add),
    ast.Sub: Operation("'-'", partial(_calculate, operator.sub, shared_dimension)),
    ast.Mod: Operation("'%'", partial(_calculate, operator.mod, shared_dimension)),
    ast.Mult: Operation("'*'", partial(_calculate, operator.mul, _product)),
    ast.Div: Operation("'/'", partial(_calculate, operator.truediv, _quotient)),
    ast.FloorDiv: Operation("'//'", partial(_calculate, operator.floordiv, _quotient)),
    ast.Pow: Operation("'**'", partial(_calculate, _power, _power_dimension)),
}
"""The operators between two numbers; `+` also joins two texts."""


def signed(sign: ast.unaryop, value: Value) -> Value:
    """Return a number or quantity with a sign `+` or `-` applied, infinite if it was."""
    is_minus = isinstance(sign, ast.USub)
    magnitude, dimension = number(value, operation="'-'" if is_minus else "'+'")
    return with_dimension(-magnitude if is_minus else magnitude, dimension)


def truth(value: Value) -> bool:
    """Return a boolean; reject other values, such as the text 'false', which is true in Python."""
    if isinstance(value, bool):
        return value
    if isinstance(value, str) and (intended := YAML_1_1_BOOLEANS.get(value.lower())):
        raise RefusedError(codes.TRUTH_AS_TEXT, name=value, expected=intended)
    raise wrong_kind("true or false", value)


# Comparisons


def _is_number(value: Value) -> bool:
    return isinstance(value, int | float | Quantity) and not isinstance(value, bool)


def _compare_numbers(predicate: _Predicate, left: Value, right: Value) -> bool:
    (a, left_dimension), (b, right_dimension) = number(left), number(right, 1)
    shared_dimension(left_dimension, right_dimension)
    return predicate(a, b)


def _compare_equality(predicate: _Predicate, left: Value, right: Value) -> bool:
    """Test equality; reject different kinds, because `simulated == "true"` is never true."""
    if left is None or right is None:
        return predicate(left is None, right is None)
    if _is_number(left) and _is_number(right):
        return _compare_numbers(predicate, left, right)
    for operand, value in enumerate((left, right)):
        if isinstance(value, tuple | Mapping):
            raise wrong_kind("single values", value, operand)
    # A PathText is text as well.
    left_kind, right_kind = (str if isinstance(value, str) else type(value) for value in (left, right))
    if left_kind is not right_kind:
        raise RefusedError(codes.KINDS_DIFFER, left=kind_name(left), right=kind_name(right))
    return predicate(left, right)


def _compare_order(predicate: _Predicate, left: Value, right: Value) -> bool:
    if isinstance(left, str) and isinstance(right, str):
        return predicate(left, right)
    return _compare_numbers(predicate, left, right)


def _is_in(item: Value, whole: Value) -> bool:
    """Search a list for an item, a map for a key, a text for a part; an item of another kind is absent."""
    match whole:
        case tuple():
            return any(_is_equal(item, one) for one in whole)
        case Mapping():
            return key_text(item) in whole
        case str() if isinstance(item, str):
            return item in whole
    raise wrong_kind("a list or a map on its right", whole, operand=1)


def _is_equal(left: Value, right: Value) -> bool:
    try:
        return _compare_equality(operator.eq, left, right)
    except RefusedError:
        return False


COMPARISONS = {
    ast.Eq: Operation("'=='", partial(_compare_equality, operator.eq)),
    ast.NotEq: Operation("'!='", partial(_compare_equality, operator.ne)),
    ast.Lt: Operation("'<'", partial(_compare_order, operator.lt)),
    ast.LtE: Operation("'<='", partial(_compare_order, operator.le)),
    ast.Gt: Operation("'>'", partial(_compare_order, operator.gt)),
    ast.GtE: Operation("'>='", partial(_compare_order, operator.ge)),
    ast.In: Operation("'in'", _is_in),
    ast.NotIn: Operation("'not in'", lambda item, whole: not _is_in(item, whole)),
}
"""The operators that give true or false; a chain such as `0 < x < 1` compares each two neighbours."""


# Items and fields

AXES = {"x": 0, "y": 1, "z": 2}
"""The index of each field of a vector."""


def item(whole: Value, index: Value) -> Value:
    """Return `list[index]`, negative indexes from the end, or `map[key]`."""
    match whole:
        case tuple():
            if isinstance(index, bool) or not isinstance(index, int):
                raise wrong_kind("a whole number in its brackets", index, operand=1, operation="a list")
            if not -len(whole) <= index < len(whole):
                raise RefusedError(codes.NO_SUCH_ITEM, operand=1, index=index, length=len(whole))
            return whole[index]
        case Mapping():
            key = key_text(index)
            if key is None:
                raise wrong_kind("a key", index, operand=1, operation="a map")
            return _entry(whole, key)
    raise wrong_kind("a list or a map before it", whole, operand=0, operation="'[...]'")


def key_text(index: Value) -> str | None:
    """Return the key that a value names, None where it names none; the integer 1 names the key `1`."""
    if isinstance(index, bool) or not isinstance(index, str | int):
        return None
    return str(index)


def field(whole: Value, key: str) -> Value:
    """Return `map.key`, or `vector.x`, `.y` or `.z`."""
    if isinstance(whole, Mapping):
        return _entry(whole, key)
    if isinstance(whole, tuple) and len(whole) == 3 and key in AXES:
        return whole[AXES[key]]
    raise wrong_kind("a map or a vector's x, y, z", whole, operation=f"'.{key}'")


def _entry(whole: Mapping[str, Value], key: str) -> Value:
    if key not in whole:
        raise RefusedError(codes.UNKNOWN_KEY, operand=1, near=whole, name=key)
    return whole[key]
