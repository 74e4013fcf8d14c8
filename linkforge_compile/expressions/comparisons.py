"""How values compare: numbers with numbers, text with text, and anything with null."""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from linkforge_compile.diagnostics.codes import expressions as codes
from linkforge_compile.expressions.access import key_text
from linkforge_compile.expressions.operators import number, shared_dimension
from linkforge_compile.expressions.types import RefusedError, Value, kind_name
from linkforge_compile.units import Quantity

Predicate = Callable[[Any, Any], bool]  # of the operator module, which is typed no closer


@dataclass(frozen=True)
class Comparison:
    """An operator between two values that gives true or false."""

    symbol: str
    compare: Callable[[Value, Value, str, Predicate], bool]
    predicate: Predicate

    def __call__(self, left: Value, right: Value) -> bool:
        return self.compare(left, right, f"'{self.symbol}'", self.predicate)


def _is_number(value: Value) -> bool:
    return isinstance(value, int | float | Quantity) and not isinstance(value, bool)


def _numbers(left: Value, right: Value, taker: str, predicate: Predicate) -> bool:
    (a, left_dimension), (b, right_dimension) = number(left, taker, 0), number(right, taker, 1)
    shared_dimension((left_dimension, right_dimension), taker)
    return predicate(a, b)


def _equality(left: Value, right: Value, taker: str, predicate: Predicate) -> bool:
    """Compare for being equal; different kinds are refused, since `simulated == "true"` would never be true."""
    if left is None or right is None:
        return predicate(left is None, right is None)
    if _is_number(left) and _is_number(right):
        return _numbers(left, right, taker, predicate)
    for operand, value in enumerate((left, right)):
        if isinstance(value, tuple | Mapping):
            found = kind_name(value)
            raise RefusedError(codes.WRONG_KIND, operand=operand, taker=taker, expected="single values", found=found)
    if _kind(left) is not _kind(right):
        raise RefusedError(codes.KINDS_DIFFER, taker=taker, left=kind_name(left), right=kind_name(right))
    return predicate(left, right)


def _kind(value: Value) -> type:
    """Return the type of a value; paths are text."""
    return str if isinstance(value, str) else type(value)


def _order(left: Value, right: Value, taker: str, predicate: Predicate) -> bool:
    if isinstance(left, str) and isinstance(right, str):
        return predicate(left, right)
    return _numbers(left, right, taker, predicate)


def _membership(item: Value, whole: Value, taker: str, predicate: Predicate) -> bool:
    """Look for an item in a list, a key in a map, a part in text; an item of another kind is not there."""
    match whole:
        case tuple():
            return predicate(any(_is_same(item, one) for one in whole), True)
        case Mapping():
            return predicate(key_text(item) in whole, True)
        case str() if isinstance(item, str):
            return predicate(item in whole, True)
    expected = "a list or a map on its right"
    raise RefusedError(codes.WRONG_KIND, operand=1, taker=taker, expected=expected, found=kind_name(whole))


def _is_same(left: Value, right: Value) -> bool:
    try:
        return _equality(left, right, "'in'", operator.eq)
    except RefusedError:
        return False


COMPARISONS: dict[type[ast.cmpop], Comparison] = {
    ast.Eq: Comparison("==", _equality, operator.eq),
    ast.NotEq: Comparison("!=", _equality, operator.ne),
    ast.Lt: Comparison("<", _order, operator.lt),
    ast.LtE: Comparison("<=", _order, operator.le),
    ast.Gt: Comparison(">", _order, operator.gt),
    ast.GtE: Comparison(">=", _order, operator.ge),
    ast.In: Comparison("in", _membership, operator.is_),
    ast.NotIn: Comparison("not in", _membership, operator.is_not),
}
"""The operators that give true or false; a chain such as `0 < x < 1` is one between each two."""
