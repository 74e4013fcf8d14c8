"""Text that an expression inside it makes look like a number: fields read those only where they were written whole."""

from __future__ import annotations

from collections.abc import Container
from dataclasses import replace
from typing import TYPE_CHECKING

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.modules import TEXT_NOT_NUMBER
from linkforge_compile.expressions import (
    Expression,
    Fault,
    Template,
    Value,
    as_one_expression,
    forgotten_expression,
)
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlNode, YamlScalar, has_expression, scalar_value
from linkforge_compile.units import UNITS, Quantity, parse_quantity

if TYPE_CHECKING:
    from linkforge_compile.expand.evaluate_tree import Expressions, TreeEvaluator


def tell_made_number(
    node: YamlNode, value: Value, expressions: Expressions, names: Container[str], sink: Diagnostics
) -> bool:
    """Report text that an expression inside it makes look like a number, quantity or sum of them; True where it does.

    Fields read numbers and units only where a person typed them, or where the whole is one expression. `names` are
    those that the expressions may use.
    """
    if not isinstance(node, YamlScalar) or not isinstance(value, str) or not has_expression(node.text):
        return False
    if not _looks_like_number(value, node.span):
        return False
    template = expressions.template(node, sink)
    if template is None or len(template.parts) == 1:
        return False
    sink.report(TEXT_NOT_NUMBER.at(node.span, text=value, remedy=_remedy(node, template, names)))
    return True


def tell_made_quantity(node: YamlNode, value: Value | Fault, tree: TreeEvaluator) -> bool:
    """Report text that is a quantity if the whole of it is one expression, `$(reach) / 2`; True where it is.

    It may be meant as text wherever it goes, but nobody computes with a length in one.
    """
    if not isinstance(value, str) or not isinstance(node, YamlScalar) or not has_expression(node.text):
        return False
    meant = as_one_expression(node.text, node.span, tree.scope_of(node))
    whole = YamlScalar(meant, meant, node.span) if meant else None
    if whole is None or not isinstance(replace(tree, sink=Diagnostics()).value(whole), Quantity):
        return False
    tree.sink.report(TEXT_NOT_NUMBER.at(node.span, text=value, remedy=f"write '{meant}'"))
    return True


def _remedy(node: YamlScalar, template: Template, names: Container[str]) -> str:
    if meant := as_one_expression(node.text, node.span, names):
        return f"write '{meant}'"
    match template.parts:
        case (Expression() as number, str(unit)) if unit.strip() in UNITS:
            return f"give the unit '{unit.strip()}' where the number is written, and here '$({number.text.strip()})'"
    return "make the whole one expression, such as '$(-a)'"


def _looks_like_number(text: str, where: Span) -> bool:
    number = scalar_value(text.strip())
    is_number = isinstance(number, int | float) or parse_quantity(text) is not None
    return is_number or forgotten_expression(text, where, ()) is not None
