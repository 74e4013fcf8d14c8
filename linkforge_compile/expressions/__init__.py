"""Expressions `$(...)`: parsed with Python's `ast`, checked against an allow-list and computed here."""

from linkforge_compile.expressions.evaluate import evaluate, passed_on
from linkforge_compile.expressions.functions import RESERVED_NAMES
from linkforge_compile.expressions.parse import as_one_expression, forgotten_expression, parse_template
from linkforge_compile.expressions.types import (
    FAULT,
    Expression,
    Fault,
    FileFunction,
    Lazy,
    PathText,
    Scope,
    Template,
    Value,
    ValuePath,
    as_text,
    kind_name,
    seen_from_compiled,
)
