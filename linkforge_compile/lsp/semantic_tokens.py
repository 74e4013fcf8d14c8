"""Classify the names, numbers and texts in the expressions of a text, for an editor to color.

What is not on one line of the file as the compiler reads it, such as a part of a folded scalar, has no token; nor have
operators, which editors color by their signs.
"""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterable, Iterator
from itertools import chain

from lsprotocol import types
from yaml.events import ScalarEvent

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expressions import parse_template
from linkforge_compile.expressions.functions import CONSTANTS, SIGNATURES
from linkforge_compile.expressions.types import Expression
from linkforge_compile.lsp.workspace import Document
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax import has_expression
from linkforge_compile.syntax.parser import Marks, readable_events

_TYPES = types.SemanticTokenTypes
LEGEND = types.SemanticTokensLegend(
    [_TYPES.Function, _TYPES.Parameter, _TYPES.Variable, _TYPES.Property, _TYPES.Number, _TYPES.String], []
)


def semantic_tokens(document: Document) -> types.SemanticTokens:
    """Return the tokens of the expressions in an open text; of one that does not parse, those before the fault."""
    spec = document.readable.spec if document.readable else None
    parameters = spec.tree.section("parameters") if spec else ()
    tokens = (token for expression in _expressions(document.file) for token in _tokens(expression, parameters))
    by_place = sorted({span[1:]: (span, kind) for span, kind in tokens if span.line == span.end_line}.items())
    ranges = ((document.columns.range(span), kind) for _, (span, kind) in by_place)
    return types.SemanticTokens([*chain.from_iterable(_encoded(ranges))])


def _expressions(file: SourceFile) -> Iterator[Expression]:
    marks = Marks(file)
    for event in readable_events(marks.text):
        if isinstance(event, ScalarEvent) and has_expression(event.value):
            template = parse_template(event.value, marks.scalar(event), Diagnostics())
            yield from (part for part in (template.parts if template else ()) if isinstance(part, Expression))


def _tokens(expression: Expression, parameters: Collection[str]) -> Iterator[tuple[Span, str]]:
    """Yield the place and kind of each part whose text the file holds as it is."""
    for node in ast.walk(expression.tree):
        kind = _kind(node, parameters)
        if kind and isinstance(node, ast.expr):
            span = expression.key_span(node) if isinstance(node, ast.Attribute) else expression.span(node)
            if (span.text or "\n") in expression.text:
                yield span, kind


def _kind(node: ast.AST, parameters: Collection[str]) -> str | None:
    match node:
        case ast.Name(id=name) if name in CONSTANTS:
            return _TYPES.Number
        case ast.Name(id=name) if name in SIGNATURES:
            return _TYPES.Function
        case ast.Name(id=name):
            return _TYPES.Parameter if name in parameters else _TYPES.Variable
        case ast.Attribute():
            return _TYPES.Property
        case ast.Constant(value=str()):
            return _TYPES.String
        case ast.Constant(value=int() | float()):
            return _TYPES.Number
    return None


def _encoded(tokens: Iterable[tuple[types.Range, str]]) -> Iterator[tuple[int, int, int, int, int]]:
    """Yield the five numbers of each token; its place is relative to that of the token before it."""
    line = character = 0
    for range_, kind in tokens:
        start = range_.start
        before = character if start.line == line else 0
        length = range_.end.character - start.character
        yield start.line - line, start.character - before, length, LEGEND.token_types.index(kind), 0
        line, character = start.line, start.character
