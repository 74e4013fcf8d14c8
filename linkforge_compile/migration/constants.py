"""Compute an expression of which all names have a value that no argument changes."""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Mapping
from typing import Any

from linkforge_compile.migration.symbols import UNSET, NotConstantError, Reference, literal_of, symbols_in

OPERATORS: Mapping[type[ast.AST], Callable[..., Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Pow: operator.pow,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
    ast.Not: operator.not_,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.In: lambda item, items: item in items,
    ast.NotIn: lambda item, items: item not in items,
}
FUNCTIONS: Mapping[str, Callable[..., Any]] = {
    **{name: getattr(math, name) for name in ("sqrt", "sin", "cos", "tan", "asin", "acos", "atan2", "floor", "ceil")},
    **{"radians": math.radians, "degrees": math.degrees, "min": min, "max": max, "abs": abs, "round": round},
    **{"len": len, "int": int, "float": float, "str": str},
}
_NAMES = {"pi": math.pi}
_MOST = 1e12
"""The largest base of a power."""

_MOST_BITS = 4096
"""The longest whole numbers together that are computed with."""

MOST_ITEMS = 100_000
"""The longest text or list that is made."""

_WIDTH = re.compile(r"%[^a-zA-Z%]*(?:\d{4}|\*)")
"""A `%` that makes a text as long as a number in it says."""


class _CannotComputeError(Exception):
    pass


def constant_of(node: ast.expr) -> object:
    """Return the value of an expression as Python computes it.

    Raises:
        NotConstantError: with the names that have no known value.

    """
    try:
        return _value(node)
    except _CannotComputeError:
        raise NotConstantError(unknown_in(node)) from None
    except (ArithmeticError, TypeError, ValueError, LookupError, AttributeError):
        raise NotConstantError(frozenset()) from None


def example_of(node: ast.expr) -> object:
    """Return what a part of data is for the given arguments; UNSET where that is not known."""
    match node:
        case Reference(symbol=symbol) if symbol.constant is not UNSET:
            return symbol.constant
        case Reference(symbol=symbol) if symbol.role == "variable" and symbol.value and len(symbol.value) == 1:
            value = symbol.value[0]
            return example_of(value) if isinstance(value, ast.expr) else UNSET
        case Reference(symbol=symbol):
            return symbol.example
        case ast.Attribute(value=whole, attr=key):
            return _item(example_of(whole), key)
        case ast.Subscript(value=whole, slice=index):
            return _item(example_of(whole), literal_of(index))
    return UNSET


def _item(whole: Any, key: Any) -> object:
    try:
        return whole[key] if isinstance(whole, dict | list) else UNSET
    except (LookupError, TypeError):
        return UNSET


def unknown_in(node: ast.expr) -> frozenset[Any]:
    """Return the symbols of an expression that have no known value."""
    return frozenset(symbol for symbol in symbols_in(node) if symbol.constant is UNSET)


def _value(node: ast.expr) -> Any:
    literal = literal_of(node)
    if literal is not UNSET:
        return literal
    match node:
        case Reference(symbol=symbol) if symbol.constant is not UNSET:
            return symbol.constant
        case ast.Name(id=name) if name in _NAMES and not isinstance(node, Reference):
            return _NAMES[name]
        case ast.Call(func=ast.Name(id=name), args=arguments) if name in FUNCTIONS:
            return FUNCTIONS[name](*map(_value, arguments))
        case ast.Subscript(value=whole, slice=index):
            return _value(whole)[_value(index)]
        case ast.Attribute(value=whole, attr=key):
            held = _value(whole)
            if isinstance(held, Mapping):
                return held[key]
    return _operation(node)


def _operation(node: ast.expr) -> Any:
    match node:
        case ast.UnaryOp(op=operation, operand=operand):
            return OPERATORS[type(operation)](_value(operand))
        case ast.BinOp(left=left, op=operation, right=right):
            return calculate(operation, _value(left), _value(right))
        case ast.BoolOp(op=ast.And(), values=values):
            return all(_value(value) for value in values)
        case ast.BoolOp(values=values):
            return any(_value(value) for value in values)
        case ast.Compare(left=left, ops=operations, comparators=others):
            sides = [_value(left), *map(_value, others)]
            pairs = zip(sides, operations, sides[1:], strict=False)
            return all(OPERATORS[type(operation)](one, other) for one, operation, other in pairs)
        case ast.IfExp(test=test, body=body, orelse=orelse):
            return _value(body if _value(test) else orelse)
    raise _CannotComputeError


def calculate(operation: ast.operator, left: Any, right: Any) -> Any:
    """Return the result of an operation of Python.

    Raises:
        ArithmeticError: for a number or a text that is longer than any robot needs, before it is made.

    """
    sequences = [one for one in (left, right) if isinstance(one, str | list | tuple)]
    numbers = [one for one in (left, right) if isinstance(one, int)]
    checks: dict[type[ast.operator], Callable[[], bool]] = {
        ast.Pow: lambda: not (abs(left) < _MOST and abs(right) < 100),
        ast.Mult: lambda: bool(sequences),
        ast.Add: lambda: sum(map(len, sequences)) > MOST_ITEMS,
        ast.Mod: lambda: isinstance(left, str) and _WIDTH.search(left) is not None,
    }
    is_huge = checks.get(type(operation), lambda: False)()
    if is_huge or sum(one.bit_length() for one in numbers) > _MOST_BITS:
        raise OverflowError
    return OPERATORS[type(operation)](left, right)
