"""Parse the expressions in a text with Python's ast."""

from __future__ import annotations

import ast
import re
import warnings
from collections.abc import Container
from dataclasses import replace

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes import expressions as codes
from linkforge_compile.expressions.functions import CONSTANTS
from linkforge_compile.expressions.refused_syntax import find_refused, operands
from linkforge_compile.expressions.syntax_errors import STRING, explain_syntax_error
from linkforge_compile.expressions.types import Expression, Template
from linkforge_compile.source import Span
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
    faults = tuple(find_refused(expression))
    sink.report_all(faults)
    return None if faults else _with_names(expression)


def _with_names(expression: Expression) -> Expression:
    """Return the expression with its names, spelled as written: Python normalizes µ and other letters."""
    names = []
    waiting = [expression.tree]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Name) and node.id not in CONSTANTS:
            node.id = expression.written(node)
            names.append(node)
        waiting.extend(operands(node))
    return replace(expression, names=tuple(names))


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
