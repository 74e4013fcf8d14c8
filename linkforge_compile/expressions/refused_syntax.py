"""Reject what Python's syntax has and expressions of the language do not, with what to write instead."""

from __future__ import annotations

import ast
import math
from collections.abc import Iterable, Iterator

from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes import expressions as codes
from linkforge_compile.diagnostics.fix import Replacement
from linkforge_compile.expressions.functions import SIGNATURES
from linkforge_compile.expressions.operators import ARITHMETIC, COMPARISONS, MAX_INTEGER_BITS
from linkforge_compile.expressions.types import Expression
from linkforge_compile.source.characters import FORBIDDEN_CHARACTER, code_point

MAX_DEPTH = 100
"""How deep an expression may nest; a sum nests as deep as it has terms."""

_LIST_ELSEWHERE = "declare lists and maps in 'variables'"
_IN_FOR = "repeat entries with 'for'"
_NO_BITS = "there are no bitwise operators"

_REFUSED: dict[type[ast.AST], tuple[str, str]] = {
    ast.List: ("a list in brackets", _LIST_ELSEWHERE),
    ast.Tuple: ("a list of values", _LIST_ELSEWHERE),
    ast.Dict: ("a map in braces", _LIST_ELSEWHERE),
    ast.Set: ("a set in braces", _LIST_ELSEWHERE),
    ast.ListComp: ("a comprehension", _IN_FOR),
    ast.SetComp: ("a comprehension", _IN_FOR),
    ast.DictComp: ("a comprehension", _IN_FOR),
    ast.GeneratorExp: ("a comprehension", _IN_FOR),
    ast.Lambda: ("a lambda", "only functions of the language can be called"),
    ast.NamedExpr: ("':='", "declare names in 'variables'"),
    ast.JoinedStr: ("an f-string", "write the text around the expression: wheel_$(side)"),
    ast.Starred: ("'*' before a value", "pass the list itself to min() or max()"),
    ast.Slice: ("a slice", "read items one by one: list[0]"),
    ast.Await: ("'await'", "there are no coroutines or generators"),
    ast.Yield: ("'yield'", "there are no coroutines or generators"),
    ast.YieldFrom: ("'yield'", "there are no coroutines or generators"),
    ast.BitXor: ("'^'", "write '**' for powers"),
    ast.BitAnd: ("'&'", "write 'and' between conditions"),
    ast.BitOr: ("'|'", "write 'or' between conditions"),
    ast.Invert: ("'~'", "write 'not' to negate a condition"),
    ast.LShift: ("'<<'", _NO_BITS),
    ast.RShift: ("'>>'", _NO_BITS),
    ast.MatMult: ("'@'", "there are no matrices"),
    ast.Is: ("'is'", "compare values with '=='"),
    ast.IsNot: ("'is not'", "compare values with '!='"),
}
"""Syntax of Python that expressions do not have: what it is called, and what to write instead."""

_MATH_OF_PYTHON = ("math", "numpy", "np")

_PYTHON_CONSTANTS = {True: "true", False: "false", None: "null"}


def find_refused(expression: Expression) -> Iterator[Diagnostic]:
    """Yield an error for each part that expressions do not have, none for what is inside such a part."""
    waiting = [(expression.tree, 1)]
    while waiting:
        node, depth = waiting.pop()
        if depth > MAX_DEPTH:
            yield codes.EXPRESSION_TOO_LARGE.at(
                expression.span(expression.tree), fault=f"nests more than {MAX_DEPTH} deep"
            )
            return
        fault = _fault(node, expression)
        if fault:
            yield fault
        else:
            waiting.extend((operand, depth + 1) for operand in operands(node))


def operands(node: ast.expr) -> Iterable[ast.expr]:
    """Return the expressions that a part of an expression consists of, without the name of a function."""
    if isinstance(node, ast.Constant | ast.Name):
        return ()  # nearly all nodes; iter_child_nodes would look at each of their fields
    if isinstance(node, ast.Call):
        return node.args
    return (child for child in ast.iter_child_nodes(node) if isinstance(child, ast.expr))


def _fault(node: ast.expr, expression: Expression) -> Diagnostic | None:
    match node:
        case ast.Constant(value=value):
            return _constant_fault(node, value, expression)
        case ast.Name(id=name) if name in SIGNATURES:
            signature = SIGNATURES[name].signature
            return codes.FUNCTION_NOT_CALLED.at(expression.span(node), function=name, signature=signature)
        case ast.Name():
            return None
        case ast.Call():
            return _call_fault(node, expression)
        case ast.BinOp(left=left, op=operator, right=right) if type(operator) not in ARITHMETIC:
            return _operator_fault(operator, left, right, expression)
        case ast.Compare():
            return _comparison_fault(node, expression)
        case ast.UnaryOp(op=ast.Invert()):
            return _refused(node, ast.Invert, expression)
        case ast.BinOp() | ast.BoolOp() | ast.UnaryOp() | ast.IfExp() | ast.Subscript() | ast.Attribute():
            return None
    return _refused(node, type(node), expression)


def _refused(node: ast.expr, kind: type[ast.AST], expression: Expression) -> Diagnostic:
    what, instead = _REFUSED.get(kind, ("this syntax", "the language has operators, conditions and functions"))
    return codes.NOT_IN_EXPRESSIONS.at(expression.span(node), use=f"contain {what}", instead=instead)


def _comparison_fault(chain: ast.Compare, expression: Expression) -> Diagnostic | None:
    lefts = [chain.left, *chain.comparators[:-1]]
    for operator, left, right in zip(chain.ops, lefts, chain.comparators, strict=True):
        if type(operator) not in COMPARISONS:
            return _operator_fault(operator, left, right, expression)
    return None


def _operator_fault(operator: ast.AST, left: ast.expr, right: ast.expr, expression: Expression) -> Diagnostic:
    """Report an operator at its place, which the tree does not hold: it is between the operands."""
    what, instead = _REFUSED[type(operator)]
    symbol = what.strip("'")
    begin = expression.index(left.end_col_offset or 0)
    between = expression.text[begin : expression.index(right.col_offset)]
    start, length = begin + max(between.find(symbol), 0), len(symbol)
    fault = codes.NOT_IN_EXPRESSIONS.at(
        expression.place.part(expression.offset + start, length), use=f"contain {what}", instead=instead
    )
    return fault.replacing("^", "**") if isinstance(operator, ast.BitXor) else fault


def _constant_fault(node: ast.Constant, value: object, expression: Expression) -> Diagnostic | None:
    match value:
        case bool() | None:
            word = _PYTHON_CONSTANTS[value]
            fault = codes.NOT_IN_EXPRESSIONS.at(
                expression.span(node), use=f"contain '{value}'", instead=f"write '{word}'"
            )
            return fault.replacing(str(value), word, is_safe=True, is_whole=True)
        case str() if forbidden := FORBIDDEN_CHARACTER.search(value):
            what = f"the character {code_point(forbidden[0])}"
            return codes.NOT_IN_EXPRESSIONS.at(
                expression.span(node), use=f"contain {what}", instead="no file may contain it"
            )
        case int() if value.bit_length() > MAX_INTEGER_BITS:
            return codes.RESULT_TOO_LARGE.at(expression.span(node), operation="this number")
        case float() if not math.isfinite(value):
            return codes.RESULT_TOO_LARGE.at(expression.span(node), operation="this number")
        case str() | int() | float():
            return None
    return codes.NOT_IN_EXPRESSIONS.at(
        expression.span(node),
        use=f"contain '{expression.written(node)}'",
        instead="values are numbers, text, true, false and null",
    )


def _attribute_fault(function: ast.expr, expression: Expression) -> Diagnostic:
    """Return the error for a call of what is no name, such as `math.sqrt`."""
    known = SIGNATURES.get(function.attr) if isinstance(function, ast.Attribute) else None
    instead = f"write {known.signature}" if known else "call functions by their name only, such as sqrt(x)"
    written = expression.written(function)
    fault = codes.NOT_IN_EXPRESSIONS.at(expression.span(function), use=f"call '{written}'", instead=instead)
    module, _, name = written.rpartition(".")
    is_ours = known is not None and module in _MATH_OF_PYTHON
    return fault.replacing(written, name, is_safe=True, is_whole=True) if is_ours else fault


def _unknown_function(call: ast.Call, name: str, expression: Expression) -> Diagnostic:
    span, fix = expression.span(call.func), None
    if name != "range" or len(call.args) != 1:
        return codes.UNKNOWN_FUNCTION.at(span, name=name, hint="", near=SIGNATURES)
    count = expression.written(call.args[0])
    if call is expression.tree:
        fix = Replacement("", count).within(expression.span(call))
    return codes.UNKNOWN_FUNCTION.at(
        span, name=name, hint=f"; 'for' counts to a number: write 'for: {{i: $({count})}}'"
    ).with_fix(fix)


def _call_fault(call: ast.Call, expression: Expression) -> Diagnostic | None:
    if not isinstance(call.func, ast.Name):
        return _attribute_fault(call.func, expression)
    name = call.func.id
    function = SIGNATURES.get(name)
    if function is None:
        return _unknown_function(call, name, expression)
    if call.keywords:
        instead = f"arguments are given in order: {function.signature}"
        return codes.NOT_IN_EXPRESSIONS.at(
            expression.span(call), use="contain an argument with a name", instead=instead
        )
    if any(isinstance(argument, ast.Starred) for argument in call.args) or function.accepts(len(call.args)):
        return None
    whole = expression.span(call)
    found = "1 argument" if len(call.args) == 1 else f"{len(call.args)} arguments"
    return codes.WRONG_ARGUMENT_COUNT.at(whole, signature=function.signature, found=found)
