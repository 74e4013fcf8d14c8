"""Compute an expression of which all names have a value that no argument changes."""

from __future__ import annotations

import ast
import math
from typing import Any

from linkforge_compile.migration.python_values import PythonValues, UnknownValueError
from linkforge_compile.migration.symbols import UNSET, NotConstantError, Reference, literal_of, symbols_in


def constant_of(node: ast.expr) -> object:
    """Return the value of an expression as Python computes it.

    Raises:
        NotConstantError: with the names that have no known value.

    """
    try:
        return PythonValues(_value_of_name).value(node)
    except UnknownValueError:
        raise NotConstantError(unknown_in(node)) from None


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


def _value_of_name(name: ast.Name) -> object:
    value = name.symbol.constant if isinstance(name, Reference) else literal_of(name)
    if value is not UNSET:
        return value
    if name.id == "pi" and not isinstance(name, Reference):
        return math.pi
    raise UnknownValueError
