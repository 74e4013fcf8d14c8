"""Compute an expression of which all names have a value that no argument changes."""

from __future__ import annotations

import ast
import math
import operator
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
"""The largest exponent or whole number that is computed."""


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
            return _calculate(operation, _value(left), _value(right))
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


def _calculate(operation: ast.operator, left: Any, right: Any) -> Any:
    if isinstance(operation, ast.Pow) and not (abs(left) < _MOST and abs(right) < 100):
        raise _CannotComputeError
    if isinstance(operation, ast.Mult) and isinstance(left, str | list):
        raise _CannotComputeError
    return OPERATORS[type(operation)](left, right)
