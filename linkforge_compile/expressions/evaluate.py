"""Compute the value of a parsed text from the names in scope."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import TypeAlias

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes import expressions as codes
from linkforge_compile.diagnostics.fix import Replacement
from linkforge_compile.expressions.functions import CONSTANTS, FILE_FUNCTIONS, FUNCTIONS
from linkforge_compile.expressions.operators import (
    ARITHMETIC,
    COMPARISONS,
    MAX_TEXT,
    Operation,
    field,
    is_too_long,
    item,
    signed,
    truth,
)
from linkforge_compile.expressions.types import (
    FAULT,
    Expression,
    Fault,
    PathText,
    RefusedError,
    Scope,
    Template,
    Value,
    ValuePath,
    as_text,
    joined,
    kind_name,
)
from linkforge_compile.expressions.unknown_names import unknown_name
from linkforge_compile.limits import Limit
from linkforge_compile.source import Span
from linkforge_compile.units import WIDEST_ANGLE

Trace: TypeAlias = Callable[[str, Span], Span]
"""Takes the text of a part of an expression and its span; returns a span that records where its value comes from."""


def _untraced(_expression: str, where: Span) -> Span:
    return where


_ANGLE_FUNCTIONS = ("sin", "cos", "tan")

_CHARACTERS_A_STEP = 4
"""Characters of an expression that count as one step of the budget, roughly."""

_STEPS_OF_A_FAULT = 50
"""Cost of reporting a faulty expression, which a `for` may repeat."""


def evaluate(
    template: Template, scope: Scope, sink: Diagnostics, *, is_xml: bool = False, trace: Trace = _untraced
) -> Value | Fault:
    """Return the value of a text: that of its only expression, else the text with the expressions' values in it.

    In XML (`is_xml`), values inside a text are escaped. FAULT where an expression is faulty, which is reported, or
    uses a name that is FAULT. Errors are reported at spans from `trace`.
    """
    match template.parts:
        case (Expression() as whole,):
            return _Evaluation(whole, scope, sink, trace).result()
    found = [part if isinstance(part, str) else _Evaluation(part, scope, sink, trace).text() for part in template.parts]
    texts = [text for text in found if text is not None]
    if len(texts) < len(found):
        return FAULT
    if is_xml:
        texts = list(_escape_values(zip(texts, (isinstance(part, Expression) for part in template.parts), strict=True)))
    text = joined(*texts)
    if is_too_long(text):
        sink.report(codes.TEXT_TOO_LONG.at(template.span, limit=f"{MAX_TEXT:,}"))
        return FAULT
    scope.budget.spend(Limit.CHARACTERS_MADE, len(text), template.span)
    return text


def passed_on(template: Template, scope: Scope, path: ValuePath) -> tuple[str, ValuePath] | None:
    """Return the name from whose value a template passes on the part at a path, and the part's path in that value.

    None for a part that the template computes.
    """
    match template.parts:
        case (Expression() as whole,):
            try:
                return _Evaluation(whole, scope, Diagnostics()).passed_on(whole.tree, path)
            except _FaultError:
                return None
    return None


class _FaultError(Exception):
    """A part of the expression has no value; the error has been reported."""


class _Evaluation:
    """One evaluation of one expression; errors are reported at the part of it that is wrong."""

    def __init__(self, expression: Expression, scope: Scope, sink: Diagnostics, trace: Trace = _untraced) -> None:
        self._expression = expression
        self._scope = scope
        self._sink = sink
        self._trace = trace

    def text(self) -> str | None:
        """Return the value for use inside a text; None for a fault, and for a value that cannot be text."""
        value = self.result()
        if isinstance(value, Fault):
            return None
        text = as_text(value)
        if text is None:
            expression = self._expression
            way = "; join() makes one text of its items" if isinstance(value, tuple) else ""
            self._sink.report(codes.NOT_TEXT.at(expression.span(expression.tree), found=kind_name(value), way=way))
        return text

    def result(self) -> Value | Fault:
        """Return the value, FAULT where there is none."""
        expression, scope = self._expression, self._scope
        scope.budget.spend(Limit.STEPS, len(expression.text) // _CHARACTERS_A_STEP + 1, expression.place.span)
        unknown = [name for name in expression.names if name.id not in scope]
        for name in unknown:
            self._sink.report(unknown_name(name, expression, scope))
        if unknown:
            return FAULT
        try:
            return self._value(expression.tree)
        except _FaultError:
            scope.budget.spend(Limit.STEPS, _STEPS_OF_A_FAULT, expression.place.span)
            return FAULT

    def passed_on(self, node: ast.expr, path: ValuePath) -> tuple[str, ValuePath] | None:
        """Return what the function `passed_on` does, for a part of the expression."""
        match node:
            case ast.Name(id=name):
                return None if name in CONSTANTS else (name, path)
            case ast.IfExp(test=condition, body=chosen, orelse=other):
                return self.passed_on(chosen if self._truth(condition, "'if'") else other, path)
            case ast.Attribute(value=whole, attr=key):
                return self.passed_on(whole, (key, *path))
            case ast.Subscript(value=whole, slice=index):
                place = self._value(index)
                return self.passed_on(whole, (place, *path)) if isinstance(place, str | int) else None
            case ast.Call(func=ast.Name(id="merge"), args=maps) if path:
                values = [(each, self._value(each)) for each in maps]
                having = [each for each, value in values if isinstance(value, Mapping) and path[0] in value]
                return self.passed_on(having[-1], path) if having else None
        return None

    def _value(self, node: ast.expr) -> Value:
        match node:
            case ast.Constant(value=str() | int() | float() as value):
                return value
            case ast.Name(id=name):
                return CONSTANTS[name] if name in CONSTANTS else self._lookup(name)
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
                return self._compare(node)
            case ast.IfExp(test=condition, body=chosen, orelse=other):
                return self._value(chosen if self._truth(condition, "'if'") else other)
            case ast.Call(func=ast.Name() as function, args=arguments):
                return self._call(node, function, arguments)
            case ast.Subscript(value=whole, slice=index):
                return self._apply(item, node, whole, index)
            case ast.Attribute(value=whole, attr=key):
                return self._apply(lambda value: field(value, key), node, whole)
        raise AssertionError(f"the grammar lets no {type(node).__name__} through")

    def _lookup(self, name: str) -> Value:
        value = self._scope.lookup(name, self._sink)
        if isinstance(value, Fault):
            raise _FaultError
        return value

    def _call(self, call: ast.Call, function: ast.Name, arguments: list[ast.expr]) -> Value:
        if function.id in FILE_FUNCTIONS:
            return self._call_file_function(function, arguments[0])
        if function.id in _ANGLE_FUNCTIONS:
            self._warn_of_degrees(function.id, arguments[0])
        return self._apply(self._counted(FUNCTIONS[function.id], walks_maps=True), call, *arguments)

    def _warn_of_degrees(self, function: str, argument: ast.expr) -> None:
        """Warn of a literal number that is too large for radians."""
        node = argument.operand if isinstance(argument, ast.UnaryOp) else argument
        number = node.value if isinstance(node, ast.Constant) else None
        if isinstance(number, int | float) and number > WIDEST_ANGLE:
            found = self._expression.written(argument)
            self._sink.report(codes.WIDE_LITERAL.at(self._expression.span(argument), function=function, found=found))

    def _call_file_function(self, name: ast.Name, argument: ast.expr) -> Value:
        text = self._apply(FILE_FUNCTIONS[name.id], name, argument)
        assert isinstance(text, str), "the functions of the file accept only text"
        function = self._scope.function(name.id)
        if function is None:
            self._sink.report(codes.UNKNOWN_FUNCTION.at(self._expression.span(name), name=name.id, hint=""))
            raise _FaultError
        value = function(text, self._expression.span(argument), self._sink)
        if isinstance(value, Fault):
            raise _FaultError
        return value

    def _truth(self, node: ast.expr, name: str) -> bool:
        return bool(self._apply(Operation(name, truth), node, node))

    def _compare(self, node: ast.Compare) -> bool:
        """Compare neighbours of a chain from left to right until one comparison fails."""
        left_node, left = node.left, self._value(node.left)
        for operator, right_node in zip(node.ops, node.comparators, strict=True):
            right = self._value(right_node)
            compare = self._counted(COMPARISONS[type(operator)])
            if not self._compute(compare, node, (left_node, right_node), (left, right)):
                return False
            left_node, left = right_node, right
        return True

    def _counted(self, operation: Callable[..., Value], *, walks_maps: bool = False) -> Callable[..., Value]:
        """Return an operation that charges the budget for the items and characters of its operands."""

        def counting(*values: Value) -> Value:
            for value in values:
                if isinstance(value, tuple) or (walks_maps and isinstance(value, Mapping)):
                    self._scope.budget.spend(Limit.STEPS, len(value), self._expression.place.span)
                elif isinstance(value, str):
                    self._scope.budget.spend(Limit.CHARACTERS_MADE, len(value), self._expression.place.span)
            return operation(*values)

        return counting

    def _apply(self, operation: Callable[..., Value], node: ast.expr, *operands: ast.expr) -> Value:
        return self._compute(operation, node, operands, [self._value(operand) for operand in operands])

    def _compute(
        self, operation: Callable[..., Value], node: ast.expr, operands: Sequence[ast.expr], values: Sequence[Value]
    ) -> Value:
        """Return the result of an operation; report a RefusedError at the operand that is wrong."""
        try:
            return operation(*values)
        except RefusedError as refused:
            expression = self._expression
            if refused.operand is None:
                span = self._traced_span(node)
            elif refused.operand < len(operands):
                span = self._traced_span(operands[refused.operand])
            else:
                span = expression.key_span(node)
            fault = refused.code.at(span, near=refused.near, notes=(), **refused.facts)
            written, instead = (str(refused.facts.get(fact, "")) for fact in ("written", "instead"))
            place = span.origin.span if span.origin and instead else None
            fix = Replacement(written, instead).within(place)
            self._sink.report(fault.with_fix(fix))
            raise _FaultError from None

    def _traced_span(self, node: ast.expr) -> Span:
        return self._trace(self._expression.written(node), self._expression.span(node))


# Values in raw XML

_REFERENCES = str.maketrans(
    {"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&apos;", "\t": "&#9;", "\n": "&#10;", "\r": "&#13;"}
)

_BEGIN = re.compile(r"<!--|<!\[CDATA\[")
_END_OF_COMMENT = re.compile("-->")
_END_OF_CDATA = re.compile(r"\]\]>")
_END = {"<!--": _END_OF_COMMENT, "<![CDATA[": _END_OF_CDATA}
_LONGEST_PART = len("<![CDATA[") - 1


def _escape_values(texts: Iterable[tuple[str, bool]]) -> Iterator[str]:
    """Yield the consecutive texts of raw XML; values among them are escaped.

    XML comments have no escapes: there `--` and `>` are changed so that no value ends the comment.
    """
    awaited, carry = _BEGIN, ""
    for text, is_value in texts:
        written = _escape(text, awaited) if is_value else text
        yield written
        awaited, carry = _scan(carry + written, awaited)


def _escape(value: str, awaited: re.Pattern[str]) -> str:
    if isinstance(value, PathText):
        return PathText(_escape(str(value), awaited), _escape(value.from_compiled, awaited))
    if awaited is _END_OF_COMMENT:
        return value.replace("--", "- -").replace("--", "- -").replace(">", "&gt;")
    escaped = value.translate(_REFERENCES)
    return f"]]>{escaped}<![CDATA[" if awaited is _END_OF_CDATA else escaped


def _scan(text: str, awaited: re.Pattern[str]) -> tuple[re.Pattern[str], str]:
    """Return the pattern of the next comment or CDATA mark after a text, and the end of the text that may begin it."""
    position = 0
    while found := awaited.search(text, position):
        position = found.end()
        awaited = _END.get(found[0], _BEGIN)
    return awaited, text[max(position, len(text) - _LONGEST_PART) :]
