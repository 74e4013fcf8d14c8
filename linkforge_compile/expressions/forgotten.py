"""`$( )` that was forgotten: text that would be an expression of names that are there."""

from __future__ import annotations

import ast
from collections.abc import Container

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expressions.parse import parse_template
from linkforge_compile.expressions.template import Expression
from linkforge_compile.source import Span

_OF_ONE_PIECE = (ast.Name, ast.Constant, ast.Call, ast.Subscript, ast.Attribute)
_WORDS = ("true", "false", "null")


def forgotten_expression(text: str, where: Span, names: Container[str]) -> str | None:
    """Return the expression that a text was meant for: "$(track / 2)" for "track / 2"; None for other text.

    All its names must be known. What has none must compute something: a number in quotes was meant as it is.
    """
    whole = f"$({text.strip()})"
    template = parse_template(whole, where, Diagnostics())
    match template.parts if template else ():
        case (Expression(tree=tree, names=used),) if not _is_literal(tree) and all(name.id in names for name in used):
            return whole
    return None


def as_one_expression(text: str, where: Span, names: Container[str]) -> str | None:
    """Return text around expressions as the one expression that was meant: "$(track / 2)" for "$(track) / 2".

    None where that would be none.
    """
    template = parse_template(text, where, Diagnostics())
    parts = template.parts if template else ()
    inside = "".join(part if isinstance(part, str) else _operand(part) for part in parts)
    return forgotten_expression(inside, where, names) if len(parts) > 1 else None


def _operand(expression: Expression) -> str:
    text = expression.text.strip()
    return text if isinstance(expression.tree, _OF_ONE_PIECE) else f"({text})"


def _is_literal(tree: ast.expr) -> bool:
    while isinstance(tree, ast.UnaryOp):
        tree = tree.operand
    return isinstance(tree, ast.Constant) or (isinstance(tree, ast.Name) and tree.id in _WORDS)
