"""Expressions `$(...)`: parsed with Python's `ast`, checked against an allow-list and computed here."""

from linkforge_compile.expressions.evaluate import evaluate, handed_on
from linkforge_compile.expressions.functions import RESERVED_NAMES
from linkforge_compile.expressions.parse import as_one_expression, forgotten_expression, parse_template
from linkforge_compile.expressions.scope import FileFunction, Lazy, Scope
from linkforge_compile.expressions.types import (
    FAULT,
    Expression,
    Fault,
    PathText,
    Template,
    Value,
    as_text,
    kind_name,
    seen_from_compiled,
)

__all__ = [
    "FAULT",
    "RESERVED_NAMES",
    "Expression",
    "Fault",
    "FileFunction",
    "Lazy",
    "PathText",
    "Scope",
    "Template",
    "Value",
    "as_one_expression",
    "as_text",
    "evaluate",
    "forgotten_expression",
    "handed_on",
    "kind_name",
    "parse_template",
    "seen_from_compiled",
]
