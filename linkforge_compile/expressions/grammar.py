"""Which part of Python's grammar the language has, and what to write instead of the rest."""

from __future__ import annotations

import ast
import math
from collections.abc import Iterable, Iterator
from dataclasses import replace

from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes import expressions as codes
from linkforge_compile.expressions.comparisons import COMPARISONS
from linkforge_compile.expressions.functions import CONSTANTS, SIGNATURES
from linkforge_compile.expressions.operators import ARITHMETIC, MAX_INTEGER_BITS
from linkforge_compile.expressions.template import Expression
from linkforge_compile.source.characters import FORBIDDEN_CHARACTER, code_point

MAX_DEPTH = 100
"""How deep an expression may nest; a sum of as many terms nests as deep."""

_LIST_ELSEWHERE = "lists and maps are written in YAML and given a name in 'variables'"
_IN_FOR = "a list is repeated over by 'for'"
_NO_BITS = "there are no operators on bits"

_REFUSED: dict[type[ast.AST], tuple[str, str]] = {
    ast.List: ("a list in brackets", _LIST_ELSEWHERE),
    ast.Tuple: ("a list of values", _LIST_ELSEWHERE),
    ast.Dict: ("a map in braces", _LIST_ELSEWHERE),
    ast.Set: ("a set in braces", _LIST_ELSEWHERE),
    ast.ListComp: ("a comprehension", _IN_FOR),
    ast.SetComp: ("a comprehension", _IN_FOR),
    ast.DictComp: ("a comprehension", _IN_FOR),
    ast.GeneratorExp: ("a comprehension", _IN_FOR),
    ast.Lambda: ("a lambda", "the functions are those of the language"),
    ast.NamedExpr: ("':='", "names are declared in 'variables'"),
    ast.JoinedStr: ("an f-string", "text with a value in it is written outside: wheel_$(side)"),
    ast.Starred: ("'*' before a value", "min() and max() take a list as it is"),
    ast.Slice: ("a slice", "items are taken one by one, list[0]"),
    ast.Await: ("'await'", "it means nothing here"),
    ast.Yield: ("'yield'", "it means nothing here"),
    ast.YieldFrom: ("'yield'", "it means nothing here"),
    ast.BitXor: ("'^'", "powers are written '**'"),
    ast.BitAnd: ("'&'", "'and' joins conditions"),
    ast.BitOr: ("'|'", "'or' joins conditions"),
    ast.Invert: ("'~'", "'not' turns a condition round"),
    ast.LShift: ("'<<'", _NO_BITS),
    ast.RShift: ("'>>'", _NO_BITS),
    ast.MatMult: ("'@'", "there are no matrices"),
    ast.Is: ("'is'", "values are compared with '=='"),
    ast.IsNot: ("'is not'", "values are compared with '!='"),
}
"""What Python's grammar has and the language has not: what it is, and what to write instead."""

_PYTHON_CONSTANTS = {True: "true", False: "false", None: "null"}


def refusals(expression: Expression) -> Iterator[Diagnostic]:
    """Yield what the language does not have; each once, and nothing about what stands inside it."""
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
            waiting.extend((operand, depth + 1) for operand in _operands(node))


def names_in(expression: Expression) -> Expression:
    """Return the expression with its names, spelled as written: Python folds µ and other letters to one form."""
    names = []
    waiting = [expression.tree]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Name) and node.id not in CONSTANTS:
            node.id = expression.written(node)
            names.append(node)
        waiting.extend(_operands(node))
    return replace(expression, names=tuple(names))


def _operands(node: ast.expr) -> Iterable[ast.expr]:
    if isinstance(node, ast.Constant | ast.Name):
        return ()  # as nearly all, of which Python would look at each field
    if isinstance(node, ast.Call):
        return node.args
    return (child for child in ast.iter_child_nodes(node) if isinstance(child, ast.expr))


def _fault(node: ast.expr, expression: Expression) -> Diagnostic | None:
    match node:
        case ast.Constant(value=value):
            return _constant_fault(node, value, expression)
        case ast.Name():
            return _name_fault(node, expression)
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
    return codes.NOT_IN_EXPRESSIONS.at(expression.span(node), what=what, instead=instead)


def _comparison_fault(chain: ast.Compare, expression: Expression) -> Diagnostic | None:
    lefts = [chain.left, *chain.comparators[:-1]]
    for operator, left, right in zip(chain.ops, lefts, chain.comparators, strict=True):
        if type(operator) not in COMPARISONS:
            return _operator_fault(operator, left, right, expression)
    return None


def _operator_fault(operator: ast.AST, left: ast.expr, right: ast.expr, expression: Expression) -> Diagnostic:
    """Tell at the operator, which has no place of its own in Python's tree but stands between its operands."""
    what, instead = _REFUSED[type(operator)]
    symbol = what.strip("'")
    begin = expression.index(left.end_col_offset or 0)
    between = expression.text[begin : expression.index(right.col_offset)]
    start, length = begin + max(between.find(symbol), 0), len(symbol)
    return codes.NOT_IN_EXPRESSIONS.at(
        expression.place.part(expression.offset + start, length), what=what, instead=instead
    )


def _constant_fault(node: ast.Constant, value: object, expression: Expression) -> Diagnostic | None:
    match value:
        case bool() | None:
            instead = f"it is written '{_PYTHON_CONSTANTS[value]}'"
            return codes.NOT_IN_EXPRESSIONS.at(expression.span(node), what=f"'{value}'", instead=instead)
        case str() if forbidden := FORBIDDEN_CHARACTER.search(value):
            what = f"the character {code_point(forbidden[0])}"
            return codes.NOT_IN_EXPRESSIONS.at(expression.span(node), what=what, instead="no file can hold it")
        case int() if value.bit_length() > MAX_INTEGER_BITS:
            return codes.RESULT_TOO_LARGE.at(expression.span(node), taker="this number")
        case float() if not math.isfinite(value):
            return codes.RESULT_TOO_LARGE.at(expression.span(node), taker="this number")
        case str() | int() | float():
            return None
    return codes.NOT_IN_EXPRESSIONS.at(
        expression.span(node),
        what=f"'{expression.written(node)}'",
        instead="values are numbers, text, true, false and null",
    )


def _name_fault(node: ast.Name, expression: Expression) -> Diagnostic | None:
    if node.id not in SIGNATURES:
        return None
    signature = SIGNATURES[node.id].signature
    return codes.FUNCTION_NOT_CALLED.at(expression.span(node), function=node.id, signature=signature)


def _call_fault(call: ast.Call, expression: Expression) -> Diagnostic | None:
    span = expression.span(call.func)
    if not isinstance(call.func, ast.Name):
        known = SIGNATURES.get(call.func.attr) if isinstance(call.func, ast.Attribute) else None
        instead = f"the functions are called by their names alone, {known.signature if known else 'sqrt(x)'}"
        return codes.NOT_IN_EXPRESSIONS.at(span, what=f"a call of '{expression.written(call.func)}'", instead=instead)
    name = call.func.id
    function = SIGNATURES.get(name)
    if function is None:
        return codes.UNKNOWN_FUNCTION.at(span, name=name, near=SIGNATURES)
    if call.keywords:
        instead = f"the order tells what each is: {function.signature}"
        return codes.NOT_IN_EXPRESSIONS.at(expression.span(call), what="an argument with a name", instead=instead)
    if any(isinstance(argument, ast.Starred) for argument in call.args) or function.takes(len(call.args)):
        return None
    whole = expression.span(call)
    return codes.WRONG_ARGUMENT_COUNT.at(whole, signature=function.signature, count=len(call.args))
