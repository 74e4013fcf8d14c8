"""Numbers that a xacro computes of literals and pi, with the formula that a spec writes in their place."""

from __future__ import annotations

import ast
from collections.abc import Callable

from linkforge_compile.importers.spec_draft import in_degrees
from linkforge_compile.migration.constants import constant_of
from linkforge_compile.migration.symbols import NotConstantError, Part, Reference, call, constant, literal_of

_OPERATORS = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow)
_FUNCTIONS = ("sqrt", "sin", "cos", "tan", "abs")

Lookup = Callable[[str], "ast.expr | None"]


class Computed(ast.Constant):
    """A number with the formula that gives it."""

    formula: ast.expr


def with_formula(result: ast.expr, source: ast.expr, lookup: Lookup) -> ast.expr:
    """Return a result with the formula that it has in a xacro, if that has no names but `pi`; else as it is."""
    value = literal_of(result)
    if type(value) is not float or value in (0, 1, -1):
        return result
    formula = _formula(source, lookup)
    try:
        if formula is None or constant_of(formula) != value:
            return result
    except NotConstantError:
        return result
    is_computed = any(isinstance(one, ast.BinOp | ast.Call) for one in ast.walk(formula))
    return _computed(value, formula) if is_computed else result


def _formula(node: ast.expr, lookup: Lookup) -> ast.expr | None:
    match node:
        case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
            return constant(value)
        case ast.Name(id=name):
            found = lookup(name)
            is_pi = name == "pi" if found is None else isinstance(found, ast.Name) and found.id == "pi"
            return ast.Name(id="pi", ctx=ast.Load()) if is_pi and not isinstance(found, Reference) else None
        case ast.Attribute(value=ast.Name(id="math"), attr="pi"):
            return ast.Name(id="pi", ctx=ast.Load())
        case ast.UnaryOp(op=ast.USub() as sign, operand=inner):
            operand = _formula(inner, lookup)
            return operand and ast.UnaryOp(op=sign, operand=operand)
        case ast.BinOp(left=left, op=operator, right=right) if isinstance(operator, _OPERATORS):
            sides = _formula(left, lookup), _formula(right, lookup)
            return ast.BinOp(left=sides[0], op=operator, right=sides[1]) if sides[0] and sides[1] else None
        case ast.Call(
            func=ast.Name(id=name) | ast.Attribute(value=ast.Name(id="math"), attr=name), args=[inner], keywords=[]
        ):
            return _of_call(name, _formula(inner, lookup))
    return None


def _of_call(name: str, argument: ast.expr | None) -> ast.expr | None:
    if argument is None:
        return None
    if name == "radians":  # gives an angle in the language, but in a xacro a number, which may be anything
        return ast.BinOp(left=argument, op=ast.Mult(), right=_DEGREE)
    return call(name, argument) if name in _FUNCTIONS else None


_DEGREE = ast.BinOp(left=ast.Name(id="pi", ctx=ast.Load()), op=ast.Div(), right=ast.Constant(value=180))


def negative(number: Computed) -> Computed:
    """Return a number with the other sign."""
    value = literal_of(number)
    assert isinstance(value, float), "a formula gives one"
    return _computed(-value, ast.UnaryOp(op=ast.USub(), operand=number.formula))


def _computed(value: float, formula: ast.expr) -> Computed:
    made = Computed(value=value)
    made.formula = formula
    return made


def without_round_angle(part: Part, widest: float) -> Part:
    """Return an angle or its velocity without its formula if it is round in degrees, or wider than a bare number is."""
    value = literal_of(part) if isinstance(part, Computed) else None
    if isinstance(value, float) and (abs(value) > widest or in_degrees(value, "deg") is not None):
        return constant(value)
    return part
