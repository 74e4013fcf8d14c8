"""Expressions that give the vectors of URDF, which in a xacro are texts such as `0 0 0.1`."""

from __future__ import annotations

import ast
import re

from linkforge_compile.migration.symbols import (
    MAP,
    TEXT,
    UNKNOWN,
    UNSET,
    VECTOR,
    Parts,
    Reference,
    Symbol,
    call,
    joined,
    kind_of,
    literal_of,
    refer,
)


def as_vector(node: ast.expr, count: int) -> ast.expr:
    """Return a text of numbers as a list of them; names that are one are vectors from then on."""
    if isinstance(node, Reference):
        mark_vector(node.symbol, count)
        return node
    if is_data(node) or kind_of(node) == TEXT:
        return call("split", node)
    if isinstance(node, ast.IfExp):
        sides = (node.body, node.orelse)
        if not any(isinstance(one, Reference) for side in sides for one in _alternatives(side)):
            return call("split", node)
        body, orelse = (as_vector(side, count) for side in sides)
        return ast.IfExp(test=node.test, body=body, orelse=orelse)
    return node


def _alternatives(node: ast.expr) -> list[ast.expr]:
    return [*_alternatives(node.body), *_alternatives(node.orelse)] if isinstance(node, ast.IfExp) else [node]


def is_data(node: ast.expr) -> bool:
    """Whether an expression is a part of data."""
    if not isinstance(node, ast.Attribute | ast.Subscript):
        return False
    whole = node.value
    while isinstance(whole, ast.Attribute | ast.Subscript):
        whole = whole.value
    return isinstance(whole, Reference) and whole.symbol.kind in (MAP, UNKNOWN)


def mark_vector(symbol: Symbol, count: int) -> None:
    """Note that a name is used as a vector, also for the names whose value it is."""
    if symbol.is_block or (symbol.kind == VECTOR and symbol.size == count):
        return
    symbol.kind, symbol.size = VECTOR, count
    if symbol.value and len(symbol.value) == 1 and isinstance(symbol.value[0], ast.expr):
        symbol.value = (_as_value(symbol.value[0], symbol, count),)


def _as_value(node: ast.expr, symbol: Symbol, count: int) -> ast.expr:
    """Return the value of a vector, with names for the lists among its alternatives, which expressions do not have."""
    match node:
        case ast.IfExp(test=test, body=body, orelse=orelse):
            sides = [_as_value(side, symbol, count) for side in (body, orelse)]
            return ast.IfExp(test=test, body=sides[0], orelse=sides[1])
        case ast.Constant(value=str() as text):
            choice = Symbol(f"{symbol.wish}_choice", "variable", (text,), text, VECTOR, place=symbol.place, size=count)
            return refer(choice)
    return as_vector(node, count) if literal_of(node) is UNSET else node


_BLANKS = re.compile(r"\s+")


def tokens_of(parts: Parts) -> list[Parts]:
    """Return the words of a text, each with the expressions in it."""
    words: list[Parts] = [()]
    for part in parts:
        if not isinstance(part, str):
            words[-1] = (*words[-1], part)
            continue
        first, *others = _BLANKS.split(part)
        words[-1] = joined(words[-1], (first,) if first else ())
        words += [(other,) if other else () for other in others]
    return [word for word in words if word]
