"""Parse the expressions in a text with Python's ast, and reject syntax that the language does not have."""

from __future__ import annotations

import ast
import math
import re
import warnings
from collections.abc import Container, Iterable, Iterator
from dataclasses import replace

from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.diagnostics.codes import expressions as codes
from linkforge_compile.expressions.functions import CONSTANTS, SIGNATURES
from linkforge_compile.expressions.operators import ARITHMETIC, COMPARISONS, MAX_INTEGER_BITS
from linkforge_compile.expressions.syntax_errors import STRING, explain_syntax_error
from linkforge_compile.expressions.types import Expression, Template
from linkforge_compile.source import Span
from linkforge_compile.source.characters import FORBIDDEN_CHARACTER, code_point
from linkforge_compile.source.text_place import TextPlace

MAX_LENGTH = 2_000
"""The longest expression, in characters."""

_OPENING = re.compile(r"\$?\$\(")
_BRACKETS_AND_QUOTES = re.compile(rf"{STRING}|['\"()]", re.DOTALL)
_STRINGS_AND_SPACES = re.compile(rf"{STRING}|\s", re.DOTALL)


def parse_template(text: str, span: Span, sink: Diagnostics) -> Template | None:
    """Parse the text of the scalar at `span`; None where an expression in it is faulty, which is reported."""
    place = TextPlace.of(text, span)
    parts: list[str | Expression | None] = []
    position = 0
    while opening := _OPENING.search(text, position):
        parts.append(text[position : opening.start()])
        position = opening.end()
        if opening[0] == "$$(":
            parts.append("$(")
            continue
        end = _find_closing(text, opening.end(), place, sink)
        if end is None:
            return None
        parts.append(_parse_expression(text[position:end], position, place, sink))
        position = end + 1
    parts.append(text[position:])
    if None in parts:
        return None
    return Template(tuple(part for part in parts if part), span)


def _find_closing(text: str, start: int, place: TextPlace, sink: Diagnostics) -> int | None:
    """Return the index of the `)` of the expression whose `$(` ends at `start`; report a missing one."""
    depth = 1
    for token in _BRACKETS_AND_QUOTES.finditer(text, start):
        match token[0]:
            case "(":
                depth += 1
            case ")":
                depth -= 1
            case "'" | '"':
                sink.report(codes.UNCLOSED_TEXT.at(place.part(token.start(), 1)))
                return None
        if depth == 0:
            return token.start()
    sink.report(codes.UNCLOSED_EXPRESSION.at(place.part(start - 2, 2)))
    return None


def _parse_expression(text: str, offset: int, place: TextPlace, sink: Diagnostics) -> Expression | None:
    if not text.strip():
        sink.report(codes.EMPTY_EXPRESSION.at(place.part(offset - 2, len(text) + 3)))
        return None
    if len(text) > MAX_LENGTH:
        too_long = f"is longer than {MAX_LENGTH:,} characters"
        sink.report(codes.EXPRESSION_TOO_LARGE.at(place.part(offset, len(text)), fault=too_long))
        return None
    text = _STRINGS_AND_SPACES.sub(lambda found: found[0] if found[0][0] in "'\"" else " ", text)
    try:
        with warnings.catch_warnings():
            # Python warns on standard error of `1if` and of unknown escapes, in a file that does not exist.
            warnings.simplefilter("ignore")
            # The parentheses make leading spaces valid.
            tree = ast.parse(f"({text})", mode="eval").body
    except (SyntaxError, MemoryError, RecursionError, ValueError) as error:
        if isinstance(error, SyntaxError) and error.msg != "too many nested parentheses":
            found = explain_syntax_error(text, error)
            fault = codes.UNREADABLE_EXPRESSION.at(
                place.part(offset + found.start, found.length), problem=found.problem
            )
            sink.report(fault.with_fix(found.instead.within(fault.span)) if found.instead else fault)
        else:  # beyond the limits of Python's parser
            sink.report(codes.EXPRESSION_TOO_LARGE.at(place.part(offset, len(text)), fault="nests too deep"))
        return None
    expression = Expression(text, offset, place, tree)
    faults = tuple(refusals(expression))
    sink.report_all(faults)
    return None if faults else with_names(expression)


# Text in which `$( )` was forgotten

_NEEDS_NO_PARENTHESES = (ast.Name, ast.Constant, ast.Call, ast.Subscript, ast.Attribute)
_LITERAL_NAMES = ("true", "false", "null")


def forgotten_expression(text: str, where: Span, names: Container[str]) -> str | None:
    """Return "$(track / 2)" for the text "track / 2" if that is an expression of known names, else None.

    Literals are no such text: a number in quotes may be intended.
    """
    whole = f"$({text.strip()})"
    template = parse_template(whole, where, Diagnostics())
    match template.parts if template else ():
        case (Expression(tree=tree, names=used),) if not _is_literal(tree) and all(name.id in names for name in used):
            return whole
    return None


def as_one_expression(text: str, where: Span, names: Container[str]) -> str | None:
    """Return text around expressions as one expression: "$(track / 2)" for "$(track) / 2"; None if that fails."""
    template = parse_template(text, where, Diagnostics())
    parts = template.parts if template else ()
    inside = ""
    for part in parts:
        text = part if isinstance(part, str) else part.text.strip()
        needs_none = isinstance(part, str) or isinstance(part.tree, _NEEDS_NO_PARENTHESES)
        inside += text if needs_none else f"({text})"
    return forgotten_expression(inside, where, names) if len(parts) > 1 else None


def _is_literal(tree: ast.expr) -> bool:
    while isinstance(tree, ast.UnaryOp):
        tree = tree.operand
    return isinstance(tree, ast.Constant) or (isinstance(tree, ast.Name) and tree.id in _LITERAL_NAMES)


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


def _call_fault(call: ast.Call, expression: Expression) -> Diagnostic | None:
    span = expression.span(call.func)
    if not isinstance(call.func, ast.Name):
        return _attribute_fault(call.func, expression)
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
    found = "1 argument" if len(call.args) == 1 else f"{len(call.args)} arguments"
    return codes.WRONG_ARGUMENT_COUNT.at(whole, signature=function.signature, found=found)
