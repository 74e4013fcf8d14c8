"""Finds the expressions in a scalar's text and reads them with Python's own grammar, never with its `eval`."""

from __future__ import annotations

import ast
import re
import warnings

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes import expressions as codes
from linkforge_compile.expressions.grammar import names_in, refusals
from linkforge_compile.expressions.habits import explain_syntax_error
from linkforge_compile.expressions.template import Expression, Template
from linkforge_compile.source import Span
from linkforge_compile.source.text_place import TextPlace

MAX_LENGTH = 2_000
"""How many characters an expression may have."""

_OPENING = re.compile(r"\$?\$\(")
_STRING = r"'(?:[^'\\]|\\.)*'|\"(?:[^\"\\]|\\.)*\""
_BRACKETS_AND_QUOTES = re.compile(rf"{_STRING}|['\"()]", re.DOTALL)
_STRINGS_AND_SPACES = re.compile(rf"{_STRING}|\s", re.DOTALL)


def parse_template(text: str, span: Span, sink: Diagnostics) -> Template | None:
    """Read the text of the scalar at `span`; None where an expression in it is at fault, which is reported."""
    place = TextPlace.of(text, span)
    parts: list[str | Expression | None] = []
    position = 0
    while opening := _OPENING.search(text, position):
        parts.append(text[position : opening.start()])
        position = opening.end()
        if opening[0] == "$$(":
            parts.append("$(")
            continue
        end = _closing(text, opening.end(), place, sink)
        if end is None:
            return None
        parts.append(_expression(text[position:end], position, place, sink))
        position = end + 1
    parts.append(text[position:])
    if None in parts:
        return None
    return Template(tuple(part for part in parts if part), span)


def _closing(text: str, start: int, place: TextPlace, sink: Diagnostics) -> int | None:
    """Return the index of the parenthesis that closes the expression begun before `start`, None and report none."""
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


def _expression(text: str, offset: int, place: TextPlace, sink: Diagnostics) -> Expression | None:
    if not text.strip():
        sink.report(codes.EMPTY_EXPRESSION.at(place.part(offset - 2, len(text) + 3)))
        return None
    if len(text) > MAX_LENGTH:
        too_long = f"is longer than {MAX_LENGTH:,} characters"
        sink.report(codes.EXPRESSION_TOO_LARGE.at(place.part(offset, len(text)), fault=too_long))
        return None
    text = _STRINGS_AND_SPACES.sub(lambda found: found[0] if found[0][0] in "'\"" else " ", text)
    try:
        tree = _syntax_tree(text)
    except (SyntaxError, MemoryError, RecursionError, ValueError) as error:
        if isinstance(error, SyntaxError) and error.msg != "too many nested parentheses":
            start, length, problem = explain_syntax_error(text, error)
            sink.report(codes.UNREADABLE_EXPRESSION.at(place.part(offset + start, length), problem=problem))
        else:  # Python's parser has had enough
            sink.report(codes.EXPRESSION_TOO_LARGE.at(place.part(offset, len(text)), fault="nests too deep"))
        return None
    expression = Expression(text, offset, place, tree)
    faults = tuple(refusals(expression))
    for fault in faults:
        sink.report(fault)
    return None if faults else names_in(expression)


def _syntax_tree(text: str) -> ast.expr:
    with warnings.catch_warnings():
        # An unknown escape in a text and `1if` are warned about on standard error, with a file that is not there.
        warnings.simplefilter("ignore")
        # In parentheses, because leading spaces are an error to Python otherwise.
        return ast.parse(f"({text})", mode="eval").body
