"""From a template and the names in scope to a value: one `match` over the parts of the grammar that we have."""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from functools import partial
from typing import TypeAlias, TypeVar

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes import expressions as codes
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.expressions.access import field, item
from linkforge_compile.expressions.comparisons import COMPARISONS
from linkforge_compile.expressions.functions import CONSTANTS, FILE_FUNCTIONS, FUNCTIONS
from linkforge_compile.expressions.in_xml import values_in_xml
from linkforge_compile.expressions.operators import ARITHMETIC, MAX_TEXT, is_too_long, signed, truth
from linkforge_compile.expressions.scope import Scope
from linkforge_compile.expressions.template import Expression, Template
from linkforge_compile.expressions.types import FAULT, Fault, RefusedError, Value, as_text, joined, kind_name
from linkforge_compile.limits import Limit
from linkforge_compile.source import Span
from linkforge_compile.units import WIDEST_ANGLE

T = TypeVar("T")

Trace: TypeAlias = Callable[[str, Span], Span]
"""Makes the place of a part of an expression, of which it is given the text, one that can tell of its value."""


def _untraced(_expression: str, where: Span) -> Span:
    return where


_TAKE_AN_ANGLE = ("sin", "cos", "tan")

_CHARACTERS_A_STEP = 4
"""How long the text of an expression is for each step that computing it takes, roughly."""

_STEPS_OF_A_FAULT = 50
"""What it takes to tell of an expression that it has no value, where a `for` makes it fail each time."""


def evaluate(
    template: Template, scope: Scope, sink: Diagnostics, *, is_xml: bool = False, trace: Trace = _untraced
) -> Value | Fault:
    """Return the value of the expression that is the whole text, else the text with the values of its expressions.

    In a text that is XML, the values of those around which there is more are text of it and no markup. FAULT where
    one is at fault, which is reported, or uses a name that is FAULT, which was reported. `trace` makes the place of
    a part of an expression one that can tell where its value comes from.
    """
    match template.parts:
        case (Expression() as whole,):
            return _Evaluation(whole, scope, sink, trace).result()
    found = [part if isinstance(part, str) else _Evaluation(part, scope, sink, trace).text() for part in template.parts]
    texts = [text for text in found if text is not None]
    if len(texts) < len(found):
        return FAULT
    if is_xml:
        texts = list(values_in_xml(zip(texts, (isinstance(part, Expression) for part in template.parts), strict=True)))
    text = joined(*texts)
    if is_too_long(text):
        sink.report(codes.TEXT_TOO_LONG.at(template.span, limit=f"{MAX_TEXT:,}"))
        return FAULT
    scope.budget.spend(Limit.CHARACTERS_MADE, len(text), template.span)
    return text


def handed_on(template: Template, scope: Scope) -> tuple[str, tuple[str | int, ...]] | None:
    """Return the name whose value a template gives as it is, and the keys to the part of it that it gives.

    None for text around expressions, and for an expression that makes a value of its own.
    """
    match template.parts:
        case (Expression() as whole,):
            try:
                return _Evaluation(whole, scope, Diagnostics()).taken(whole.tree)
            except _FaultError:
                return None
    return None


def _unknown_name(name: ast.Name, expression: Expression, scope: Scope) -> Diagnostic:
    if name.id in _PYTHON_MODULES:
        instead = "constants and functions are called by their names alone, pi"
        return codes.NOT_IN_EXPRESSIONS.at(expression.span(name), what=f"'{name.id}'", instead=instead)
    near = [*scope, *CONSTANTS]
    is_text = _is_compared(name, expression.tree) and nearest(name.id, near) is None
    hint = f"; text is written in quotes: '{name.id}'" if is_text else ""
    return codes.UNKNOWN_NAME.at(expression.span(name), name=name.id, hint=hint, near=near)


_PYTHON_MODULES = ("math", "numpy", "np")
"""What Python programs write before pi and sin."""


def _is_compared(name: ast.Name, tree: ast.expr) -> bool:
    """Whether a name is one side of a comparison, where text is often meant."""
    comparisons = (node for node in ast.walk(tree) if isinstance(node, ast.Compare))
    return any(name is side for node in comparisons for side in (node.left, *node.comparators))


class _FaultError(Exception):
    """A part of the expression has no value, and that has been reported."""


def _text(taker: str, value: Value) -> str:
    if isinstance(value, str):
        return value
    raise RefusedError(codes.WRONG_KIND, operand=0, taker=taker, expected="text", found=kind_name(value))


class _Evaluation:
    """One evaluation of one expression; what is at fault is reported where it stands."""

    def __init__(self, expression: Expression, scope: Scope, sink: Diagnostics, trace: Trace = _untraced) -> None:
        self._expression = expression
        self._scope = scope
        self._sink = sink
        self._trace = trace

    def text(self) -> str | None:
        """Return the value as it stands in a text; None for a fault, and for a value that is no text."""
        value = self.result()
        if isinstance(value, Fault):
            return None
        text = as_text(value)
        if text is None:
            expression = self._expression
            self._sink.report(codes.NOT_TEXT.at(expression.span(expression.tree), found=kind_name(value)))
        return text

    def result(self) -> Value | Fault:
        expression, scope = self._expression, self._scope
        scope.budget.spend(Limit.STEPS, len(expression.text) // _CHARACTERS_A_STEP + 1, expression.place.span)
        unknown = [name for name in expression.names if name.id not in scope]
        for name in unknown:
            self._sink.report(_unknown_name(name, expression, scope))
        if unknown:
            return FAULT
        try:
            return self._value(expression.tree)
        except _FaultError:
            scope.budget.spend(Limit.STEPS, _STEPS_OF_A_FAULT, expression.place.span)
            return FAULT

    def taken(self, node: ast.expr) -> tuple[str, tuple[str | int, ...]] | None:
        """Return what `handed_on` does, for a part of the expression."""
        match node:
            case ast.Name(id=name):
                return None if name in CONSTANTS else (name, ())
            case ast.IfExp(test=condition, body=chosen, orelse=other):
                return self.taken(chosen if self._truth(condition, "'if'") else other)
            case ast.Attribute(value=whole, attr=key):
                reached = self.taken(whole)
                return reached and (reached[0], (*reached[1], key))
            case ast.Subscript(value=whole, slice=index):
                reached, place = self.taken(whole), self._value(index)
                return (reached[0], (*reached[1], place)) if reached and isinstance(place, str | int) else None
        return None

    def _value(self, node: ast.expr) -> Value:
        match node:
            case ast.Constant(value=str() | int() | float() as value):
                return value
            case ast.Name(id=name):
                return CONSTANTS[name] if name in CONSTANTS else self._named(name)
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return not self._truth(operand, "'not'")
            case ast.UnaryOp(op=sign, operand=operand):
                return self._apply(partial(signed, sign), node, operand)
            case ast.BinOp(left=left, op=operator, right=right):
                return self._apply(self._counted(ARITHMETIC[type(operator)]), node, left, right)
            case ast.BoolOp(op=ast.And(), values=conditions):
                return all(self._truth(condition, "'and'") for condition in conditions)
            case ast.BoolOp(values=conditions):
                return any(self._truth(condition, "'or'") for condition in conditions)
            case ast.Compare():
                return self._compared(node)
            case ast.IfExp(test=condition, body=chosen, orelse=other):
                return self._value(chosen if self._truth(condition, "'if'") else other)
            case ast.Call(func=ast.Name() as function, args=arguments):
                return self._called(node, function, arguments)
            case ast.Subscript(value=whole, slice=index):
                return self._apply(item, node, whole, index)
            case ast.Attribute(value=whole, attr=key):
                return self._apply(lambda value: field(value, key), node, whole)
        raise AssertionError(f"the grammar lets no {type(node).__name__} through")

    def _named(self, name: str) -> Value:
        value = self._scope.lookup(name, self._sink)
        if isinstance(value, Fault):
            raise _FaultError
        return value

    def _called(self, call: ast.Call, function: ast.Name, arguments: list[ast.expr]) -> Value:
        if function.id in FILE_FUNCTIONS:
            return self._asked_of_the_file(function, arguments[0])
        if function.id in _TAKE_AN_ANGLE:
            self._doubt_angle(function.id, arguments[0])
        return self._apply(self._counted(FUNCTIONS[function.id]), call, *arguments)

    def _doubt_angle(self, function: str, argument: ast.expr) -> None:
        """Warn of a number that stands there itself and is likely meant in degrees."""
        node = argument.operand if isinstance(argument, ast.UnaryOp) else argument
        number = node.value if isinstance(node, ast.Constant) else None
        if isinstance(number, int | float) and number > WIDEST_ANGLE:
            found = self._expression.written(argument)
            self._sink.report(codes.WIDE_LITERAL.at(self._expression.span(argument), function=function, found=found))

    def _asked_of_the_file(self, name: ast.Name, argument: ast.expr) -> Value:
        text = self._apply(partial(_text, f"{name.id}()"), name, argument)
        function = self._scope.function(name.id)
        if function is None:
            self._sink.report(codes.UNKNOWN_FUNCTION.at(self._expression.span(name), name=name.id))
            raise _FaultError
        value = function(text, self._expression.span(argument), self._sink)
        if isinstance(value, Fault):
            raise _FaultError
        return value

    def _truth(self, node: ast.expr, taker: str) -> bool:
        return self._apply(lambda value: truth(value, taker), node, node)

    def _compared(self, node: ast.Compare) -> bool:
        """Compare each two neighbours of a chain, from the left, until one comparison fails."""
        left_node, left = node.left, self._value(node.left)
        for operator, right_node in zip(node.ops, node.comparators, strict=True):
            right = self._value(right_node)
            compare = self._counted(COMPARISONS[type(operator)])
            if not self._settle(compare, node, (left_node, right_node), (left, right)):
                return False
            left_node, left = right_node, right
        return True

    def _counted(self, operation: Callable[..., T]) -> Callable[..., T]:
        """Return an operation that counts the items of the lists and the characters of the texts that it takes."""

        def counting(*values: Value) -> T:
            for value in values:
                if isinstance(value, tuple):
                    self._scope.budget.spend(Limit.STEPS, len(value), self._expression.place.span)
                elif isinstance(value, str):
                    self._scope.budget.spend(Limit.CHARACTERS_MADE, len(value), self._expression.place.span)
            return operation(*values)

        return counting

    def _apply(self, operation: Callable[..., T], node: ast.expr, *operands: ast.expr) -> T:
        return self._settle(operation, node, operands, [self._value(operand) for operand in operands])

    def _settle(
        self, operation: Callable[..., T], node: ast.expr, operands: Sequence[ast.expr], values: Sequence[Value]
    ) -> T:
        """Return what an operation makes of its operands' values; report what it refuses at the operand to blame."""
        try:
            return operation(*values)
        except RefusedError as refused:
            expression = self._expression
            if refused.operand is None:
                span = self._place(node)
            elif refused.operand < len(operands):
                span = self._place(operands[refused.operand])
            else:
                span = expression.key_span(node)
            self._sink.report(refused.code.at(span, near=refused.near, notes=(), **refused.facts))
            raise _FaultError from None

    def _place(self, node: ast.expr) -> Span:
        return self._trace(self._expression.written(node), self._expression.span(node))
