"""Conditions: comparisons, negations and combinations, without the parts that are known."""

from __future__ import annotations

import ast

from linkforge_compile.migration.constants import constant_of
from linkforge_compile.migration.symbols import (
    BOOLEAN,
    NUMBER,
    TEXT,
    UNKNOWN,
    UNSET,
    CannotTranslateError,
    NotConstantError,
    Reference,
    constant,
    is_path,
    kind_of,
    literal_of,
    symbols_in,
)


def folded(node: ast.expr) -> ast.expr:
    """Return an expression of literals as its value, any other one as it is."""
    if (
        symbols_in(node)
        or literal_of(node) is not UNSET
        or any(isinstance(one, ast.expr) and is_path(one) for one in ast.walk(node))
    ):
        return node
    try:
        value = constant_of(node)
    except NotConstantError:
        return node
    return constant(value) if isinstance(value, bool | int | float | str) else node


_BOOLEANS = {"true": True, "True": True, "1": True, "false": False, "False": False, "0": False}


def compared(left: ast.expr, operation: type[ast.cmpop], right: ast.expr) -> ast.expr:
    """Return a comparison of two values; one of a boolean with a word is the boolean or its negation."""
    for side, other in ((left, right), (right, left)):
        word = literal_of(other)
        if isinstance(side, Reference) and isinstance(word, str) and operation in (ast.Eq, ast.NotEq):
            if kind_of(side) == BOOLEAN:
                return _compared_with_word(side, operation, word)
            side.symbol.choices[word] = None
        if kind_of(side) == BOOLEAN and isinstance(word, bool | int) and operation in (ast.Eq, ast.NotEq):
            return side if bool(word) is (operation is ast.Eq) else negated(side)
    return folded(ast.Compare(left=left, ops=[operation()], comparators=[right]))


def _compared_with_word(side: ast.expr, operation: type[ast.cmpop], word: str) -> ast.expr:
    if word not in _BOOLEANS:
        return constant(operation is ast.NotEq)
    return side if _BOOLEANS[word] is (operation is ast.Eq) else negated(side)


def negated(node: ast.expr) -> ast.expr:
    """Return the negation of a condition."""
    match node:
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            return operand
        case ast.Compare(left=left, ops=[ast.Eq()], comparators=others):
            return ast.Compare(left=left, ops=[ast.NotEq()], comparators=others)
        case ast.Compare(left=left, ops=[ast.NotEq()], comparators=others):
            return ast.Compare(left=left, ops=[ast.Eq()], comparators=others)
    return folded(ast.UnaryOp(op=ast.Not(), operand=node))


def combined(operation: ast.boolop, values: list[ast.expr]) -> ast.expr:
    """Return `and` or `or` of conditions, without those that are known."""
    decisive = isinstance(operation, ast.Or)
    left: list[ast.expr] = []
    for value in values:
        known = literal_of(value)
        if known is UNSET:
            left.append(value)
        elif bool(known) is decisive:
            return constant(decisive)
    if not left:
        return constant(not decisive)
    return left[0] if len(left) == 1 else ast.BoolOp(op=operation, values=left)


def as_condition(node: ast.expr, text: str = "") -> ast.expr:
    """Return a value as a condition, as xacro and Python read it.

    Raises:
        CannotTranslateError: if it is none.

    """
    literal = literal_of(node)
    if isinstance(literal, str):
        if literal in _BOOLEANS:
            return constant(_BOOLEANS[literal])
        return constant(bool(literal))
    if literal is not UNSET:
        return constant(bool(literal))
    if isinstance(node, Reference) and node.symbol.constant is None:
        return constant(False)
    kind = kind_of(node)
    if kind == UNKNOWN and isinstance(node, Reference) and node.symbol.role == "parameter":
        node.symbol.kind = kind = BOOLEAN
    if kind == NUMBER:
        return ast.Compare(left=node, ops=[ast.NotEq()], comparators=[constant(0)])
    if kind == TEXT:
        return ast.Compare(left=node, ops=[ast.NotEq()], comparators=[constant("")])
    if kind != BOOLEAN and not isinstance(node, ast.Attribute | ast.Subscript):
        raise CannotTranslateError(f"'{text}', which is not certainly true or false")
    return node
