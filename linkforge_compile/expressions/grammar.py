"""Which of Python's syntax expressions may use, and what to write instead of the rest."""

from __future__ import annotations

import ast
import keyword
import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import replace

from linkforge_compile.diagnostics import Diagnostic
from linkforge_compile.diagnostics.codes import expressions as codes
from linkforge_compile.expressions.functions import CONSTANTS, SIGNATURES
from linkforge_compile.expressions.operators import ARITHMETIC, COMPARISONS, MAX_INTEGER_BITS
from linkforge_compile.expressions.types import Expression
from linkforge_compile.source.characters import FORBIDDEN_CHARACTER, code_point
from linkforge_compile.units import UNITS

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

_PYTHON_CONSTANTS = {True: "true", False: "false", None: "null"}


def refusals(expression: Expression) -> Iterator[Diagnostic]:
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
            waiting.extend((operand, depth + 1) for operand in _operands(node))


def with_names(expression: Expression) -> Expression:
    """Return the expression with its names, spelled as written: Python normalizes µ and other letters."""
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
        return ()  # nearly all nodes; iter_child_nodes would look at each of their fields
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
    return codes.NOT_IN_EXPRESSIONS.at(
        expression.place.part(expression.offset + start, length), use=f"contain {what}", instead=instead
    )


def _constant_fault(node: ast.Constant, value: object, expression: Expression) -> Diagnostic | None:
    match value:
        case bool() | None:
            instead = f"write '{_PYTHON_CONSTANTS[value]}'"
            return codes.NOT_IN_EXPRESSIONS.at(expression.span(node), use=f"contain '{value}'", instead=instead)
        case str() if forbidden := FORBIDDEN_CHARACTER.search(value):
            what = f"the character {code_point(forbidden[0])}"
            return codes.NOT_IN_EXPRESSIONS.at(
                expression.span(node), use=f"contain {what}", instead="no file may contain it"
            )
        case int() if value.bit_length() > MAX_INTEGER_BITS:
            return codes.RESULT_TOO_LARGE.at(expression.span(node), taker="this number")
        case float() if not math.isfinite(value):
            return codes.RESULT_TOO_LARGE.at(expression.span(node), taker="this number")
        case str() | int() | float():
            return None
    return codes.NOT_IN_EXPRESSIONS.at(
        expression.span(node),
        use=f"contain '{expression.written(node)}'",
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
        instead = f"write {known.signature}" if known else "call functions by their name only, such as sqrt(x)"
        return codes.NOT_IN_EXPRESSIONS.at(span, use=f"call '{expression.written(call.func)}'", instead=instead)
    name = call.func.id
    function = SIGNATURES.get(name)
    if function is None:
        return codes.UNKNOWN_FUNCTION.at(span, name=name, near=SIGNATURES)
    if call.keywords:
        instead = f"arguments are given in order: {function.signature}"
        return codes.NOT_IN_EXPRESSIONS.at(
            expression.span(call), use="contain an argument with a name", instead=instead
        )
    if any(isinstance(argument, ast.Starred) for argument in call.args) or function.accepts(len(call.args)):
        return None
    whole = expression.span(call)
    return codes.WRONG_ARGUMENT_COUNT.at(whole, signature=function.signature, count=len(call.args))


# Syntax errors

_STRING = re.compile(r"'(?:[^'\\]|\\.)*'|\"(?:[^\"\\]|\\.)*\"", re.DOTALL)
_UNITS = "|".join(re.escape(name) for name in sorted(UNITS, key=len, reverse=True))
_KEYWORDS = "|".join(keyword.kwlist)

_HABITS = (
    (r"^\s*find\s+([\w-]+)\s*$", "'$(find ...)' is xacro; write package://{1}/..."),
    (r"^\s*(?:arg|eval)\s+(.*?)\s*$", "'$(arg ...)' and '$(eval ...)' are xacro; write $({1})"),
    (r"^\s*(?:env|optenv)\s.*", "the environment is not read; declare a parameter"),
    (r"&&", "write 'and' for '&&'"),
    (r"\|\|", "write 'or' for '||'"),
    (r"!(?!=)", "write 'not' for '!'"),
    (r"\?", "write: a if condition else b"),
    (r"\$[({]?", "write names without '$' here"),
    (r"#", "expressions cannot contain comments"),
    (r"(?<![=!<>:])=(?!=)", "compare two values with '=='"),
    (
        rf"(?<![\w.])((?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?\s*(?!in\b)(?:{_UNITS}))(?!\w)",
        "units are not allowed here; declare '{1}' in 'variables'",
    ),
    (r"[×·⋅∙]", "write '*' for '{0}'"),
    (r"÷", "write '/' for '{0}'"),
    (r"[−–—]", "write '-' for '{0}'"),
    (r"≤", "write '<=' for '{0}'"),
    (r"≥", "write '>=' for '{0}'"),
    (r"≠", "write '!=' for '{0}'"),
    (r"²", "write '** 2' for '{0}'"),
    (r"³", "write '** 3' for '{0}'"),
    (rf"\.\s*({_KEYWORDS})\b", "'{1}' is a reserved word; read that key with ['{1}']"),
    (r"(?<![\w.])0[0-9]+\b(?!\.)", "a number cannot begin with 0"),
    (r"\bif\b(?!.*\belse\b)", "'if' needs an 'else'"),
)
"""Habits from other languages, searched in the text without its strings, and the problem; the first match wins."""


def explain_syntax_error(text: str, error: SyntaxError) -> tuple[int, int, str]:
    """Return the offset and length of a syntax error in an expression, and what is wrong."""
    bare = _STRING.sub(lambda found: found[0][0] + " " * (len(found[0]) - 2) + found[0][0], text)
    for habit, problem in _HABITS:
        if found := re.search(habit, bare):
            return found.start(), len(found[0]), problem.format(found[0], *found.groups())
    # Python counts from 1 and saw one more parenthesis. Its own message differs between versions.
    start = min(max((error.offset or 0) - 2, 0), len(text))
    return start, 1, "something is missing or unexpected here"
