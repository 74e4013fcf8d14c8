"""Report a name that an expression cannot use, with what was probably intended."""

from __future__ import annotations

import ast

from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes import expressions as codes
from linkforge_compile.diagnostics.fix import Fix, Replacement
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.expressions.functions import CONSTANTS
from linkforge_compile.expressions.types import Expression, Scope
from linkforge_compile.units import UNITS

_PYTHON_MODULES = ("math", "numpy", "np")
"""Modules that Python programs use pi and sin from."""


def unknown_name(name: ast.Name, expression: Expression, scope: Scope) -> Diagnostic:
    """Return the error for a name that is not in scope."""
    if name.id in _PYTHON_MODULES:
        instead = "write constants and functions without a module: pi"
        fault = codes.NOT_IN_EXPRESSIONS.at(expression.span(name), use=f"contain '{name.id}'", instead=instead)
        return fault.with_fix(_without_module(name, expression))
    near = [*scope, *CONSTANTS]
    if name.id in UNITS and (amount := _amount(name, expression)):
        hint = f"; '{name.id}' is a unit: declare '{amount} {name.id}' in 'variables'"
        return codes.UNKNOWN_NAME.at(expression.span(name), name=name.id, hint=hint)
    # Users often intend text on one side of a comparison.
    comparisons = (node for node in ast.walk(expression.tree) if isinstance(node, ast.Compare))
    is_compared = any(name is side for node in comparisons for side in (node.left, *node.comparators))
    is_text = is_compared and nearest(name.id, near) is None
    hint = f"; write text in quotes: '{name.id}'" if is_text else ""
    fault = codes.UNKNOWN_NAME.at(expression.span(name), name=name.id, hint=hint, near=near)
    before = fault.span.file.line(fault.span.line)[: fault.span.column - 1] if fault.span else ""
    # In single quotes of YAML, others would end the text.
    return fault.replacing(name.id, f"'{name.id}'") if is_text and "'" not in before else fault


def _amount(unit: ast.Name, expression: Expression) -> str:
    """Return the number that is multiplied with the name of a unit, as it is written; "" for none."""
    for node in ast.walk(expression.tree):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult) and unit in (node.left, node.right):
            other = node.left if node.right is unit else node.right
            if isinstance(other, ast.Constant) and isinstance(other.value, int | float):
                return expression.written(other)
    return ""


def _without_module(module: ast.Name, expression: Expression) -> Fix | None:
    """Return the fix that writes a constant without its module; None for what is no constant of ours."""
    for node in ast.walk(expression.tree):
        if isinstance(node, ast.Attribute) and node.value is module and node.attr in CONSTANTS:
            return Replacement("", node.attr, is_safe=True).within(expression.span(node))
    return None
