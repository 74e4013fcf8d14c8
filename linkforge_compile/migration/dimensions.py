"""Dimensions of parameters: of the fields that they are written to, unless a computation would refuse them."""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterable

from linkforge_compile.migration.symbols import NUMBER, Part, Parts, Reference, Symbol, constant, sources_of, symbols_in

Placement = tuple[ast.expr, str]
"""An expression and the dimension of the field that it is written to, "" for another one, "number" for none."""

_SAME_DIMENSION = ("min", "max", "abs", "round", "floor", "ceil")


class _RefusedError(Exception):
    pass


def settle_dimensions(placements: Iterable[Placement]) -> None:
    """Leave each symbol the dimension with which all that is computed of it fits the fields."""
    placed = list(placements)
    for _ in range(len(placed) + 1):
        refused = next((node for node, field in placed if not _fits(node, field)), None)
        if refused is None:
            return
        for symbol in symbols_in(refused):
            symbol.dimensions = {"number"}


def _fits(node: ast.expr, field: str) -> bool:
    try:
        dimension = _dimension(node)
    except _RefusedError:
        return False
    return dimension in ("", field)


def without_angles(parts: Parts) -> Parts:
    """Return a text in which numbers stand for the angles that `radians()` gives, also in the variables that it names.

    In a xacro these are numbers, which may be anything, such as the velocity `${radians(180)}`.
    """
    if not any(isinstance(part, ast.AST) and _has_angles(part) for part in parts):
        return parts
    return tuple(_plain(part) for part in parts)


def _has_angles(node: ast.AST) -> bool:
    values = (part for symbol in sources_of(symbols_in(node)) for part in symbol.value or ())
    nodes = [node, *(part for part in values if isinstance(part, ast.AST))]
    return any(_is_angle(one) for part in nodes for one in ast.walk(part))


def _is_angle(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "radians"


def _plain(part: Part) -> Part:
    if isinstance(part, str):
        return part
    node = _WithoutAngles().visit(copy.deepcopy(part))
    assert isinstance(node, ast.expr), "an expression is replaced by one"
    return node


class _WithoutAngles(ast.NodeTransformer):
    def visit_Call(self, found: ast.Call) -> ast.AST:
        self.generic_visit(found)
        if not _is_angle(found):
            return found
        product = ast.BinOp(left=found.args[0], op=ast.Mult(), right=ast.Name(id="pi", ctx=ast.Load()))
        return ast.BinOp(left=product, op=ast.Div(), right=constant(180))

    def visit_Reference(self, found: Reference) -> ast.AST:
        symbol = found.symbol
        if (
            symbol.role == "variable"
            and symbol.value
            and any(_has_angles(part) for part in symbol.value if isinstance(part, ast.AST))
        ):
            symbol.value = tuple(_plain(part) for part in symbol.value)
        return found


def _of(symbol: Symbol) -> str:
    if symbol.role == "parameter":
        found = symbol.dimensions - {"number"} if symbol.kind == NUMBER and len(symbol.dimensions) == 1 else set()
        return next(iter(found), "")
    if symbol.role == "variable" and symbol.value and len(symbol.value) == 1 and isinstance(symbol.value[0], ast.expr):
        return _dimension(symbol.value[0])
    return ""


def _dimension(node: ast.expr) -> str:
    """Return the dimension of an expression, "" for a bare number."""
    match node:
        case Reference(symbol=symbol):
            return _of(symbol)
        case ast.UnaryOp(op=ast.USub() | ast.UAdd(), operand=operand):
            return _dimension(operand)
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub() | ast.Mod(), right=right):
            return _shared(_dimension(left), _dimension(right))
        case ast.BinOp(left=left, op=ast.Mult(), right=right):
            one, other = _dimension(left), _dimension(right)
            return "" if one and other else one or other
        case ast.BinOp(left=left, op=ast.Div() | ast.FloorDiv(), right=right):
            return "" if _dimension(right) else _dimension(left)
        case ast.BinOp(left=left, right=right):
            if _dimension(left) or _dimension(right):
                raise _RefusedError
            return ""
        case ast.IfExp(body=body, orelse=orelse):
            return _shared(_dimension(body), _dimension(orelse))
        case ast.Call(func=ast.Name(id=name), args=arguments):
            found = [_dimension(argument) for argument in arguments]
            if name in _SAME_DIMENSION:
                return _shared(*found)
            if any(found) and name in ("sin", "cos", "tan", "asin", "acos", "degrees", "radians"):
                raise _RefusedError
    return ""


def _shared(*dimensions: str) -> str:
    found = set(dimensions) - {""}
    if len(found) > 1:
        raise _RefusedError
    return next(iter(found), "")
