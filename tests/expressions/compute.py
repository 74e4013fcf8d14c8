"""Evaluates a text as if it stood in a file of its own."""

from typing import NamedTuple

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expressions import FAULT, Fault, Lazy, Scope, Value, evaluate, parse_template
from linkforge_compile.source import SourceFile, Span


class Computed(NamedTuple):
    """A value, and each thing that was reported as the text it is reported of and the sentence."""

    value: Value | Fault
    reported: list[tuple[str | None, str]]


def compute(text: str, names: dict[str, Value | Fault | Lazy] | None = None) -> Computed:
    sink = Diagnostics()
    template = parse_template(text, whole(text), sink)
    value = FAULT if template is None else evaluate(template, Scope(names or {}), sink)
    return Computed(value, [(one.span.text, one.message) for one in sink.sorted() if one.span])


def whole(text: str) -> Span:
    return Span(SourceFile("x", text), 1, 1, 1, len(text) + 1)
